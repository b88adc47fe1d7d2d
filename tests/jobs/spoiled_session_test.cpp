// What goes wrong while a live calibration runs, on a bench to which it happens: the operator must
// read the same cause and the same picture's name as from photographs in a folder.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "calibration/correspondence/patterns.h"
#include "session/small_session.h"
#include "support/kept_light.h"
#include "support/thorough.h"

namespace livery {
namespace {

using testing::live_settings;
using testing::small_bench_description;
using testing::small_bench_product;

/// Why the calibration was refused, else its warnings.
std::string said_of(const BenchPorts& ports, const BenchDescription& description) {
    try {
        const CalibrationResult result = calibrate_live(ports, live_settings(description));
        return "accepted: " + testing::all_warnings(result.calibration);
    } catch (const Refused& refused) {
        return "refused: " + refused.why() + "; " + refused.fix();
    }
}

/// Numbers of the photographs of each picture, by a session without mishaps: the same calls in the
/// same order give the same photographs until something happens.
int number_of(const std::string& role) {
    static const std::map<std::string, int> numbers = [] {
        std::map<std::string, int> found;
        const BenchDescription description = small_bench_description();
        Bench bench = testing::bench_on_kept_light(description, small_bench_product());
        int taken = 0;
        BenchPorts ports = bench.ports();
        ports.photograph = [&, take = ports.photograph](double exposure_s) {
            ++taken;
            return take(exposure_s);
        };
        Progress progress;
        progress.report = [&](double, std::string_view stage) {
            constexpr std::string_view kStart = "photographing ";
            if (stage.starts_with(kStart)) found[std::string(stage.substr(kStart.size()))] = taken;
        };
        calibrate_live(ports, live_settings(description), progress);
        return found;
    }();
    return numbers.at(role);
}

struct Mishap {
    const char* name;
    MishapKind kind;
    const char* from;  ///< the picture at which it begins; empty: at once
    bool once;         ///< that picture alone
    double size;
    std::vector<const char*> said;
};

class SpoiledSession : public ::testing::TestWithParam<Mishap> {};

TEST_P(SpoiledSession, IsToldTheCauseAndThePicture) {
    const Mishap& mishap = GetParam();
    BenchDescription description = small_bench_description();
    const int from = *mishap.from ? number_of(mishap.from) : 0;
    description.mishaps = {{mishap.kind, from, mishap.once ? from : 1'000'000, mishap.size}};
    Bench bench = testing::bench_on_kept_light(description, small_bench_product());
    const std::string said = said_of(bench.ports(), description);
    std::printf("    %s\n", said.c_str());
    for (const char* part : mishap.said)
        EXPECT_NE(said.find(part), std::string::npos) << part << "\n" << said;
    EXPECT_TRUE(said.starts_with("accepted") || said.find("not additive") == std::string::npos)
        << said;
}

const std::vector<Mishap> kMishaps = {
    {"AutomaticExposure",
     MishapKind::automatic_exposure,
     "",
     false,
     0.18,
     {"refused: automatic exposure", "by hand"}},
    {"AutomaticExposureFromTheRows",
     MishapKind::automatic_exposure,
     "gray-row-0",
     false,
     0.05,
     {"refused: ", "exposure"}},
    {"AShadowOverStripes",
     MishapKind::shadow,
     "gray-column-2",
     true,
     0.6,
     {"accepted: "}},  // both of the pair are photographed again, as when one arrives late
    {"AFaintShadowOverStripes",
     MishapKind::shadow,
     "gray-column-2",
     true,
     0.23,
     {"refused: gray-column-2:", "darker", "shadow"}},
    {"AShadowOverRed", MishapKind::shadow, "red", true, 0.6, {"refused: red:", "shadow"}},
    {"AShadowOverTheLevels",
     MishapKind::shadow,
     "gray-levels",
     true,
     0.6,
     {"refused: gray-levels", "shadow"}},
    {"RoomLightFromTheRows",
     MishapKind::room_light,
     "gray-row-2",
     false,
     0.1,
     {"refused: the room's light changed before gray-row-2"}},
    {"RoomLightFromTheColours",
     MishapKind::room_light,
     "green",
     false,
     0.1,
     {"refused: the room's light changed before green"}},
    {"CameraMovedAtTheRows",
     MishapKind::camera_moved,
     "gray-row-0",
     false,
     2.0,
     {"refused: camera, projector or mock-up moved: from gray-row-0 on"}},
    {"CameraMovedAtTheColours",
     MishapKind::camera_moved,
     "bright-gray",
     false,
     2.0,
     {"refused: camera, projector or mock-up moved: from bright-gray on"}},
    {"OverExposedFromTheColours",
     MishapKind::exposure,
     "dark-gray",
     false,
     2.2,
     {"refused: bright-gray: over-exposed", "saturated"}},
    {"OneAtSeventyPercent",
     MishapKind::exposure,
     "red",
     true,
     0.7,
     {"refused: red is 30", "another exposure"}},
    {"OneAtNinetySevenPercent",
     MishapKind::exposure,
     "bright-gray",
     true,
     0.97,
     {"accepted: bright-gray is 3.0", "another exposure", "is brought to theirs"}},
};

INSTANTIATE_TEST_SUITE_P(Mishaps,
                         SpoiledSession,
                         ::testing::ValuesIn(kMishaps),
                         [](const auto& mishap) { return std::string(mishap.param.name); });

// A slip that is accepted may take what the published targets (0.5, 1.5) leave over a clean session
// (0.3, 1.0): its picture is named, and its light brought to that of the others.
TEST(AcceptedSlips, NightlyCostLessThanTheTargetsLeave) {
    const testing::Judged& clean = testing::clean_session();
    struct Slip {
        const char* role;
        double size;
    };
    for (const Slip& slip : chosen<Slip>({{"red", 0.96},
                                          {"gray-levels", 0.90},
                                          {"bright-gray", 0.97},
                                          {"green", 1.04},
                                          {"gray-levels", 0.95},
                                          {"gray-column-4", 0.95},
                                          {"white", 0.95}},
                                         2)) {
        BenchDescription description = small_bench_description();
        const int at = number_of(slip.role);
        description.mishaps = {{MishapKind::exposure, at, at, slip.size}};
        std::printf("  %s at %.0f%%\n", slip.role, 100.0 * slip.size);
        const testing::Judged judged = testing::session_on(description);
        EXPECT_LE(judged.comparison.interior.median, clean.comparison.interior.median + 0.2);
        EXPECT_LE(judged.comparison.interior.p95, clean.comparison.interior.p95 + 0.5);
        const std::string said = testing::all_warnings(judged.live.calibration);
        EXPECT_TRUE(said.starts_with(slip.role)) << said;
        EXPECT_NE(said.find("another exposure"), std::string::npos) << said;
    }
    // 5% from the first photograph to the last
    BenchDescription description = small_bench_description();
    description.projector.drift_per_photograph = -0.05 / 54.0;
    std::printf("  a lamp that drifts by 5%%\n");
    const testing::Judged judged = testing::session_on(description);
    EXPECT_LE(judged.comparison.interior.median, clean.comparison.interior.median + 0.2);
    EXPECT_LE(judged.comparison.interior.p95, clean.comparison.interior.p95 + 0.5);
}

/// A projector that shows one picture in the place of another, as a player with a stale list does.
TEST(ExchangedPictures, AreNamedInALiveSession) {
    const BenchDescription description = small_bench_description();
    const View& projector = description.projector.view;
    std::vector<Pattern> patterns = geometry_patterns(projector.width, projector.height);
    for (Pattern& pattern : colour_patterns(projector.width, projector.height, 0, 255))
        patterns.push_back(std::move(pattern));
    const auto of = [&](const std::string& role) -> const Image8& {
        return std::find_if(patterns.begin(),
                            patterns.end(),
                            [&](const Pattern& pattern) { return pattern.role == role; })
            ->drive;
    };
    struct Case {
        const char *a, *b, *said;
    };
    for (const Case& one :
         {Case{"gray-row-3", "gray-row-4", "gray-row-3 and gray-row-4 are exchanged"},
          Case{"red", "green", "red and green are swapped"}}) {
        Bench bench = testing::bench_on_kept_light(description, small_bench_product());
        BenchPorts ports = bench.ports();
        ports.show = [&, show = ports.show](const Image8& drive) {
            if (drive.values == of(one.a).values) return show(of(one.b));
            if (drive.values == of(one.b).values) return show(of(one.a));
            show(drive);
        };
        const std::string said = said_of(ports, description);
        EXPECT_NE(said.find(one.said), std::string::npos) << said;
    }
}

}  // namespace
}  // namespace livery
