#include "ledger/speed_sweep.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/paths.h"
#include "core/text/markup.h"
#include "ledger/speed_report.h"
#include "radiance/surface_map.h"
#include "scene/library.h"
#include "support/temporary_folder.h"
#include "twin/description.h"

namespace livery {
namespace {

/// ms = scale * pixels^slope exactly, on one thread and, twice as quick, on two.
std::vector<SweepPoint> power_law(double scale, double slope) {
    std::vector<SweepPoint> sweep;
    for (const double pixels : {2e3, 3e4, 4e5, 5e6}) {
        for (const int threads : {1, 2}) {
            SweepPoint point;
            point.width = static_cast<int>(std::sqrt(pixels * 4.0));
            point.height = point.width / 2;
            point.threads = threads;
            point.repeats = 31;
            point.pixels = pixels;
            point.coverage = 0.39;
            for (SweepTime& time : point.times) {
                time.ms = scale * std::pow(pixels, slope) / threads;
                time.fastest_ms = 0.9 * time.ms;
            }
            sweep.push_back(point);
        }
    }
    return sweep;
}

TEST(SpeedSweep, FitsAPowerLaw) {
    const PowerLaw linear = fit_power_law(power_law(3e-5, 1.0), SwapStage::whole, 2);
    EXPECT_NEAR(linear.slope, 1.0, 1e-9);
    EXPECT_NEAR(linear.scale, 1.5e-5, 1e-9);
    EXPECT_NEAR(linear.r2, 1.0, 1e-9);
    EXPECT_NEAR(linear.spread, 1.0, 1e-9);
    const PowerLaw root = fit_power_law(power_law(3e-5, 0.5), SwapStage::shading, 1);
    EXPECT_NEAR(root.slope, 0.5, 1e-9);
    EXPECT_NEAR(root.spread, std::sqrt(2500.0), 1e-6);

    // A full-screen cost shows: the smallest mock-up pays for it.
    std::vector<SweepPoint> sweep = power_law(3e-5, 1.0);
    for (SweepPoint& point : sweep) point.times.back().ms += 2.0;
    const PowerLaw constant = fit_power_law(sweep, SwapStage::whole, 2);
    EXPECT_LT(constant.slope, 0.9);
    EXPECT_LT(constant.r2, 0.95);
    EXPECT_GT(constant.spread, 10.0);

    EXPECT_EQ(fit_power_law({}, SwapStage::whole, 1).slope, 0.0);
    EXPECT_EQ(threads_of(sweep), (std::vector<int>{1, 2}));
}

TEST(SpeedSweep, ZoomsUntilTheMockUpCoversItsShare) {
    const auto product = find_product("car");
    const View projector = read_bench_file("default").projector.view;
    const Tracer tracer(product->mesh);
    for (const auto& [width, height] : {std::pair(640, 400), std::pair(640, 360)}) {
        for (const double coverage : {0.01, 0.15, 0.6}) {
            const View view = zoomed_to_coverage(*product, projector, width, height, coverage);
            EXPECT_EQ(view.width, width);
            EXPECT_EQ(view.height, height);
            EXPECT_NEAR(view.focal_px.x / view.focal_px.y,
                        projector.focal_px.x / projector.focal_px.y,
                        1e-9);
            const SurfaceMap map = build_surface_map(product->mesh, tracer, view, 16);
            double covered = 0.0;
            for (const float share : map.coverage.values) covered += static_cast<double>(share);
            EXPECT_NEAR(covered / (width * height), coverage, 0.03 * coverage);
        }
    }
}

TEST(SpeedSweep, PlotNamesItsSeriesAndHoldsEveryPoint) {
    const std::string svg = sweep_svg(power_law(3e-5, 1.0));
    EXPECT_EQ(svg.rfind("<svg ", 0), 0u);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    std::size_t circles = 0;
    for (std::size_t at = svg.find("<circle"); at != std::string::npos;
         at = svg.find("<circle", at + 1)) {
        ++circles;
    }
    EXPECT_EQ(circles, 5u * 4u);
    for (const char* words : {"whole swap, 1 thread<",
                              "whole swap, 2 threads<",
                              "correction, 2 threads<",
                              "15.0 ns a pixel · slope 1.00 · R² 1.000"}) {
        EXPECT_NE(svg.find(words), std::string::npos) << words;
    }
    EXPECT_THROW(sweep_svg({}), std::invalid_argument);
}

TEST(BenchTable, RewritesItsBlockOnly) {
    const TemporaryFolder folder;
    SpeedLedger result;
    result.renderer = "llvmpipe";
    result.threads = 2;
    result.sweep = power_law(3e-5, 1.0);
    LedgerLevel level;
    level.name = "1280x800";
    level.ms = 2.25;
    level.fastest_ms = 2.0;
    level.repeats = 31;
    result.effects = {{"correction", {level}}};
    const auto file = folder.write(
        "page.md", "# Page\n<!-- bench: begin -->\nold\n<!-- bench: end -->\n\nThe rest.\n");
    for (int k = 0; k < 2; ++k) {
        check_marked_block(file, "bench");
        replace_marked_block(file, "bench", markdown_of(result));
        const std::string text = read_text_file(file);
        EXPECT_EQ(text.rfind("# Page\n<!-- bench: begin -->\nMeasured", 0), 0u);
        EXPECT_TRUE(text.ends_with("|\n<!-- bench: end -->\n\nThe rest.\n")) << text;
        EXPECT_EQ(text.find("old"), std::string::npos);
        EXPECT_NE(text.find("| correction | 1280x800 | 2.2 (2.0) |"), std::string::npos) << text;
        EXPECT_NE(text.find("| 400k | 6.00 | 6.00 | 6.00 | **6.00** (5.40) | 12.00 | 15.0 |"),
                  std::string::npos)
            << text;
    }

    const auto plain = folder.write("plain.md", "# Page\n");
    try {
        check_marked_block(plain, "bench");
        FAIL();
    } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find("<!-- bench: begin -->"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("plain.md"), std::string::npos);
    }
    EXPECT_THROW(replace_marked_block(folder / "none.md", "bench", "x"), FileError);
    EXPECT_EQ(read_text_file(plain), "# Page\n");
}

}  // namespace
}  // namespace livery
