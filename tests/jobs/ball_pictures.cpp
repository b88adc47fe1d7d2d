// docs/images/mirror-ball.png: a mirror ball in the shipped studio, photographed from two sides on
// the simulated stand, and the maps made of that. Takes the picture's name; prints how well the
// maps do.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <numbers>

#include "core/paths.h"
#include "core/worst_error.h"
#include "jobs/ball_bench.h"
#include "jobs/picture_tool.h"

namespace livery {
namespace {

constexpr int kPhotograph = 256, kMap = 512;

/// Linear Rec.709 as it is seen, bright parts rolled off.
void place(const glm::dvec3& rec709, int x, int y, Image8& out) {
    for (int c = 0; c < 3; ++c) {
        const double value = std::max(rec709[c], 0.0);
        const double shown = srgb_encode(std::min(value / (1.0 + 0.6 * value), 1.0));
        out.at(x, y, c) = static_cast<std::uint8_t>(255.0 * shown + 0.5);
    }
}

/// What a camera of the stand sees, without noise.
void place_photograph(const MirrorBallStand& stand,
                      const CameraDescription& camera,
                      const LightFrom& light_from,
                      int x0,
                      Image8& out) {
    CameraDescription small = camera;
    small.view = resized(camera.view, kPhotograph, kPhotograph);
    const ImageF light = mirror_ball_light(stand, small, light_from);
    for (int y = 0; y < kPhotograph; ++y) {
        for (int x = 0; x < kPhotograph; ++x) {
            const float* value = light.pixel(x, y);
            place(rec709_from_working() * glm::dvec3(value[0], value[1], value[2]) /
                      stand.units_per_s,
                  x0 + x,
                  y,
                  out);
        }
    }
}

/// `seen`: what is filled is told from the rest by lines.
void place_map(const ImageF& map, const ImageF* seen, int x0, int y0, Image8& out) {
    for (int y = 0; y < kMap / 2; ++y) {
        for (int x = 0; x < kMap; ++x) {
            const float* value = map.pixel(x * map.width / kMap, y * map.width / kMap);
            glm::dvec3 shown(value[0], value[1], value[2]);
            if (seen && seen->at(x * map.width / kMap, y * map.width / kMap) < 0.5f &&
                (x + y) % 4 == 0) {
                shown = glm::dvec3(2.0, 0.0, 1.0);
            }
            place(shown, x0 + x, y0 + y, out);
        }
    }
}

void tell(const EnvironmentMeasurement& report, const Environment& truth, const char* of) {
    const LightFrom working = light_of(truth);
    double worst = 0.0, sum = 0.0;
    const auto normals = even_directions(60);
    for (const glm::dvec3& normal : normals) {
        const glm::dvec3 wanted = rec709_from_working() * irradiance_of(working, normal);
        const glm::dvec3 off =
            glm::abs(irradiance_of(light_in(report.map.radiance), normal) / wanted - 1.0);
        for (int c = 0; c < 3; ++c) worst = worse_of(worst, off[c]);
        sum += (off.x + off.y + off.z) / 3.0 / static_cast<double>(normals.size());
    }
    std::printf(
        "%s: covered %.1f%%, coarse %.1f%%, filled %.2f%%; irradiance off by %.2f%% (mean), "
        "%.2f%% (worst)\n",
        of,
        100.0 * report.coverage.covered,
        100.0 * report.coverage.coarse,
        100.0 * report.filled,
        100.0 * sum,
        100.0 * worst);
}

int draw(const char* file) {
    const Environment studio =
        load_environment({shipped_path("assets/environments/studio.hdr").string(), 0.0, 1.0}, {});
    BallBench bench(1024, 2, light_of(studio));
    Image8 picture(2 * kMap, kMap, 3);
    for (int k = 0; k < 2; ++k) {
        place_photograph(bench.stand,
                         bench.stand.cameras[static_cast<std::size_t>(k)],
                         light_of(studio),
                         k * kPhotograph,
                         picture);
    }
    const EnvironmentMeasurement both = bench.measure(1024);
    tell(both, studio, "two sides");
    bench.manifest["views"].erase(1);
    bench.rewrite();
    const EnvironmentMeasurement one = bench.measure(1024);
    tell(one, studio, "one side");
    ImageF truth = studio.radiance_working;
    for (std::size_t k = 0; k < truth.pixel_count(); ++k) {
        float* value = truth.values.data() + 3 * k;
        const glm::dvec3 rec709 = rec709_from_working() * glm::dvec3(value[0], value[1], value[2]);
        for (int c = 0; c < 3; ++c) value[c] = static_cast<float>(rec709[c]);
    }
    place_map(one.map.radiance, &one.map.seen, kMap, 0, picture);
    place_map(both.map.radiance, nullptr, 0, kMap / 2, picture);
    place_map(truth, nullptr, kMap, kMap / 2, picture);
    write_png(file, picture);
    return 0;
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) { return livery::draw_named_picture(argc, argv, livery::draw); }
