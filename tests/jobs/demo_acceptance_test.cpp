// The published targets, on the full benches, through the whole demo.
#include <cstdio>

#include <gtest/gtest.h>

#include "jobs/demo.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

DemoResult demo_of(const std::string& bench, const std::string& product, glm::ivec2 size_px = {}) {
    const TemporaryFolder folder;
    DemoOptions options;
    options.out = folder / "demo";
    options.bench = bench;
    options.product = product;
    options.size_px = size_px;
    options.gl_device = GlDevice::software;  // one result on all machines
    DemoResult result = run_demo(options);
    for (const DesignResult& design : result.designs)
        std::printf(
            "    %-14s %-18s median %.3f, p95 %.3f, uncorrected %.2f; valid %.2f%%, "
            "reachable %.1f%%\n",
            result.bench_name.c_str(),
            design.name.c_str(),
            design.seen.corrected.interior.median,
            design.seen.corrected.interior.p95,
            design.seen.uncorrected.interior.median,
            100.0 * design.seen.corrected.valid_fraction,
            100.0 * design.seen.corrected.reachable_fraction);
    return result;
}

/// In the eye's picture, and each projector pixel by itself.
void expect_close(const DesignResult& design, double median, double p95) {
    for (const JudgedPictures* judged : {&design.seen, &design.pixels}) {
        SCOPED_TRACE(judged == &design.seen ? "the eye's picture" : "projector pixels");
        EXPECT_GT(judged->corrected.interior.pixels, 100'000u);
        EXPECT_LE(judged->corrected.interior.median, median);
        EXPECT_LE(judged->corrected.interior.p95, p95);
        EXPECT_GE(judged->corrected.valid_fraction, 0.95);
    }
}

TEST(Acceptance, FourLooksOnTheCleanBench) {
    const DemoResult result = demo_of("default", "car");
    ASSERT_EQ(result.designs.size(), 4u);
    EXPECT_EQ(result.calibration.table.grid, 0) << "a false alarm of a clear segment";
    for (const DesignResult& design : result.designs) {
        SCOPED_TRACE(design.name);
        expect_close(design, 0.5, 1.5);
        EXPECT_GE(design.seen.corrected.reachable_fraction, 0.7);
        EXPECT_GE(design.seen.uncorrected.interior.median,
                  10.0 * design.seen.corrected.interior.median);
    }
}

TEST(Acceptance, NightlyFourLooksOnAProjectorWithAWhiteSegment) {
    const DemoResult result = demo_of("white-segment", "car");
    ASSERT_EQ(result.designs.size(), 4u);
    EXPECT_GT(result.calibration.table.grid, 0) << "the clear segment was not found";
    for (const DesignResult& design : result.designs) {
        SCOPED_TRACE(design.name);
        expect_close(design, 0.5, 1.0);
    }
}

// The truth is the paint's spectral colour, the render knows its Rec.709 colour under D65: to the
// chain's 0.5 comes what the paint's RGB misses under other angles (flakes, clear coat). The paper
// calls differences under 3 hard to see; half of that is asked for.
TEST(Acceptance, NightlySixPaintsOnTheSphere) {
    const DemoResult result = demo_of("default", "sphere");
    ASSERT_EQ(result.designs.size(), 6u);
    for (const DesignResult& design : result.designs) {
        SCOPED_TRACE(design.name);
        EXPECT_LE(design.seen.corrected.interior.median, 1.5);
        EXPECT_GE(design.seen.corrected.valid_fraction, 0.95);
    }
}

}  // namespace
}  // namespace livery
