#include "jobs/watched_captures.h"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "calibration/correspondence/patterns.h"
#include "core/colour.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "session/small_session.h"
#include "support/dng.h"
#include "support/exif.h"
#include "support/jpeg.h"
#include "support/kept_light.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::live_settings;
using testing::small_bench_description;
using testing::small_bench_product;

/// What somebody shot of the small bench: files as a camera names them, in the order of the roles.
struct Card {
    TemporaryFolder folder;
    std::vector<std::string> roles;

    Card() {
        const BenchDescription description = small_bench_description();
        Bench bench = testing::bench_on_kept_light(description, small_bench_product());
        const BenchPorts ports = bench.ports();
        const View& view = description.projector.view;
        std::vector<Pattern> patterns = geometry_patterns(view.width, view.height);
        for (Pattern& pattern : colour_patterns(view.width, view.height, 0, 255))
            patterns.push_back(std::move(pattern));
        for (const Pattern& pattern : patterns) {
            ports.show(pattern.drive);
            const Photograph photograph = ports.photograph(bench.default_exposure_s());
            Image16 picture(photograph.image.width, photograph.image.height, 3);
            for (std::size_t k = 0; k < picture.values.size(); ++k)
                picture.values[k] = static_cast<std::uint16_t>(
                    std::max(0.0f, 4.0f * (photograph.image.values[k] - 1024.0f)));
            write_png(file(roles.size()), picture);
            roles.push_back(pattern.role);
        }
    }
    std::string name(std::size_t k) const { return fmt::format("DSC_{:04}.png", 95 + k); }
    std::filesystem::path file(std::size_t k) const { return folder.path() / name(k); }
    /// As a camera that tells how it was exposed writes it, into another folder.
    void put_told(std::size_t k,
                  const ExposureSettings& settings,
                  const std::filesystem::path& into) const {
        const ImageF read = read_image(file(k)).image;
        Image16 picture(read.width, read.height, 3);
        for (std::size_t v = 0; v < picture.values.size(); ++v)
            picture.values[v] = static_cast<std::uint16_t>(read.values[v]);
        write_text_file(into, testing::tiff_of(picture, settings));
    }
};
const Card& card() {
    static const Card shot;
    return shot;
}

std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t seed) {
    std::vector<std::size_t> order(count);
    for (std::size_t k = 0; k < count; ++k) order[k] = k;
    Random random(seed);
    for (std::size_t k = count - 1; k > 0; --k)
        std::swap(order[k],
                  order[static_cast<std::size_t>(random.uniform() * static_cast<double>(k + 1))]);
    return order;
}

/// Looks until a look changes nothing.
void look_at_all(WatchedCaptures& watched) {
    watched.look();
    watched.look();
}

TEST(WatchedCaptures, NamesTheMissingAndTheDoubledOfAnyOrder) {
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    const auto order = shuffled(card().roles.size(), 11);
    const std::size_t gone = order[7], twice = order[20];
    for (const std::size_t k : order) {
        if (k == gone) continue;
        std::filesystem::copy_file(card().file(k), here.path() / card().name(k));
        watched.look();
    }
    std::filesystem::copy_file(card().file(twice), here.path() / "DSC_0200.png");
    look_at_all(watched);
    EXPECT_FALSE(watched.state().complete);
    EXPECT_EQ(watched.state().missing, std::vector<std::string>{card().roles[gone]});
    ASSERT_EQ(watched.state().odd.size(), 1u);
    EXPECT_EQ(text_of(watched.state()),
              fmt::format("{} of {} photographs; missing: {}; DSC_0200.png is the same file as {}",
                          card().roles.size() - 1,
                          card().roles.size(),
                          card().roles[gone],
                          card().name(twice)));
    std::filesystem::copy_file(card().file(gone), here.path() / card().name(gone));
    look_at_all(watched);
    EXPECT_TRUE(watched.state().complete);
    EXPECT_EQ(watched.captures(320, 200).captures[gone].file.filename(), card().name(gone));
}

/// The pictures by their roles alone.
std::vector<Pattern> pictures() {
    std::vector<Pattern> patterns;
    for (const std::string& role : card().roles) patterns.push_back({role, {}, {}});
    return patterns;
}

TEST(WatchedCaptures, AsksOnlyForWhatIsNotThereAtTheStart) {
    const TemporaryFolder here;
    for (std::size_t k = 0; k < card().roles.size(); ++k)
        if (k != 2 && k != 11)
            std::filesystem::copy_file(card().file(k), here.path() / card().name(k));
    WatchedCaptures watched(here.path(), card().roles);
    const auto before = watched.look_at_what_is_there(pictures());
    // Each with its inverse, or with what it is the inverse of
    ASSERT_EQ(before.still_to_shoot.size(), 4u);
    for (const std::size_t k : {2u, 3u, 10u, 11u})
        EXPECT_TRUE(std::any_of(before.still_to_shoot.begin(),
                                before.still_to_shoot.end(),
                                [&](const Pattern& p) { return p.role == card().roles[k]; }));
    EXPECT_EQ(before.words,
              fmt::format("{} of the {} photographs were there before and are used",
                          card().roles.size() - 2,
                          card().roles.size()));
    // They come last, and are known by what they show
    std::filesystem::copy_file(card().file(2), here.path() / "DSC_0301.png");
    std::filesystem::copy_file(card().file(11), here.path() / "DSC_0302.png");
    look_at_all(watched);
    EXPECT_TRUE(watched.state().complete) << text_of(watched.state());
    EXPECT_NE(
        text_of(watched.state()).find("DSC_0301.png is out of order and shows " + card().roles[2]),
        std::string::npos)
        << text_of(watched.state());
}

TEST(WatchedCaptures, PassesOverAFewFilesOfBefore) {
    const TemporaryFolder here;
    for (std::size_t k = 0; k < 5; ++k)
        std::filesystem::copy_file(card().file(k), here.path() / fmt::format("OLD_{:04}.png", k));
    WatchedCaptures watched(here.path(), card().roles);
    const auto before = watched.look_at_what_is_there(pictures());
    EXPECT_EQ(before.still_to_shoot.size(), card().roles.size());
    EXPECT_EQ(before.words, "5 files were there before and are passed over");
    for (std::size_t k = 0; k < card().roles.size(); ++k)
        std::filesystem::copy_file(card().file(k), here.path() / card().name(k));
    look_at_all(watched);
    EXPECT_TRUE(watched.state().complete) << text_of(watched.state());
    EXPECT_EQ(watched.captures(320, 200).captures[0].file.filename(), card().name(0));
    EXPECT_EQ(watched.state().odd.size(), 5u);
    EXPECT_EQ(watched.state().odd[0].why, "was there before");
    const TemporaryFolder empty;
    WatchedCaptures fresh(empty.path(), card().roles);
    EXPECT_EQ(fresh.look_at_what_is_there(pictures()).words, "");
}

TEST(WatchedCaptures, SaysWhatCannotBeUsed) {
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    for (std::size_t k = 0; k < card().roles.size(); ++k)
        std::filesystem::copy_file(card().file(k), here.path() / card().name(k));
    look_at_all(watched);
    ASSERT_TRUE(watched.state().complete);
    here.write("DSC_0300.png", "half a photograph");
    write_png(here / "DSC_0301.png", Image8(40, 30, 3, 9));
    here.write("notes.txt", "no picture");
    look_at_all(watched);
    EXPECT_TRUE(watched.state().complete);
    ASSERT_EQ(watched.state().odd.size(), 2u);
    EXPECT_EQ(watched.state().odd[0].file, "DSC_0300.png");
    EXPECT_NE(watched.state().odd[0].why.find("cannot be read"), std::string::npos);
    EXPECT_EQ(watched.state().odd[1].why, "has 40x30 pixels, the others 432x288");
    // Put right
    std::filesystem::remove(here / "DSC_0300.png");
    std::filesystem::remove(here / "DSC_0301.png");
    EXPECT_TRUE(watched.look());
    EXPECT_TRUE(watched.state().odd.empty());
    std::filesystem::remove(here.path() / card().name(3));
    EXPECT_TRUE(watched.look());
    EXPECT_EQ(watched.state().missing, std::vector<std::string>{card().roles[3]});
}

/// An automatic that was left on for some of the pictures
TEST(WatchedCaptures, NamesWhatWasExposedOtherwise) {
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    const ExposureSettings usual{1.0 / 125.0, 8.0, 100.0}, longer{1.0 / 50.0, 8.0, 100.0},
        darker{1.0 / 125.0, 16.0, 100.0};
    const auto name = [](std::size_t k) { return fmt::format("DSC_{:04}.tif", 95 + k); };
    for (std::size_t k = 0; k < card().roles.size(); ++k)
        card().put_told(k, k == 5 ? longer : k == 30 ? darker : usual, here.path() / name(k));
    look_at_all(watched);
    EXPECT_FALSE(watched.state().complete);
    EXPECT_EQ(watched.state().missing, (std::vector{card().roles[5], card().roles[30]}));
    EXPECT_TRUE(watched.state().odd.empty());
    EXPECT_EQ(
        text_of(watched.state()),
        fmt::format("{} of {} photographs; missing: {}, {}; 2 were exposed otherwise than the "
                    "others (1/125 s, f/8): {} +1.3 stops, {} -2.0 stops; the "
                    "camera's automatic was on: turn its dial to M, with automatic ISO off, "
                    "and photograph these pictures again",
                    card().roles.size() - 2,
                    card().roles.size(),
                    card().roles[5],
                    card().roles[30],
                    name(5),
                    name(30)));
    // One again in the place of the old, one besides it
    card().put_told(5, usual, here.path() / name(5));
    card().put_told(30, usual, here / "DSC_0125a.tif");
    look_at_all(watched);
    EXPECT_TRUE(watched.state().complete) << text_of(watched.state());
    EXPECT_NE(text_of(watched.state()).find("and these are not used"), std::string::npos);
    const CapturesFolder captures = watched.captures(320, 200);
    EXPECT_EQ(captures.captures[30].file.filename(), "DSC_0125a.tif");
    for (const Capture& capture : captures.captures)
        EXPECT_NEAR(capture.exposure_s, 1.0 / 125.0, 1e-9);
}

TEST(WatchedCaptures, TakesNoPicturesOfAnAutomaticTogether) {
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    const auto jpeg = [](const ImageF& read, std::size_t serial, double time_s) {
        Image8 picture(read.width, read.height, 3);
        for (std::size_t v = 0; v < picture.values.size(); ++v)
            picture.values[v] = static_cast<std::uint8_t>(read.values[v] / 257.0f);
        // No two photographs are alike to the last bit.
        picture.values[0] = static_cast<std::uint8_t>(6 * serial);
        return testing::with_exif(testing::jpeg_of(picture), {time_s, 5.6, 400.0});
    };
    std::vector<ImageF> pictures;
    for (std::size_t k = 0; k < card().roles.size(); ++k) {
        pictures.push_back(read_image(card().file(k)).image);
        here.write(fmt::format("IMG_{:04}.JPG", k),
                   jpeg(pictures[k], k, 0.01 * (1.0 + 0.1 * static_cast<double>(k % 20))));
    }
    look_at_all(watched);
    EXPECT_FALSE(watched.state().complete);
    EXPECT_GE(watched.state().exposed_otherwise.size(), card().roles.size() - 3);
    EXPECT_NE(text_of(watched.state()).find(" and 27 more;"), std::string::npos)
        << text_of(watched.state());
    // All of them on manual, copied to the others
    for (std::size_t k = 0; k < card().roles.size(); ++k)
        here.write(fmt::format("IMG_{:04}.JPG", 300 + k), jpeg(pictures[k], k, 0.0125));
    look_at_all(watched);
    EXPECT_TRUE(watched.state().complete) << text_of(watched.state());
    EXPECT_NEAR(watched.captures(320, 200).captures[0].exposure_s, 0.0125, 1e-9);
}

/// A pixel for each square of the sensor's colour filter, as of a camera on a cable.
TEST(WatchedCaptures, ReadsRawAsTheSensorLies) {
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    const ExposureSettings said{1.0 / 8.0, 5.6, 100.0};
    for (std::size_t k = 0; k < card().roles.size(); ++k) {
        const ImageF seen = read_image(card().file(k)).image;
        const auto sample = [&](int x, int y) {
            const auto value = [&](int c) {
                return static_cast<std::uint16_t>(seen.at(x / 2, y / 2, c));
            };
            return testing::bayer(x, y, value(0), value(1), value(2));
        };
        here.write(fmt::format("DSC_{:04}.DNG", k),
                   testing::dng_of(2 * seen.width, 2 * seen.height, 0, sample, said));
    }
    look_at_all(watched);
    ASSERT_TRUE(watched.state().complete) << text_of(watched.state());
    const CapturesFolder captures = watched.captures(320, 200);
    const Photograph white = load_photograph(captures.captures[card().roles.size() / 2]);
    EXPECT_EQ(white.image.width, 432);
    EXPECT_EQ(white.image.height, 288);
    EXPECT_NEAR(white.exposure_s, said.time_s, 1e-9);
}

/// Numbers of a JPEG are no light: they are taken for sRGB, as those of a camera on a cable.
TEST(WatchedCaptures, ReadsJpegAsSrgb) {
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    for (std::size_t k = 0; k < card().roles.size(); ++k) {
        const ImageF seen = read_image(card().file(k)).image;
        Image8 rgb(seen.width, seen.height, 3);
        for (std::size_t i = 0; i < rgb.values.size(); ++i)
            rgb.values[i] = static_cast<std::uint8_t>(
                255.0 * srgb_encode(static_cast<double>(seen.values[i]) / 65535.0) + 0.5);
        here.write(fmt::format("DSC_{:04}.JPG", k), testing::jpeg_of(rgb));
    }
    look_at_all(watched);
    ASSERT_TRUE(watched.state().complete) << text_of(watched.state());
    const CapturesFolder captures = watched.captures(320, 200);
    const std::size_t white = card().roles.size() / 2;
    const Photograph read = load_photograph(captures.captures[white]);
    const ImageF meant = read_image(card().file(white)).image;
    double off = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < meant.values.size(); ++i) {
        off += std::abs(static_cast<double>(read.image.values[i]) / 255.0 -
                        static_cast<double>(meant.values[i]) / 65535.0);
        sum += static_cast<double>(meant.values[i]) / 65535.0;
    }
    // Eight bits and the compression; the numbers themselves would be far off.
    EXPECT_LT(off / sum, 0.03);
}

/// Files that do not say how they were exposed count as exposed alike, for a second.
TEST(WatchedCaptures, BelievesThatSilentFilesAreExposedAlike) {
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    for (std::size_t k = 0; k < card().roles.size(); ++k)
        card().put_told(k,
                        k == 9 ? ExposureSettings{} : ExposureSettings{0.02, 8.0, 100.0},
                        here.path() / fmt::format("DSC_{:04}.tif", k));
    look_at_all(watched);
    ASSERT_TRUE(watched.state().complete) << text_of(watched.state());
    EXPECT_EQ(watched.captures(320, 200).captures[0].exposure_s, 1.0);
}

/// As the window and the terminal watch; how long the word takes is printed.
TEST(WatchedCaptures, SaysWhatIsMissingSoonAfterTheLastFile) {
    using Clock = std::chrono::steady_clock;
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    constexpr std::uint64_t seed = 23;
    const auto order = shuffled(card().roles.size(), seed);
    const std::size_t gone = order[3], twice = order[40];
    std::mutex mutex;
    std::condition_variable told;
    std::vector<std::pair<Clock::time_point, WatchedState>> states;
    std::atomic<bool> stop{false};
    Progress progress;
    progress.stop = &stop;
    std::thread watching([&] {
        const BenchPorts ports = watched.ports(progress, [&](const WatchedState& state) {
            const std::lock_guard lock(mutex);
            states.emplace_back(Clock::now(), state);
            told.notify_one();
        });
        try {
            EXPECT_EQ(ports.turn_to(card().roles[gone]), 1);
        } catch (const Cancelled&) {
            ADD_FAILURE() << "stopped: " << text_of(watched.state());
        }
    });
    const auto copy = [&](std::size_t k, const std::string& name) {
        std::filesystem::copy_file(card().file(k), here.path() / name);
    };
    for (const std::size_t k : order)
        if (k != gone) copy(k, card().name(k));
    copy(twice, "DSC_0900.png");
    const auto last = Clock::now();
    const auto named = [&](const WatchedState& state) {
        return state.missing == std::vector{card().roles[gone]} && state.odd.size() == 1 &&
               state.odd.front().file == "DSC_0900.png";
    };
    {
        std::unique_lock lock(mutex);
        const bool said = told.wait_for(lock, std::chrono::minutes(1), [&] {
            return !states.empty() && named(states.back().second);
        });
        if (!said) stop = true;
        if (said)
            std::printf("seed %d: missing and doubled of %zu files named %.2f s after the last\n",
                        static_cast<int>(seed),
                        card().roles.size(),
                        std::chrono::duration<double>(states.back().first - last).count());
    }
    copy(gone, card().name(gone));
    watching.join();
    EXPECT_TRUE(watched.state().complete);
}

TEST(WatchedCaptures, CalibratesWhenTheLastHasCome) {
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    std::thread person([&] {
        for (const std::size_t k : shuffled(card().roles.size(), 3))
            std::filesystem::copy_file(card().file(k), here.path() / card().name(k));
    });
    CalibrationSettings options = live_settings(small_bench_description());
    options.patterns = colour_patterns(options.width, options.height, 0, 255);
    std::vector<WatchedState> states;
    const CalibrationResult result = calibrate_live(
        watched.ports({}, [&](const WatchedState& state) { states.push_back(state); }), options);
    person.join();
    ASSERT_FALSE(states.empty());
    EXPECT_TRUE(states.back().complete);
    // The files' noise is cut off at black.
    EXPECT_GT(result.calibration.valid_fraction, 0.9);

    std::atomic<bool> stop{true};
    Progress stopped;
    stopped.stop = &stop;
    const TemporaryFolder empty;
    WatchedCaptures nothing(empty.path(), card().roles);
    EXPECT_THROW(
        calibrate_live(nothing.ports(stopped, [](const WatchedState&) {}), options, stopped),
        Cancelled);
}

}  // namespace
}  // namespace livery
