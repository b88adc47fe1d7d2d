// The correction's rows on a bench with a sixteenth of its pixels.
#include "ledger/accuracy/chain_correction.h"

#include <cmath>

#include <gtest/gtest.h>

#include "scene/view.h"

namespace livery {
namespace {

TEST(CorrectionRows, CountInteriorPixelsOfOneKind) {
    Comparison comparison;
    comparison.de00 = ImageF(5, 1, 1);
    comparison.de00.values = {1.0f, 2.0f, 3.0f, 4.0f, 5.0f};
    ComparisonMasks masks{Image8(5, 1, 1, 255),
                          Image8(5, 1, 1),
                          Image8(5, 1, 1, 255),
                          Image8(5, 1, 1, 255),
                          Image8()};
    masks.edge.values[1] = 255;
    masks.valid.values[2] = 0;
    masks.reachable.values[3] = 0;
    EXPECT_EQ(interior_errors(comparison, masks, true), (std::vector<float>{1.0f, 5.0f}));
    EXPECT_EQ(interior_errors(comparison, masks, false), (std::vector<float>{4.0f}));
    masks.lit.values[4] = 0;
    EXPECT_EQ(interior_errors(comparison, masks, true), (std::vector<float>{1.0f}));
}

TEST(CorrectionRows, OfASmallBenchAreAllMeasured) {
    BenchDescription description = read_bench_file("default");
    description.projector.view = resized(description.projector.view, 320, 200);
    description.camera.view = resized(description.camera.view, 432, 288);
    const HeadlessContext context(GlDevice::automatic);
    std::vector<ChainRow> rows = correction_rows("small");
    ASSERT_EQ(rows.size(), 9u);
    measure_corrections(description, {"solid-red"}, Quality::draft, rows);
    for (const ChainRow& row : rows) {
        SCOPED_TRACE(row.what + ", " + row.level);
        EXPECT_GT(row.compared, 0u);
        EXPECT_TRUE(std::isfinite(row.p99));
        EXPECT_LE(row.median, row.p95);
        EXPECT_LE(row.p95, row.p99);
    }
    EXPECT_FALSE(rows[0].ms.has_value());
    // The published targets of the clean bench: 0.5, and ten times that without a correction
    for (std::size_t k = 2; k < 5; ++k) EXPECT_LT(rows[k].median, 0.5) << rows[k].level;
    EXPECT_GT(rows[0].median, 5.0);
    EXPECT_EQ(rows[5].median, rows[3].median) << "strict is what the other rows have";
}

}  // namespace
}  // namespace livery
