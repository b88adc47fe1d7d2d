#include "calibration/camera_response.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/error.h"
#include "core/random.h"
#include "core/worst_error.h"

namespace livery {
namespace {

/// A scene over three orders of magnitude, in squares of one light, 8 bits after a curve, with
/// noise before it.
std::vector<Photograph> exposures_of(const std::function<double(double)>& file_from_linear,
                                     const std::vector<double>& exposures_s) {
    constexpr int kWidth = 320, kHeight = 240, kSquare = 5;
    constexpr double kNoise = 0.002;
    Random random(4);
    std::vector<double> light(kWidth / kSquare * (kHeight / kSquare) * 3);
    for (double& value : light) value = std::pow(10.0, -2.6 + 2.9 * random.uniform());
    std::vector<Photograph> photographs;
    for (const double exposure_s : exposures_s) {
        Photograph photograph;
        photograph.exposure_s = exposure_s;
        photograph.image = ImageF(kWidth, kHeight, 3);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < 3; ++c) {
                    const auto square = static_cast<std::size_t>(
                        (y / kSquare * (kWidth / kSquare) + x / kSquare) * 3 + c);
                    const double linear =
                        light[square] * exposure_s + kNoise * (random.uniform() - 0.5);
                    photograph.image.at(x, y, c) = static_cast<float>(
                        std::round(255.0 * file_from_linear(std::clamp(linear, 0.0, 1.0))));
                }
        photographs.push_back(std::move(photograph));
    }
    return photographs;
}

double linear_of(const std::function<double(double)>& curve, double file) {
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 60; ++k)
        (curve(0.5 * (low + high)) < file ? low : high) = 0.5 * (low + high);
    return low;
}

/// The largest error of light anywhere on the curve; its scale is free.
double worst_error(const CameraResponse& found, const std::function<double(double)>& curve) {
    const double scale = linear_of(curve, 180.0 / 255.0) / found.linear_from_file[180];
    double worst = 0.0;
    for (const std::size_t value : {12u, 25u, 50u, 100u, 150u, 210u, 240u})
        worst = worse_of(worst,
                         std::abs(scale * found.linear_from_file[value] /
                                      linear_of(curve, static_cast<double>(value) / 255.0) -
                                  1.0));
    return worst;
}

const std::vector<double> kExposures{1.0, 4.0, 2.0, 1.4, 0.7, 0.5, 0.35, 0.25, 0.125};

TEST(CameraResponse, IsRecoveredFromExposures) {
    const std::vector<std::pair<const char*, std::function<double(double)>>> curves{
        {"sRGB", [](double x) { return srgb_encode(x); }},
        {"linear", [](double x) { return x; }},
        {"gamma 1.8", [](double x) { return std::pow(x, 1.0 / 1.8); }},
        {"a picture style", [](double x) {
             const double y = srgb_encode(x);
             return 0.7 * y + 0.3 * y * y * (3.0 - 2.0 * y);
         }}};
    for (const auto& [name, curve] : curves) {
        const CameraResponse found = fit_camera_response(exposures_of(curve, kExposures));
        ASSERT_EQ(found.linear_from_file.size(), 256u);
        EXPECT_TRUE(std::is_sorted(found.linear_from_file.begin(), found.linear_from_file.end()));
        // A level of 8 bits is 8% of the light at level 12 of a gamma of 2; 20 blocks know it to
        // 2%.
        EXPECT_LT(worst_error(found, curve), 0.02) << name;
        std::cout << name << ": residual " << found.residual << ", worst error "
                  << worst_error(found, curve) << '\n';
    }
}

TEST(CameraResponse, BearsAShutterThatRepeatsToHalfAPercent) {
    const auto curve = [](double x) { return srgb_encode(x); };
    auto photographs = exposures_of(curve, kExposures);
    Random random(9);
    for (Photograph& photograph : photographs)
        photograph.exposure_s *= 1.0 + 0.01 * (random.uniform() - 0.5);
    const CameraResponse found = fit_camera_response(photographs);
    std::cout << "worst error " << worst_error(found, curve) << '\n';
    // Half a percent over the range of 32 is .15% of the curve's power, of ln(120) at level 12.
    EXPECT_LT(worst_error(found, curve), 0.02);
}

TEST(CameraResponse, RefusesWhatDoesNotFollow) {
    const auto srgb = [](double x) { return srgb_encode(x); };
    EXPECT_THROW(fit_camera_response(exposures_of(srgb, {1.0, 0.8, 0.6})), Refused);
    // Automatic exposure: all alike, whatever was asked for
    auto photographs = exposures_of(srgb, {1.0, 1.0, 1.0, 1.0});
    for (std::size_t k = 0; k < photographs.size(); ++k)
        photographs[k].exposure_s = std::pow(0.5, static_cast<double>(k));
    EXPECT_THROW(fit_camera_response(photographs), Refused);
    EXPECT_THROW(fit_camera_response({photographs[0]}), std::invalid_argument);
}

TEST(CameraResponse, PhotographsWhiteAtManyExposures) {
    std::vector<double> asked;
    int shown = -1;
    BenchPorts ports;
    ports.show = [&](const Image8& drive) { shown = drive.values[0]; };
    ports.photograph = [&](double exposure_s) {
        Photograph photograph;
        photograph.exposure_s = exposure_s > 0.0 ? exposure_s : 0.2;
        asked.push_back(photograph.exposure_s);
        return photograph;
    };
    const auto photographs = photograph_exposures(ports, 16, 16);
    EXPECT_EQ(shown, 255);
    EXPECT_EQ(photographs.size() + 1, asked.size());
    EXPECT_DOUBLE_EQ(*std::max_element(asked.begin(), asked.end()), 0.8);
    EXPECT_DOUBLE_EQ(*std::min_element(asked.begin(), asked.end()), 0.0125);
}

}  // namespace
}  // namespace livery
