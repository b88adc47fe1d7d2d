// Draws the documentation's pictures of the car: eight views and four details as the window shows
// them, and the reflections of a striped room, which show a dent as a kink in a stripe:
// livery_car_pictures FOLDER.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/image_io.h"
#include "core/paths.h"
#include "gl/context.h"
#include "gl/read_back.h"
#include "live/orbit.h"
#include "live/preview_picture.h"
#include "scene/library.h"

namespace livery {
namespace {

constexpr int kBackground = 112;
constexpr double kDegree = std::numbers::pi / 180.0;

struct Camera {
    double azimuth_deg, elevation_deg;
    glm::dvec3 target_mm{0.0};
    double distance_mm = 0.0;  ///< 0: the whole car
    double zoom = 0.9;         ///< steps nearer than the whole with its shadow
};

View view_from(const Camera& camera, const Bounds& bounds, int width, int height) {
    Orbit orbit;
    orbit.azimuth_rad = camera.azimuth_deg * kDegree;
    orbit.elevation_rad = camera.elevation_deg * kDegree;
    orbit.vertical_fov_rad = 0.3;
    if (camera.distance_mm > 0.0) {
        orbit.target_mm = camera.target_mm;
        orbit.distance_mm = camera.distance_mm;
        return view_of(orbit, width, height);
    }
    const double aspect = static_cast<double>(width) / height;
    return view_of(zoomed(fitted(orbit, bounds, aspect), camera.zoom, bounds), width, height);
}

/// `top` over grey, into a part of a sheet, rounded to steps of 5, which keeps the files small.
void place(Image8& sheet, const Image8& top, int left, int above) {
    for (int y = 0; y < top.height; ++y) {
        for (int x = 0; x < top.width; ++x) {
            constexpr int kStep = 5;  // divides 255
            const double alpha = top.at(x, y, 3) / 255.0;
            for (int c = 0; c < 3; ++c) {
                const double over = alpha * top.at(x, y, c) + (1.0 - alpha) * kBackground;
                sheet.at(left + x, above + y, c) =
                    static_cast<std::uint8_t>(kStep * std::lround(over / kStep));
            }
        }
    }
}

class CarPainter {
  public:
    CarPainter()
        : product_(find_product("car")),
          preview_(product_),
          tracer_(product_->mesh),
          ground_(ground_shadow(*product_, tracer_)),
          bounds_(bounds_of(product_->mesh)) {
        encoder_.set_ground(&ground_);
        preview_.set_supersampling(4);
    }

    Image8 picture(const std::string& look, const Camera& camera, int width, int height) {
        const View view = view_from(camera, bounds_, width, height);
        preview_.render(make_scene(product_, find_look(look), centre_in_world(view)), view);
        const Texture2D texture(width, height, TexelFormat::rgba8);
        const Framebuffer into({&texture});
        encoder_.encode(preview_, view, std::nullopt, true, into);
        return read_bytes(texture, 4);
    }

    /// The body as a mirror of black and white stripes, the other parts dark.
    Image8 zebra(const Camera& camera, int width, int height) const {
        constexpr int kSamples = 4;
        const View view = view_from(camera, bounds_, width, height);
        Image8 picture(width, height, 4, 0);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                double light = 0.0, covered = 0.0;
                for (int s = 0; s < kSamples * kSamples; ++s) {
                    const glm::dvec2 at(x + (s % kSamples + 0.5) / kSamples,
                                        y + (s / kSamples + 0.5) / kSamples);
                    const Ray ray = ray_through(view, at);
                    const Hit hit = tracer_.closest({ray.origin, 0.0f, ray.direction});
                    if (!hit.valid()) continue;
                    covered += 1.0;
                    light += striped(ray, surface_point(product_->mesh, hit));
                }
                constexpr double kAll = kSamples * kSamples;
                const auto grey = static_cast<std::uint8_t>(
                    std::lround(covered > 0.0 ? 255.0 * light / covered : 0.0));
                for (int c = 0; c < 3; ++c) picture.at(x, y, c) = grey;
                picture.at(x, y, 3) =
                    static_cast<std::uint8_t>(std::lround(255.0 * covered / kAll));
            }
        }
        return picture;
    }

  private:
    double striped(const Ray& ray, const SurfacePoint& point) const {
        if (point.part != part_index(*product_, "body")) {
            return 0.18 + 0.1 * std::abs(point.normal.y);
        }
        const auto out = glm::reflect(glm::vec3(ray.direction), point.normal);
        // Level stripes, 10 degrees of elevation each: none narrows toward a pole.
        const double turn = std::asin(std::clamp(out.y, -1.0f, 1.0f)) / (20.0 * kDegree);
        const double wave = turn - std::floor(turn);
        return wave < 0.5 ? 0.06 : 0.94;
    }

    std::shared_ptr<const Product> product_;
    RasterPreview preview_;
    Tracer tracer_;
    GroundShadow ground_;
    Bounds bounds_;
    PreviewEncoder encoder_;
};

template <std::size_t N, typename Draw>
void write_sheet(const std::filesystem::path& file,
                 const std::array<Camera, N>& cameras,
                 int width,
                 int height,
                 Draw&& draw) {
    constexpr int kColumns = 2;
    Image8 sheet(kColumns * width, static_cast<int>(N) / kColumns * height, 3, kBackground);
    for (int k = 0; k < static_cast<int>(N); ++k) {
        place(sheet,
              draw(cameras[static_cast<std::size_t>(k)], width, height),
              k % kColumns * width,
              k / kColumns * height);
    }
    write_png(file, sheet);
}

void draw_pictures(const std::filesystem::path& folder) {
    const HeadlessContext context(GlDevice::automatic);
    CarPainter car;
    const auto in_paint = [&](const std::string& look) {
        return [&car, look](const Camera& camera, int width, int height) {
            return car.picture(look, camera, width, height);
        };
    };
    const auto in_stripes = [&](const Camera& camera, int width, int height) {
        return car.zebra(camera, width, height);
    };
    constexpr int kWidth = 400, kHeight = 190;
    const std::array<Camera, 8> views{
        {{40, 13}, {-42, 15}, {0, 4}, {0, 89}, {90, 6}, {-90, 6}, {58, 1}, {-32, 34}}};
    write_sheet(folder / "car-views.png", views, kWidth, kHeight, in_paint("solid-red"));
    const std::array<Camera, 4> details{{{48, 10, {79, 26, 24}, 120},
                                         {14, 4, {57.5, 15, 34}, 140},
                                         {-58, 10, {-80, 37, 24}, 130},
                                         {32, 14, {14, 44, 30}, 190}}};
    write_sheet(folder / "car-details.png", details, kWidth, 240, in_paint("silver-metallic"));
    const std::array<Camera, 4> striped{{{40, 13}, {-42, 15}, {0, 4}, {20, 50}}};
    write_sheet(folder / "car-zebra.png", striped, kWidth, kHeight, in_stripes);
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: livery_car_pictures FOLDER\n");
        return 2;
    }
    try {
        livery::draw_pictures(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "livery_car_pictures: %s\n", error.what());
        return 1;
    }
    return 0;
}
