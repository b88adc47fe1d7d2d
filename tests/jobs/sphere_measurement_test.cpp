// livery measure brdf, from photographs with noise to a paint.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "appearance/fit/fit_brdf.h"
#include "core/image_io.h"
#include "core/worst_error.h"
#include "jobs/sphere_bench.h"
#include "support/file_error.h"

namespace livery {
namespace {

void print(const char* what, const SphereMeasurement& report, const ReflectanceDifference& off) {
    fmt::print(
        "{}: coverage {:.3f}, residual {:.4f} (median {:.4f}), outline {:.3f} px, diameter "
        "{:.3f} mm; luminance {:.4f} (median) {:.4f} (95%), CIEDE2000 {:.3f} (mean) {:.3f} "
        "(95%)\n",
        what,
        report.reflectance.coverage,
        report.reflectance.residual,
        report.reflectance.residual_median,
        report.outline.rms_px,
        report.outline.sphere.diameter_mm,
        off.relative_median,
        off.relative_p95,
        off.de00_mean,
        off.de00_p95);
}

BrdfFit fit_to(const MeasuredReflectance& measured, ReflectanceModel model) {
    const FitSamples samples = fit_samples(value_of(measured), [&](const DirectionPair& pair) {
        return is_measured(measured, pair.wi, pair.wo);
    });
    return fit_model(model, samples, value_of(measured));
}

TEST(SphereMeasurement, LambertsReflectanceIsExactToNoise) {
    const SphereBench bench(lambert_paint(), 256);
    const SphereMeasurement report = bench.measure();
    const MeasuredReflectance measured = bench.measured();
    const auto off = difference_of(value_of(measured), reflectance_of(lambert_paint()));
    print("chalk", report, off);
    // A wrong factor anywhere (exposure, distance, cosine, pi, the white's reflectance) shows here.
    EXPECT_LT(off.relative_median, 0.005);
    EXPECT_LT(off.relative_p95, 0.02);
    EXPECT_LT(off.de00_mean, 0.5);
    EXPECT_GT(report.reflectance.coverage, 0.9);
    EXPECT_LT(report.reflectance.residual, 0.05);
    EXPECT_LT(report.reflectance.residual_median, 0.01);
    EXPECT_EQ(report.lamps, bench.taken.lamps);
    EXPECT_EQ(report.photographs + report.white_photographs, bench.taken.photographs);
    EXPECT_LT(report.white_rms, 0.03);
    EXPECT_EQ(report.camera_colours, "matrix");
    EXPECT_TRUE(report.notes.empty()) << report.notes.front();
}

TEST(SphereMeasurement, NightlyAMattePaintIsRecovered) {
    const SphereBench bench(matte_paint(), 256);
    const SphereMeasurement report = bench.measure();
    const MeasuredReflectance measured = bench.measured();
    const auto off = difference_of(value_of(measured), reflectance_of(matte_paint()));
    print("matte ochre", report, off);
    EXPECT_LT(off.de00_mean, 1.0);
    const BrdfFit fit = fit_to(measured, ReflectanceModel::eon);
    const auto fitted = difference_of(reflectance_of(fit.material), reflectance_of(matte_paint()));
    EXPECT_LT(fitted.de00_mean, 0.5);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(fit.material.diffuse[c], matte_paint().diffuse[c], 0.01) << c;
    }
    EXPECT_NEAR(fit.material.diffuse_roughness, 0.5, 0.05);
}

TEST(SphereMeasurement, NightlyAGlossySolidPaintIsRecovered) {
    const SphereBench bench(solid_paint(), 512);
    const SphereMeasurement report = bench.measure();
    const MeasuredReflectance measured = bench.measured();
    const auto off = difference_of(value_of(measured), reflectance_of(solid_paint()));
    print("glossy green", report, off);
    EXPECT_LT(off.de00_mean, 2.0);
    const BrdfFit fit = fit_to(measured, ReflectanceModel::clearcoat);
    const auto fitted = difference_of(reflectance_of(fit.material), reflectance_of(solid_paint()));
    fmt::print(
        "  fit: coat alpha {:.4f}, f0 {:.4f}, diffuse {:.3f} {:.3f} {:.3f}, CIEDE2000 {:.3f}\n",
        fit.material.coat_alpha,
        fit.material.coat_f0,
        fit.material.diffuse.x,
        fit.material.diffuse.y,
        fit.material.diffuse.z,
        fitted.de00_mean);
    EXPECT_LT(fitted.de00_mean, 2.0);
    EXPECT_NEAR(fit.material.coat_alpha, 0.05, 0.006);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(fit.material.diffuse[c], solid_paint().diffuse[c], 0.03) << c;
    }
}

TEST(SphereMeasurement, NightlyAMetallicPaintIsRecovered) {
    const SphereBench bench(metallic_paint(), 320);
    const SphereMeasurement report = bench.measure();
    const MeasuredReflectance measured = bench.measured();
    const auto off = difference_of(value_of(measured), reflectance_of(metallic_paint()));
    print("coarse silver", report, off);
    EXPECT_LT(off.de00_mean, 2.0);
    const BrdfFit fit = fit_to(measured, ReflectanceModel::ggx);
    const auto fitted =
        difference_of(reflectance_of(fit.material), reflectance_of(metallic_paint()));
    fmt::print("  fit: alpha {:.4f}, f0 {:.4f}, CIEDE2000 {:.3f}\n",
               fit.material.alpha.x,
               fit.material.f0.y,
               fitted.de00_mean);
    EXPECT_LT(fitted.de00_mean, 0.5);
    EXPECT_NEAR(fit.material.alpha.x, 0.3, 0.006);
    EXPECT_NEAR(fit.material.f0.y, 0.56, 0.015);
}

TEST(SphereMeasurement, NightlyTheOutlineRepairsAWrongSphere) {
    SphereBench bench(metallic_paint(), 320);
    bench.manifest["sphere"] = {{"centre_mm", {1.0, -1.0, 0.0}}, {"diameter_mm", 61.0}};
    bench.rewrite();
    const SphereMeasurement report = bench.measure();
    const MeasuredReflectance measured = bench.measured();
    const auto off = difference_of(value_of(measured), reflectance_of(metallic_paint()));
    print("coarse silver, sphere 1 mm off", report, off);
    EXPECT_LT(glm::length(report.outline.sphere.centre_mm), 0.1);
    EXPECT_NEAR(report.outline.sphere.diameter_mm, 60.0, 0.1);
    EXPECT_LT(off.de00_mean, 2.0);
    EXPECT_LT(report.reflectance.residual_median, 0.03);
}

TEST(SphereMeasurement, NightlyFlareAndSaturationAreLeftOut) {
    CameraDescription camera = noisy_camera();
    camera.flare = 0.01;
    SphereBench bench(solid_paint(), 320, camera);
    // The shortest exposure of each lamp is missing: highlights are saturated.
    Json captures = Json::array();
    glm::dvec3 last(0.0);
    for (const Json& capture : bench.manifest["captures"]) {
        const auto& at = capture["light_position_mm"];
        const glm::dvec3 lamp(at[0].get<double>(), at[1].get<double>(), at[2].get<double>());
        if (glm::distance(lamp, last) > 1.0) {
            last = lamp;
            continue;
        }
        captures.push_back(capture);
    }
    bench.manifest["captures"] = captures;
    bench.rewrite();
    const SphereMeasurement report = bench.measure();
    EXPECT_GT(report.reflectance.saturated, 100u);
    const MeasuredReflectance measured = bench.measured();
    // Off the highlight the paint is as it is.
    std::vector<double> errors;
    for (const DirectionPair& pair : lit_sphere_pairs(24)) {
        const glm::dvec3 h = glm::normalize(pair.wi + pair.wo);
        if (h.z > 0.95 || pair.wi.z < 0.2 || pair.wo.z < 0.2) continue;
        const double truth = reflectance_of(solid_paint())(pair.wi, pair.wo).y;
        errors.push_back(
            worst_if_nan(std::abs(evaluate(measured, pair.wi, pair.wo).y / truth - 1.0)));
    }
    std::sort(errors.begin(), errors.end());
    fmt::print("flare of 1%: off by {:.4f} (median), {:.4f} (95%)\n",
               errors[errors.size() / 2],
               errors[errors.size() * 95 / 100]);
    EXPECT_LT(errors[errors.size() / 2], 0.05);
}

TEST(SphereMeasurement, EightBitPicturesWithACurveWillDo) {
    CameraDescription camera = noisy_camera();
    camera.encoding = CameraEncoding::srgb8;
    const SphereBench bench(matte_paint(), 256, camera);
    EXPECT_EQ(bench.manifest["transfer"], "srgb");
    const SphereMeasurement report = bench.measure();
    const MeasuredReflectance measured = bench.measured();
    const auto off = difference_of(value_of(measured), reflectance_of(matte_paint()));
    print("matte ochre, 8 bit", report, off);
    EXPECT_LT(off.de00_mean, 2.0);
}

}  // namespace
}  // namespace livery
