// Spectral paints: the model band by band, and what a painted sphere sends to the eye.
#include "twin/painted_sphere.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "core/colour.h"
#include "core/random.h"
#include "small_bench.h"

namespace livery {
namespace {

using namespace livery::testing;

glm::dvec3 direction(Random& random) {
    const double z = 0.02 + 0.98 * random.uniform(), angle = 6.283185307 * random.uniform();
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

TEST(SpectralPaint, EveryBandIsTheClearcoatModel) {
    Random random(5);
    for (const auto& name : spectral_paint_names()) {
        const SpectralPaint paint = read_spectral_paint(name);
        const double largest = *std::max_element(paint.f0.begin(), paint.f0.end());
        for (int trial = 0; trial < 200; ++trial) {
            const glm::dvec3 wi = direction(random), wo = direction(random);
            const Spectrum all = evaluate_paint(paint, wi, wo);
            const std::size_t k = random.below(kSpectrumCount);
            // One band beside the paint's largest, which decides for all how they behave at grazing
            // light.
            f64::BsdfParameters p{};
            p.diffuse = glm::dvec3(paint.diffuse[k]);
            p.f0 = glm::dvec3(paint.f0[k], largest, largest);
            p.alpha_x = p.alpha_y = paint.alpha;
            p.coat_alpha = paint.coat_alpha;
            p.coat_f0 = paint.coat_f0;
            p.coat_transmittance = glm::dvec3(1.0);
            const double expected = evaluate(ReflectanceModel::clearcoat, p, wi, wo).x;
            EXPECT_NEAR(all[k], expected, 1e-12 * (1.0 + expected)) << name << " band " << k;
        }
    }
}

TEST(SpectralPaint, MomentsGiveTheSumOverAllBands) {
    Random random(7);
    const std::array<Spectrum, 3> curves{cie1931_x(), cie1931_y(), illuminant_d65()};
    for (const auto& name : spectral_paint_names()) {
        const SpectralPaint paint = read_spectral_paint(name);
        const PaintBands bands(paint);
        const auto moments = bands.moments(curves);
        for (int trial = 0; trial < 50; ++trial) {
            const glm::dvec3 wi = direction(random), wo = direction(random);
            const Spectrum all = evaluate_paint(paint, wi, wo);
            const glm::dvec3 folded =
                bands.evaluate(moments, wi, wo, bands.side_of(wi.z), bands.side_of(wo.z));
            for (int c = 0; c < 3; ++c) {
                double sum = 0.0;
                for (std::size_t k = 0; k < all.size(); ++k) {
                    sum += all[k] * curves[static_cast<std::size_t>(c)][k];
                }
                EXPECT_NEAR(folded[c] / sum, 1.0, 1e-12) << name;
            }
        }
    }
}

TEST(SpectralPaint, EvaluationIsReciprocalAndDarkBelowTheHorizon) {
    Random random(6);
    const SpectralPaint paint = read_spectral_paint("metallic-green");
    for (int trial = 0; trial < 50; ++trial) {
        const glm::dvec3 wi = direction(random), wo = direction(random);
        const Spectrum a = evaluate_paint(paint, wi, wo), b = evaluate_paint(paint, wo, wi);
        for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-12 * (1.0 + a[k]));
        EXPECT_EQ(evaluate_paint(paint, {wi.x, wi.y, -wi.z}, wo), Spectrum{});
    }
}

TEST(SpectralPaint, MaterialsAreTheSpectraUnderD65) {
    SpectralPaint grey;
    grey.diffuse = flat(0.4);
    grey.f0 = flat(0.06);
    grey.alpha = 0.25;
    const Material material = material_of(grey);
    EXPECT_EQ(material.model, ReflectanceModel::clearcoat);
    for (int c = 0; c < 3; ++c) {
        // D65's table and its rounded chromaticity differ in the fourth digit.
        EXPECT_NEAR(material.diffuse[c], 0.4, 4e-4);
        EXPECT_NEAR(material.f0[c], 0.06, 1e-4);
    }
    EXPECT_EQ(material.alpha, glm::dvec2(0.25));
    const Material red = material_of(read_spectral_paint("solid-red"));
    EXPECT_GT(red.diffuse.x, 0.3);
    EXPECT_LT(red.diffuse.y, 0.1);
    for (const auto& name : spectral_paint_names()) {
        EXPECT_NO_THROW(parameters_of(material_of(read_spectral_paint(name)))) << name;
    }
}

TEST(SpectralPaint, SixPaintsAreShipped) {
    EXPECT_EQ(spectral_paint_names(),
              (std::vector<std::string>{"metallic-blue",
                                        "metallic-green",
                                        "metallic-silver",
                                        "solid-blue",
                                        "solid-green",
                                        "solid-red"}));
}

TEST(PaintedSphere, AFlatGreySphereMatchesTheModelAtTheSpheresPoints) {
    // No spectrum, so the answer is known: pi f cos L at the point where the pixel's ray lands.
    SpectralPaint grey;
    grey.diffuse = flat(0.3);
    grey.f0 = flat(0.05);
    grey.alpha = 0.3;
    grey.coat_alpha = 0.3;
    const Mesh mesh = make_sphere({0, 0, 0}, 25.0, 160, "sphere");
    const Tracer tracer(mesh);
    const View view = look_at({0, 0, 300}, {0, 0, 0}, 0.2, 60, 60);
    const glm::dvec3 eye(150, 60, 260);
    const glm::dvec3 key = glm::normalize(glm::dvec3(0.3, 0.6, 0.7));
    const std::vector<DirectionalLight> lights{{key, glm::dvec3(1.0), 0.0},
                                               {{-1, 0, 0.2}, glm::dvec3(0.3), 0.0}};
    const ImageF xyz = paint_radiance_xyz(mesh, tracer, view, eye, grey, lights, 4);
    f64::BsdfParameters p{};
    p.diffuse = glm::dvec3(0.3);
    p.f0 = glm::dvec3(0.05);
    p.alpha_x = p.alpha_y = p.coat_alpha = 0.3;
    p.coat_f0 = 0.04;
    p.coat_transmittance = glm::dvec3(1.0);
    int compared = 0;
    for (int y = 15; y < 45; y += 3) {
        for (int x = 15; x < 45; x += 3) {
            const Ray ray = ray_through(view, {x + 0.5, y + 0.5});
            const double b = glm::dot(ray.origin, ray.direction);
            const double d = b * b - glm::dot(ray.origin, ray.origin) + 625.0;
            if (d <= 100.0) continue;
            const glm::dvec3 place = ray.origin + (-b - std::sqrt(d)) * ray.direction;
            const glm::dvec3 n = place / 25.0;
            const glm::dvec3 t = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), n)),
                             s = glm::cross(n, t);
            const auto local = [&](const glm::dvec3& v) {
                return glm::dvec3(glm::dot(v, t), glm::dot(v, s), glm::dot(v, n));
            };
            double expected = 0.0;
            bool near_terminator = false;
            for (const auto& light : lights) {
                const glm::dvec3 wi = local(glm::normalize(light.direction));
                near_terminator |= std::abs(wi.z) < 0.15;
                expected +=
                    3.14159265358979 * light.radiance_rec709.x * std::max(0.0, wi.z) *
                    evaluate(ReflectanceModel::clearcoat, p, wi, local(glm::normalize(eye - place)))
                        .x;
            }
            if (near_terminator) continue;
            // A pixel is 1 mm of a radius of 25: its mean is its middle's value to 1%, lobe
            // included.
            EXPECT_NEAR(xyz.at(x, y, 1) / expected, 1.0, 0.012) << x << " " << y;
            ++compared;
        }
    }
    EXPECT_GT(compared, 30);
    EXPECT_EQ(xyz.at(1, 1, 1), 0.0f);
}

TEST(PaintedSphere, ThreeChannelsComeNearTheSpectraOfEveryShippedPaint) {
    // The point of the spectral truth: a three-channel product is not the spectral one. For one
    // reflection of a diffuse layer they agree; under the coat, where the layer's albedo enters a
    // series, they part by little.
    const Mesh mesh = make_sphere({0, 0, 0}, 25.0, 96, "sphere");
    const Tracer tracer(mesh);
    const View view = look_at({0, 0, 300}, {0, 0, 0}, 0.2, 40, 40);
    const glm::dvec3 eye(0, 0, 300);
    const std::vector<DirectionalLight> lights{{{0.4, 0.5, 0.8}, glm::dvec3(1.0), 0.0}};
    for (const auto& name : spectral_paint_names()) {
        const SpectralPaint paint = read_spectral_paint(name);
        const ImageF xyz = paint_radiance_xyz(mesh, tracer, view, eye, paint, lights, 2);
        const f64::BsdfParameters p = parameters_of_f64(material_of(paint));
        const glm::dvec3 n = glm::dvec3(0.0, 0.0, 1.0);
        const glm::dvec3 wi = glm::normalize(lights[0].direction);
        const glm::dvec3 rgb =
            3.14159265358979 * wi.z * evaluate(ReflectanceModel::clearcoat, p, wi, n);
        const glm::dvec3 rendered = xyz_from_working() * rgb;
        const float* truth = xyz.pixel(20, 20);
        const double difference =
            ciede2000(lab_from_xyz(rendered, d65_xyz()),
                      lab_from_xyz({truth[0], truth[1], truth[2]}, d65_xyz()));
        EXPECT_LT(difference, 3.0) << name;
        EXPECT_GT(truth[1], 0.01) << name;
    }
}

TEST(PaintedSphere, RefusesColouredLights) {
    const Mesh mesh = make_sphere({0, 0, 0}, 25.0, 8, "sphere");
    const Tracer tracer(mesh);
    const View view = look_at({0, 0, 300}, {0, 0, 0}, 0.2, 8, 8);
    const std::vector<DirectionalLight> lights{{{0, 1, 0}, {1.0, 0.5, 0.5}, 0.0}};
    EXPECT_THROW(paint_radiance_xyz(mesh, tracer, view, {0, 0, 1}, SpectralPaint{}, lights),
                 std::invalid_argument);
}

}  // namespace
}  // namespace livery
