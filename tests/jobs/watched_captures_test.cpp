#include "jobs/watched_captures.h"

#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "calibration/correspondence/patterns.h"
#include "core/image_io.h"
#include "session/small_session.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::live_options;
using testing::small_bench_description;
using testing::small_bench_product;

/// What somebody shot of the small bench: files as a camera names them, in the order of the roles.
struct Card {
    TemporaryFolder folder;
    std::vector<std::string> roles;

    Card() {
        const BenchDescription description = small_bench_description();
        Bench bench(description, small_bench_product());
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

TEST(WatchedCaptures, CalibratesWhenTheLastHasCome) {
    const TemporaryFolder here;
    WatchedCaptures watched(here.path(), card().roles);
    std::thread person([&] {
        for (const std::size_t k : shuffled(card().roles.size(), 3))
            std::filesystem::copy_file(card().file(k), here.path() / card().name(k));
    });
    LiveOptions options = live_options(small_bench_description());
    options.patterns = colour_patterns(options.width, options.height, 0, 255);
    std::vector<WatchedState> states;
    const LiveResult result = calibrate_live(
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
