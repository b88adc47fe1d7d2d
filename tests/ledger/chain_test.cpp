// The chain's rows, their tables, and what needs no picture: three channels for a spectrum.
#include "ledger/accuracy/chain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "ledger/accuracy/chain_spectra.h"
#include "ledger/accuracy/chain_steps.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

ChainPart part_named(const std::string& what, bool slow, int* measured) {
    ChainPart part;
    part.rows = {{what, "low", "the truth"}, {what, "high", "the truth"}};
    part.slow = slow;
    part.inputs = [] { return "inputs"; };
    part.measure = [measured](std::vector<ChainRow>& rows, const Progress&) {
        ++*measured;
        set_errors(rows[0], {1.0f, 2.0f, 3.0f});
        set_errors(rows[1], {0.5f});
        rows[1].ms = 4.0;
    };
    return part;
}

TEST(ChainRows, AreMeasuredOnceAndKept) {
    const TemporaryFolder folder;
    AccuracyOptions options;
    options.folder = folder.path();
    int measured = 0;
    std::vector<ChainPart> parts{part_named("a", false, &measured)};
    for (int run = 0; run < 2; ++run) {
        const std::vector<ChainRow> rows = measured_rows(parts, options);
        ASSERT_EQ(rows.size(), 2u);
        EXPECT_EQ(rows[0].median, 2.0);
        EXPECT_EQ(rows[0].p99, 3.0);
        EXPECT_EQ(rows[0].compared, 3u);
        EXPECT_FALSE(rows[0].ms.has_value());
        EXPECT_EQ(rows[1].ms, 4.0);
        EXPECT_EQ(rows[1].missing, "");
        EXPECT_EQ(measured, 1);
    }
    const std::string hash = hash_of(parts[0]);
    parts[0].inputs = [] { return "others"; };
    measured_rows(parts, options);
    EXPECT_EQ(measured, 2);
    std::ofstream(folder.path() / "rows" / (hash + ".json"))
        << "{\"format_version\": 1, \"rows\": [{\"what\": 3}]}";
    EXPECT_THROW(read_chain_rows(folder.path() / "rows", hash), FileError);
}

TEST(ChainRows, OfErrorsWithoutAnEndAreNotKept) {
    const TemporaryFolder folder;
    ChainRow row{"a", "b", "c"};
    set_errors(row, {0.0f, std::numeric_limits<float>::quiet_NaN()});
    EXPECT_TRUE(std::isinf(row.p99));
    write_chain_rows(folder.path(), "hash", {row});
    EXPECT_FALSE(read_chain_rows(folder.path(), "hash").has_value());
}

TEST(ChainRows, ThatAreLeftOutSayWhy) {
    const TemporaryFolder folder;
    AccuracyOptions options;
    options.folder = folder.path();
    options.quick = true;
    options.shards = 2;
    int measured = 0;
    const std::vector<ChainPart> parts{part_named("quick", false, &measured),
                                       part_named("slow", true, &measured),
                                       part_named("first shard's", false, &measured),
                                       part_named("second shard's", false, &measured)};
    ChainLedger ledger;
    ledger.rows = measured_rows(parts, options);
    EXPECT_EQ(measured, 2);
    ASSERT_EQ(ledger.rows.size(), 8u);
    EXPECT_EQ(ledger.rows[2].missing, "not measured by --quick");
    EXPECT_EQ(ledger.rows[4].missing, "");
    EXPECT_EQ(ledger.rows[6].missing, "another shard's, not there yet");
    for (const std::string& text : {markdown_of(ledger), csv_of(ledger)}) {
        EXPECT_NE(text.find("not measured by --quick"), std::string::npos) << text;
        EXPECT_NE(text.find("the truth"), std::string::npos) << text;
    }
    // What an earlier run has kept is there for a quick one
    options.quick = false;
    options.shards = 1;
    measured_rows(parts, options);
    options.quick = true;
    for (const ChainRow& row : measured_rows(parts, options)) EXPECT_EQ(row.missing, "");
    EXPECT_EQ(measured, 4);
    const std::vector<LedgerEffect> effects = effects_of(ledger);
    ASSERT_EQ(effects.size(), 4u);
    EXPECT_EQ(effects[0].levels[0].repeats, 0) << "it takes no time of its own";
    EXPECT_EQ(effects[0].levels[1].ms, 4.0);
    EXPECT_EQ(effects[0].levels[0].error, 2.0);
    EXPECT_EQ(effects[0].levels[0].unit, "CIEDE2000");
    EXPECT_EQ(effects[0].levels[0].against, "the truth");
    EXPECT_FALSE(effects[1].levels[0].error.has_value());
    EXPECT_EQ(effects[1].levels[0].missing, "not measured by --quick");
}

TEST(ChainParts, HaveRowsOfTheirOwn) {
    std::vector<std::string> names;
    for (const ChainPart& part : chain_parts({})) {
        EXPECT_FALSE(part.rows.empty());
        for (const ChainRow& row : part.rows) {
            EXPECT_FALSE(row.what.empty() || row.level.empty() || row.against.empty());
            const std::string name = row.what + ": " + row.level;
            EXPECT_EQ(std::count(names.begin(), names.end(), name), 0) << name;
            names.push_back(name);
        }
    }
}

// White is known in four digits of its chromaticity: 1.6e-4 of X and Z, which is 0.03 in a* and b*
// of white. Light and every reflectance have it once.
TEST(ThreeChannels, AreExactForGreys) {
    Spectrum grey{}, dark{};
    grey.fill(0.5);
    dark.fill(0.1);
    for (const NamedSpectrum& light : known_lights()) {
        EXPECT_LT(three_channel_error(std::array<Spectrum, 1>{grey}, light.values), 0.1)
            << light.name;
        EXPECT_LT(three_channel_error(std::array<Spectrum, 2>{grey, dark}, light.values), 0.1)
            << light.name;
    }
}

TEST(ThreeChannels, AreExactForAnyPaintInD65AndForNoColourTwice) {
    for (const NamedSpectrum& paint : known_reflectances()) {
        EXPECT_LE(*std::max_element(paint.values.begin(), paint.values.end()), 1.0) << paint.name;
        EXPECT_LT(three_channel_error(std::array<Spectrum, 1>{paint.values}, illuminant_d65()), 0.1)
            << paint.name;
    }
    // Two narrow bands that do not meet reflect nothing; three channels let some of it through
    Spectrum low{}, high{};
    for (std::size_t k = 0; k < low.size(); ++k) (k < 30 ? low : high)[k] = 1.0;
    EXPECT_GT(three_channel_error(std::array<Spectrum, 2>{low, high}, illuminant_d65()), 5.0);
}

TEST(ThreeChannels, HaveARowForEachLight) {
    ChainPart part = spectral_parts({}).at(0);
    part.measure(part.rows, {});
    EXPECT_EQ(part.rows.size(), 2 * known_lights().size());
    for (const ChainRow& row : part.rows) {
        EXPECT_GE(row.compared, 30u) << row.what << ", " << row.level;
        EXPECT_TRUE(std::isfinite(row.p99)) << row.what << ", " << row.level;
        EXPECT_LE(row.median, row.p99);
        EXPECT_GT(row.p99, 0.0);
    }
}

}  // namespace
}  // namespace livery
