#include "calibration/colour/drive_table.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "calibration/correspondence/patterns.h"
#include "calibration/support/messages.h"
#include "core/error.h"
#include "core/random.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using LightOf = std::function<glm::dvec3(glm::dvec3 u)>;

glm::dvec3 channel_light(const std::array<std::uint8_t, 3>& drive) {
    return {std::pow(drive[0] / 255.0, 2.2),
            std::pow(drive[1] / 255.0, 2.0),
            std::pow(drive[2] / 255.0, 2.4)};
}

/// All colours of six mosaics, as one block each.
std::vector<TableSample> mosaic_samples(const LightOf& light, double sigma) {
    std::vector<TableSample> samples;
    const glm::dvec3 white = light(glm::dvec3(1.0));
    Random random(6);
    for (const Pattern& pattern : mosaic_patterns(640, 400, 6))
        for (int y = 4; y < 400; y += 8)
            for (int x = 4; x < 640; x += 8) {
                const std::uint8_t* const d = pattern.drive.pixel(x, y);
                const std::array<std::uint8_t, 3> drive{d[0], d[1], d[2]};
                glm::dvec3 n = light(channel_light(drive)) / white;
                for (int k = 0; k < 3; ++k) n[k] += sigma * random.normal();
                samples.push_back({drive, n, sigma * sigma});
            }
    samples.push_back({{0, 0, 0}, glm::dvec3(0.0), 1e-9});
    samples.push_back({{255, 255, 255}, glm::dvec3(1.0), 1e-9});
    for (std::size_t k = 0; k < 3; ++k) {
        std::array<std::uint8_t, 3> drive{};
        drive[k] = 255;
        samples.push_back({drive, light(channel_light(drive)) / white, 1e-9});
    }
    return samples;
}

double largest_error_at_nodes(const TableFit& fit, const LightOf& light) {
    const int grid = fit.table.grid;
    double largest = 0.0;
    std::size_t i = 0;
    for (int b = 0; b < grid; ++b)
        for (int g = 0; g < grid; ++g)
            for (int r = 0; r < grid; ++r, ++i) {
                const double step = 1.0 / (grid - 1);
                const glm::dvec3 u(
                    std::pow(r * step, 2.2), std::pow(g * step, 2.0), std::pow(b * step, 2.4));
                const glm::dvec3 n = light(u) / light(glm::dvec3(1.0));
                for (int k = 0; k < 3; ++k)
                    largest = worse_of(
                        largest,
                        std::abs(static_cast<double>(fit.table.n_from_drive[i][k]) - n[k]));
            }
    return largest;
}

double smallest(glm::dvec3 u) { return std::min({u.x, u.y, u.z}); }

TEST(DriveTable, DescribesWhiteSegmentsOfAnyLaw) {
    const std::vector<std::pair<const char*, LightOf>> laws = {
        {"additive", [](glm::dvec3 u) { return u; }},
        {"clear segment",
         [](glm::dvec3 u) { return u + glm::dvec3(1.27, 1.2, 1.0) * smallest(u); }},
        {"from half up",
         [](glm::dvec3 u) { return u + glm::dvec3(0.8) * std::max(0.0, smallest(u) - 0.5); }},
        {"squared", [](glm::dvec3 u) { return u + glm::dvec3(0.8) * smallest(u) * smallest(u); }},
        {"secondary colours too",
         [](glm::dvec3 u) {
             return u + glm::dvec3(0.5) * smallest(u) +
                    glm::dvec3(0.2, 0.2, 0.0) * std::min(u.x, u.y);
         }},
    };
    for (const auto& [name, light] : laws)
        for (const double sigma : {0.0, 0.003}) {
            const TableFit fit = fit_drive_table(mosaic_samples(light, sigma));
            ASSERT_EQ(fit.table.n_from_drive.size(),
                      static_cast<std::size_t>(fit.table.grid * fit.table.grid * fit.table.grid));
            // 0.5% of white is CIEDE2000 0.2 in the middle tones; noise averages over thousands.
            EXPECT_LT(largest_error_at_nodes(fit, light), 0.005 + sigma)
                << name << ", sigma " << sigma;
            EXPECT_LT(fit.rms_error, 0.003) << name;
            for (const ResponseCurve& curve : fit.response) {
                EXPECT_NEAR(curve.drive_from_n.back(), 255.0f, 0.01f);
                EXPECT_NEAR(curve.drive_from_n.front(), 0.0f, 3.0f);
            }
        }
}

TEST(DriveTable, RefusesWhatItCannotDescribe) {
    auto samples = mosaic_samples([](glm::dvec3 u) { return u; }, 0.0);
    Random random(8);
    auto scattered = samples;
    for (TableSample& s : scattered) s.n += glm::dvec3(0.1 * random.normal());
    EXPECT_HAS(message_of<Refused>([&] { fit_drive_table(scattered); }), "do not follow one table");
    std::erase_if(samples, [](const TableSample& s) { return s.drive[1] == 0 && s.drive[2] == 0; });
    EXPECT_HAS(message_of<Refused>([&] { fit_drive_table(samples); }), "levels of red alone");
}

}  // namespace
}  // namespace livery
