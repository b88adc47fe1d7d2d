// Single flakes: the statistics of their count, its steadiness, and what it costs who has none.
#include "radiance/glints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/random.h"
#include "core/worst_error.h"
#include "gl/draw.h"
#include "gl/read_back.h"
#include "radiance/glints_source.h"
#include "radiance/renderer_fixture.h"
#include "radiance/shading.h"
#include "support/shading_devices.h"

namespace livery {
namespace {

/// One light, one pixel and one paint.
struct Setting {
    glm::dvec3 wi{0.0, 0.0, 1.0}, wo{0.0, 0.0, 1.0};
    double alpha = 0.15;
    double light_radius2 = 1e-4;
    double mean_squared_slope = 1e-4;
    double density = 100.0;

    double hh() const { return glm::dot(wi + wo, wi + wo); }
    double chance() const {
        return f64::glint_chance(wi, wo, hh(), alpha, light_radius2, mean_squared_slope);
    }
    double factor(const glm::dvec4& place) const {
        return f64::glint_factor(
            wi, wo, hh(), alpha, light_radius2, mean_squared_slope, place, density);
    }
    float factor_in_float(const glm::dvec4& place) const {
        const glm::vec3 i(wi), o(wo);
        return f32::glint_factor(i,
                                 o,
                                 glm::dot(i + o, i + o),
                                 static_cast<float>(alpha),
                                 static_cast<float>(light_radius2),
                                 static_cast<float>(mean_squared_slope),
                                 glm::vec4(place),
                                 static_cast<float>(density));
    }
};

glm::dvec3 direction_at(double angle_rad, double azimuth_rad) {
    const double sine = std::sin(angle_rad);
    return {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), std::cos(angle_rad)};
}

glm::dvec4 any_place(Random& random, double extent_mm, double side_mm) {
    return {extent_mm * random.uniform(),
            extent_mm * random.uniform(),
            extent_mm * random.uniform(),
            side_mm};
}

struct Moments {
    double mean = 0.0, variance = 0.0, kurtosis = 0.0;
    double deviation_of_mean = 0.0, relative_deviation_of_variance = 0.0;
};

/// Of `count` pixels that have nothing in common.
Moments moments_of(const Setting& setting, double side_mm, int count, std::uint64_t seed) {
    Random random(seed);
    double m1 = 0.0, m2 = 0.0, m4 = 0.0;
    for (int k = 0; k < count; ++k) {
        const double d = setting.factor(any_place(random, 5000.0, side_mm)) - 1.0;
        m1 += d;
        m2 += d * d;
        m4 += d * d * d * d;
    }
    Moments moments;
    moments.mean = 1.0 + m1 / count;
    moments.variance = m2 / count;
    moments.kurtosis = m4 / count / (moments.variance * moments.variance);
    moments.deviation_of_mean = std::sqrt(moments.variance / count);
    moments.relative_deviation_of_variance = std::sqrt((moments.kurtosis - 1.0) / count);
    return moments;
}

/// The GGX slopes within a disc by quadrature: no formula in common with the source.
double chance_by_quadrature(const glm::dvec2& middle, double radius, double alpha) {
    constexpr int kSteps = 400;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double r = radius * (i + 0.5) / kSteps;
        for (int j = 0; j < kSteps; ++j) {
            const double phi = 2.0 * std::numbers::pi * (j + 0.5) / kSteps;
            const glm::dvec2 s = middle + r * glm::dvec2(std::cos(phi), std::sin(phi));
            const double k = glm::dot(s, s) + alpha * alpha;
            sum += r * alpha * alpha / (std::numbers::pi * k * k);
        }
    }
    return sum * (radius / kSteps) * (2.0 * std::numbers::pi / kSteps);
}

TEST(Glints, TheChanceIsTheLobesShareOfTheDisc) {
    for (const double alpha : {0.02, 0.15, 0.4}) {
        for (const double angle : {0.0, 0.2, 0.7}) {
            Setting s;
            s.alpha = alpha;
            s.wi = direction_at(angle, 0.4);
            const glm::dvec3 h = s.wi + s.wo;
            const double length = glm::length(h), c = h.z / length;
            const double r2 = 0.5 * s.light_radius2 / (length * c * c * c) +
                              2.0 * s.mean_squared_slope + 0.02 * 0.02;
            const double expected = chance_by_quadrature(glm::dvec2(h) / h.z, std::sqrt(r2), alpha);
            EXPECT_NEAR(s.chance(), expected, 1e-3 * expected) << alpha << ' ' << angle;
        }
    }
}

TEST(Glints, HaveTheMeanOfTheLobeAndTheVarianceOfTheBinomial) {
    // Asserted at 4.5 deviations; where pixels hold many flakes that is less than 1% of either.
    double tightest_mean = 1.0, tightest_variance = 1.0;
    std::uint64_t seed = 1;
    for (const double density : {0.3, 10.0, 300.0, 1e5}) {
        for (const double side : {0.4, 1.0, 1.7, 37.0}) {
            for (const double angle : {0.05, 0.6, 1.3}) {
                Setting s;
                s.density = density;
                s.wi = direction_at(angle, 1.0);
                const double p = s.chance();
                const double expected = (1.0 - p) / (density * side * side * p);
                if (expected > 900.0) continue;
                const Moments m = moments_of(s, side, 100000, seed++);
                const std::string what =
                    fmt::format("density {} side {} angle {}", density, side, angle);
                EXPECT_NEAR(m.mean, 1.0, 4.5 * m.deviation_of_mean) << what;
                EXPECT_NEAR(m.variance / expected, 1.0, 4.5 * m.relative_deviation_of_variance)
                    << what;
                tightest_mean = std::min(tightest_mean, 4.5 * m.deviation_of_mean);
                tightest_variance =
                    std::min(tightest_variance, 4.5 * m.relative_deviation_of_variance);
            }
        }
    }
    std::printf("    an error of %.3f%% of the mean and of %.1f%% of the variance would show\n",
                100.0 * tightest_mean,
                100.0 * tightest_variance);
    EXPECT_LT(tightest_mean, 0.02);
    EXPECT_LT(tightest_variance, 0.02);
}

TEST(Glints, ComeCloseToAGaussianWhereFlakesAreMany) {
    Setting s;
    s.density = 1e5;
    EXPECT_NEAR(moments_of(s, 1.0, 200000, 3).kurtosis, 3.0, 0.5);
}

TEST(Glints, BigLightsAndCurvedPixelsMakeThemFaint) {
    const auto variance = [](double light_radius2, double mean_squared_slope) {
        Setting s;
        s.light_radius2 = light_radius2;
        s.mean_squared_slope = mean_squared_slope;
        return moments_of(s, 1.0, 50000, 4).variance;
    };
    const double point = variance(0.0, 0.0);
    // Half a degree, three, twenty
    EXPECT_LT(variance(2e-5, 0.0), 0.995 * point);
    EXPECT_LT(variance(7e-4, 0.0), 0.75 * point);
    EXPECT_LT(variance(3e-2, 0.0), 0.1 * point);
    EXPECT_LT(variance(0.0, 1e-3), 0.3 * point);
}

TEST(Glints, ChangeWithoutAStep) {
    // A step of the eye, the light, the place or the size of the pixel: across cells and grids,
    // too.
    for (const double variance : {0.01, 1.0, 30.0}) {
        Random random(5);
        Setting s;
        s.density = 1.0 / (variance * s.chance());
        double before = 1e9, first = 0.0;
        for (const double step : {1e-2, 1e-4, 1e-6, 1e-8}) {
            double worst = 0.0;
            for (int k = 0; k < 20000; ++k) {
                const auto off = [&] { return 2.0 * random.uniform() - 1.0; };
                Setting a = s;
                a.wi = glm::normalize(glm::dvec3(0.3 * off(), 0.3 * off(), 1.0));
                Setting b = a;
                b.wi = glm::normalize(a.wi + 0.02 * step * glm::dvec3(off(), off(), off()));
                const glm::dvec4 place(
                    100.0 * off(), 100.0 * off(), 100.0 * off(), std::exp2(0.1 * off()));
                const glm::dvec4 moved = place + step * glm::dvec4(off(), off(), off(), off());
                worst = worse_of(worst, std::abs(a.factor(place) - b.factor(moved)));
            }
            EXPECT_LT(worst, before) << step;
            if (first == 0.0) first = worst;
            before = worst;
        }
        EXPECT_LT(before, 1e-3 * first) << variance;
    }
}

TEST(Glints, AreTheSamePatternAlways) {
    // What was there when this was written: a look keeps its pattern from version to version.
    Setting s;
    s.wi = direction_at(0.1, 0.3);
    EXPECT_NEAR(s.factor({10.0, 20.0, 30.0, 1.0}), 2.669594430, 1e-6);
    EXPECT_NEAR(s.factor({-3.7, 0.2, 94.1, 0.7}), 0.323712543, 1e-6);
    s.density = 5.0;
    EXPECT_NEAR(s.factor({-3.7, 0.2, 94.1, 3.0}), 0.876007210, 1e-6);
}

/// Settings and places over the whole range, some of them at its ends.
Setting any_setting(Random& random, glm::dvec4& place) {
    const auto between = [&](double low, double high) {
        const double u = random.uniform();
        if (u < 0.1) return low;
        if (u < 0.2) return high;
        return low * std::pow(high / low, random.uniform());
    };
    const auto direction = [&] {
        const double z = random.uniform() < 0.2 ? 1e-4 : random.uniform();
        const double sine = std::sqrt(1.0 - z * z), phi = 6.28 * random.uniform();
        return glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), z);
    };
    Setting s;
    s.wo = direction();
    s.wi = random.uniform() < 0.1 ? s.wo : direction();
    if (random.uniform() < 0.1) s.wi = glm::dvec3(-s.wo.x, -s.wo.y, s.wo.z);
    s.alpha = between(1e-4, 1.0);
    s.light_radius2 = random.uniform() < 0.1 ? 0.0 : between(1e-8, 2.5);
    s.mean_squared_slope = random.uniform() < 0.1 ? 0.0 : between(1e-8, 1.0);
    s.density = random.uniform() < 0.05 ? 0.0 : between(1e-6, 1e6);
    place = any_place(random, between(1e-3, 1e4), between(1e-3, 1e2));
    return s;
}

TEST(Glints, AreNeverNegativeNorNoNumber) {
    Random random(6);
    for (int k = 0; k < 500000; ++k) {
        glm::dvec4 place;
        const Setting s = any_setting(random, place);
        const float value = s.factor_in_float(place);
        ASSERT_TRUE(std::isfinite(value) && value >= 0.0f && value < 2e4f)
            << k << ": " << value << " density " << s.density << " side " << place.w;
    }
}

/// Asserts how far two computations of the same factors are apart, as shares of 1 + the factor.
void expect_close(const char* what, std::vector<double> errors) {
    for (double& error : errors) error = worst_if_nan(error);
    std::sort(errors.begin(), errors.end());
    const double p99 = errors[errors.size() * 99 / 100];
    std::printf("    %-24s 99%% %.1e worst %.1e\n", what, p99, errors.back());
    EXPECT_LT(p99, 1e-3) << what;
    EXPECT_LT(errors.back(), 0.05) << what;
}

/// What a picture has: places of a small product, pixels of a millimetre.
std::vector<std::pair<Setting, glm::dvec4>> usual_settings(int count) {
    Random random(7);
    std::vector<std::pair<Setting, glm::dvec4>> settings;
    for (int k = 0; k < count; ++k) {
        Setting s;
        const auto rounded = [](const glm::dvec3& v) { return glm::dvec3(glm::vec3(v)); };
        const double z = 0.1 + 0.9 * random.uniform(), sine = std::sqrt(1.0 - z * z);
        const double phi = 6.28 * random.uniform();
        s.wo = rounded({sine * std::cos(phi), sine * std::sin(phi), z});
        s.wi = rounded(direction_at(0.8 * random.uniform(), 6.28 * random.uniform()));
        s.alpha = static_cast<double>(static_cast<float>(0.05 + 0.3 * random.uniform()));
        s.light_radius2 = static_cast<double>(k % 2 == 0 ? 7e-4f : 0.0f);
        s.mean_squared_slope = static_cast<double>(static_cast<float>(1e-3 * random.uniform()));
        s.density = static_cast<double>(static_cast<float>(std::pow(10.0, 4.0 * random.uniform())));
        const glm::dvec4 place = any_place(random, 200.0, 0.5 + 2.0 * random.uniform());
        settings.emplace_back(s, glm::dvec4(glm::vec4(place)));
    }
    return settings;
}

TEST(Glints, FloatKeepsToDouble) {
    std::vector<double> errors;
    for (const auto& [s, place] : usual_settings(100000)) {
        const double expected = s.factor(place);
        errors.push_back(std::abs(static_cast<double>(s.factor_in_float(place)) - expected) /
                         (1.0 + expected));
    }
    expect_close("float against double", errors);
}

class RenderedGlints : public Renderer {
  protected:
    static Scene scene_with(double density, double angle_rad = 3.0 * kDegree_rad) {
        Scene scene = scene_of(make_sphere({0, 0, 0}, 40.0, 128, "body"),
                               paint_of(ReflectanceModel::car_paint, 0.05));
        // The second lobe alone, at its brightest and wide
        scene.part_materials[0].diffuse = scene.part_materials[0].f0 = glm::dvec3(0.0);
        scene.part_materials[0].coat_f0 = 0.0;
        scene.part_materials[0].flake_f0 = glm::dvec3(0.5);
        scene.part_materials[0].flake_alpha = 0.3;
        scene.part_materials[0].glint_density_per_mm2 = density;
        scene.lights = {light_from({0.1, 0.4, 1.0}, angle_rad)};
        return scene;
    }

    struct Ratios {
        double mean = 0.0, deviation = 0.0;
    };
    /// Of what is drawn with glints to what is drawn without, over inner pixels.
    static Ratios ratios(const ImageF& with, const ImageF& without) {
        double sum = 0.0, squares = 0.0, count = 0.0;
        for (std::size_t i = 0; i < with.pixel_count(); ++i) {
            const float smooth = without.values[4 * i + 1];
            if (without.values[4 * i + 3] < 1.0f || smooth < 0.02f) continue;
            const double ratio = static_cast<double>(with.values[4 * i + 1] / smooth);
            sum += ratio;
            squares += ratio * ratio;
            count += 1.0;
        }
        EXPECT_GT(count, 3000.0);
        const double mean = sum / count;
        return {mean, std::sqrt(squares / count - mean * mean)};
    }
};

LIVERY_ON_BOTH_DEVICES(RenderedGlints);

TEST_P(RenderedGlints, ShowTheSmoothLobeInTheMean) {
    const View view = test_view(160, 120);
    const ImageF smooth = draw(scene_with(0.0), view);
    double before = 1e9;
    for (const double density : {300.0, 3000.0, 3e5}) {
        const Ratios found = ratios(draw(scene_with(density), view), smooth);
        std::printf(
            "    density %5.0f mean %.4f deviation %.4f\n", density, found.mean, found.deviation);
        // Neighbours share a part of their cells: fewer than 3000 are independent.
        EXPECT_NEAR(found.mean, 1.0, 4.5 * found.deviation / std::sqrt(1500.0)) << density;
        EXPECT_LT(found.deviation, before);
        before = found.deviation;
    }
    EXPECT_LT(before, 0.5) << "an error of 5% of the mean shows";
    EXPECT_GT(before, 0.01);
    const Ratios wide = ratios(draw(scene_with(3e5, 0.5), view), draw(scene_with(0.0, 0.5), view));
    EXPECT_LT(wide.deviation, 0.5 * before) << "a larger light";
}

TEST_P(RenderedGlints, FollowTheScaleOfTheProductAndTheFlakes) {
    const View view = test_view(160, 120);
    const ImageF smooth = draw(scene_with(0.0), view);
    Scene scene = scene_with(5.0);
    const double near_by = ratios(draw(scene, view), smooth).deviation;
    // A pixel of a mock-up of scale 10 shows a hundred times the product, and as much as that of
    // flakes ten times as large.
    auto tenth = std::make_shared<Product>(*scene.product);
    tenth->product_scale = 10.0;
    scene.product = tenth;
    const double far_away = ratios(draw(scene, view), smooth).deviation;
    EXPECT_LT(far_away, 0.3 * near_by);
    scene.part_materials[0].glint_scale = 10.0;
    EXPECT_NEAR(ratios(draw(scene, view), smooth).deviation, near_by, 1e-3 * near_by);
}

TEST_P(RenderedGlints, MoveWithTheEyeWithoutAStep) {
    const View view = test_view(80, 60);
    Scene scene = scene_with(100.0);
    const ImageF before = draw(scene, view);
    double previous = 1e9;
    for (const double step_mm : {20.0, 1.0, 0.05}) {
        Scene moved = scene;
        moved.eye_in_world_mm.x += step_mm;
        const ImageF after = draw(moved, view);
        double sum = 0.0;
        for (std::size_t i = 0; i < before.values.size(); ++i) {
            sum += static_cast<double>(std::abs(after.values[i] - before.values[i]));
        }
        EXPECT_LT(sum, 0.2 * previous) << step_mm;
        previous = sum;
    }
}

TEST_P(RenderedGlints, AreDrawnAlikeOnBothDevices) {
    const View view = test_view(96, 72);
    Scene scene = scene_with(300.0);
    scene.environment = studio();
    scene.part_materials[0].film_nm = 320.0;
    const ImageF one = draw(scene, view);
    const ImageF other = draw(
        scene, view, Quality::normal, in_opengl() ? ShadingDevice::processor : ShadingDevice::gl);
    std::vector<double> errors;
    for (std::size_t i = 0; i < one.values.size(); ++i) {
        errors.push_back(static_cast<double>(std::abs(one.values[i] - other.values[i]) /
                                             (1.0f + one.values[i])));
    }
    expect_close("OpenGL and processor", errors);
}

TEST_P(RenderedGlints, CostNothingWhereThereAreNone) {
    const View view = test_view(48, 36);
    Scene scene = scene_with(0.0);
    RadianceRenderer renderer = renderer_of(scene, view);
    FramePlan smooth = plan(scene);
    say_why(scene, smooth);
    EXPECT_EQ(find_pass(smooth, PassKind::glint_places), nullptr);
    EXPECT_NE(find_pass(smooth, {PassKind::shade, "body", ReflectanceModel::car_paint}), nullptr);
    const auto skipped =
        std::find_if(smooth.skipped.begin(), smooth.skipped.end(), [](const SkippedPass& pass) {
            return pass.id == PassKind::glint_places;
        });
    ASSERT_NE(skipped, smooth.skipped.end());
    EXPECT_EQ(skipped->why, "no paint of the scene has glints");
    renderer.render(scene, smooth);
    const auto without = renderer.counters();
    EXPECT_EQ(without.passes_run, 5);  // surface map, visibility, directions, part, resolve

    // One array or texture of places, one program; and neither again.
    scene.part_materials[0].glint_density_per_mm2 = 100.0;
    FramePlan glinting = plan(scene);
    renderer.render(scene, glinting);
    const auto with = renderer.counters();
    EXPECT_EQ(with.textures, without.textures + 1);
    EXPECT_EQ(with.programs, without.programs + (in_opengl() ? 1 : 0));
    EXPECT_EQ(with.passes_run, without.passes_run + 3);  // places, part, resolve
    const PlannedPass* pass =
        find_pass(glinting, {PassKind::shade, "body", ReflectanceModel::car_paint, true});
    ASSERT_NE(pass, nullptr);
    EXPECT_GT(pass->work_items, 0.0);
    scene.part_materials[0].glint_density_per_mm2 = 200.0;
    FramePlan again = plan(scene);
    renderer.render(scene, again);
    EXPECT_EQ(renderer.counters().textures, with.textures);
    EXPECT_EQ(renderer.counters().programs, with.programs);
    EXPECT_EQ(renderer.counters().passes_run, with.passes_run + 2);

    // Without a light no flake shines by itself.
    scene.lights.clear();
    EXPECT_EQ(find_pass(plan(scene), PassKind::glint_places), nullptr);
    EXPECT_NE(find_pass(plan(scene), {PassKind::shade, "body", ReflectanceModel::car_paint}),
              nullptr);
}

TEST(GlintPlaces, AMockUpIsAsManyTimesDenserAsItIsSmaller) {
    Material material;
    material.glint_density_per_mm2 = 100.0;
    material.glint_scale = 5.0;
    // 25 mm of the product on one of the mock-up, its flakes drawn five times as large: 5^2.
    EXPECT_NEAR(glint_density_on_mock_up(material, 25.0), 2500.0, 1e-9);
}

TEST(GlintPlaces, APixelCoversMoreWhereItIsSeenFromTheSide) {
    const View view = look_at({0, 0, 1000}, {0, 0, 0}, 0.2, 400, 300);
    const PixelSize pixels = pixel_size_of(view);
    const double facing = pixel_side_mm(pixels, {0, 0, 0}, {0, 0, 1});
    EXPECT_NEAR(facing, 1000.0 / view.focal_px.y, 1e-9);
    EXPECT_NEAR(pixel_side_mm(pixels, {0, 0, 0}, direction_at(1.0471975512, 0.0)),
                std::sqrt(2.0) * facing,
                1e-6);
    EXPECT_NEAR(pixel_side_mm(pixels, {0, 0, -1000}, {0, 0, -1}), 2.0 * facing, 1e-9);
    // On a plane across the axis every pixel covers the same
    EXPECT_NEAR(pixel_side_mm(pixels, {120, 50, 0}, {0, 0, 1}), facing, 1e-9);
    EXPECT_LT(pixel_side_mm(pixels, {0, 0, 0}, {1, 0, 0}), 3.2 * facing);
    EXPECT_EQ(pixel_side_mm(pixels, {0, 0, 1000}, {1, 0, 0}), 0.0);
    EXPECT_EQ(pixel_side_mm(pixels, {0, 0, 2000}, {0, 0, 1}), 0.0);
}

}  // namespace
}  // namespace livery
