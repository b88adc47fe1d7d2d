// Frozen frames on the disk, and what is drawn beside them.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "core/random.h"
#include "studio/presenting/round_files.h"
#include "studio/presenting/surround.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

std::shared_ptr<const Image8> noise(std::uint64_t seed) {
    Random random(seed);
    auto picture = std::make_shared<Image8>(37, 21, 3);
    for (std::uint8_t& value : picture->values)
        value = static_cast<std::uint8_t>(random.below(256));
    return picture;
}

std::map<std::string, std::string> hashes_of(const VoteFrames& frames) {
    std::map<std::string, std::string> hashes;
    for (const auto& [name, frame] : frames) hashes[name] = hash_of(*frame);
    return hashes;
}

TEST(VoteFrames, ComeBackAsTheyWereFrozen) {
    const TemporaryFolder folder;
    const VoteFrames frames = {{"look-0", noise(1)}, {"look-1", noise(2)}, {"white", noise(3)}};
    write_vote_frames(folder / "frames" / "one", frames);
    const VoteFrames read = read_vote_frames(folder / "frames" / "one", hashes_of(frames));
    ASSERT_EQ(read.size(), frames.size());
    for (const auto& [name, frame] : frames) EXPECT_EQ(read.at(name)->values, frame->values);
}

TEST(VoteFrames, ThatWereChangedOrAreGoneAreRefused) {
    const TemporaryFolder folder;
    const VoteFrames frames = {{"look-0", noise(1)}, {"white", noise(3)}};
    const auto hashes = hashes_of(frames);
    write_vote_frames(folder / "one", frames);
    Image8 other = *frames.at("look-0");
    other.values[100] ^= 1u;
    write_png(folder / "one" / "look-0.png", other);
    const auto read = [&] { read_vote_frames(folder / "one", hashes); };
    EXPECT_TRUE(fails_with(read, {"look-0.png", "another picture", hashes.at("look-0")}));
    write_png(folder / "one" / "look-0.png", Image8(37, 21, 1));
    EXPECT_TRUE(fails_with(read, {"look-0.png", "another kind"}));
    std::filesystem::remove(folder / "one" / "look-0.png");
    EXPECT_TRUE(fails_with(read, {"look-0.png"}));
}

TEST(VoteFrames, HashesTellSizesApart) {
    EXPECT_NE(hash_of(Image8(4, 2, 3)), hash_of(Image8(2, 4, 3)));
}

/// A picture that is dark but for one rectangle.
Image8 lit_in(int width, int height, const PixelRectangle& area) {
    Image8 picture(width, height, 3);
    for (int y = area.top; y < area.bottom; ++y) {
        std::fill(picture.pixel(area.left, y), picture.pixel(area.right - 1, y) + 3, 200);
    }
    return picture;
}

TEST(Surround, NeverTouchesWhatAFrameLightsAndHasNoColour) {
    constexpr std::uint64_t seed = 5;
    std::cout << "seed " << seed << std::endl;
    Random random(seed);
    int placed = 0;
    for (int run = 0; run < 60; ++run) {
        const int width = 400 + static_cast<int>(random.below(900));
        const int height = 300 + static_cast<int>(random.below(600));
        const int left = static_cast<int>(random.below(static_cast<unsigned>(width / 2)));
        const int top = static_cast<int>(random.below(static_cast<unsigned>(height / 2)));
        const Image8 frame = lit_in(width, height, {left, top, left + width / 2, top + height / 2});
        Image8 lit;
        add_lit_pixels(frame, lit);
        const auto place = free_place(lit, kNumberPlaceAspect);
        if (!place) continue;
        ++placed;
        Image8 shown = frame;
        draw_surround(shown, *place, 417, 0.6);
        std::size_t changed = 0;
        for (std::size_t i = 0; i < frame.pixel_count(); ++i) {
            const std::uint8_t* now = &shown.values[3 * i];
            if (lit.values[i] != 0) {
                ASSERT_TRUE(std::equal(now, now + 3, &frame.values[3 * i]));
            } else {
                ASSERT_TRUE(now[0] == now[1] && now[1] == now[2]);
                changed += now[0] != 0 ? 1 : 0;
            }
        }
        EXPECT_GT(changed, 100u) << "it can be read";
    }
    EXPECT_GT(placed, 30);
    EXPECT_FALSE(free_place(Image8(640, 400, 1, 255), kNumberPlaceAspect)) << "there is no room";
    EXPECT_TRUE(free_place(Image8(640, 400, 1), kNumberPlaceAspect));
}

TEST(Surround, TheBarIsAsLongAsTheTimeThatIsLeft) {
    const PixelRectangle place{10, 10, 110, 60};
    std::size_t before = 0;
    for (const double fraction : {0.0, 0.25, 0.5, 1.0}) {
        Image8 picture(200, 100, 3);
        draw_surround(picture, place, {}, fraction);
        const auto grey = static_cast<std::size_t>(std::count_if(
            picture.values.begin(), picture.values.end(), [](auto value) { return value > 0; }));
        EXPECT_EQ(grey, static_cast<std::size_t>(fraction * 100) * 4 * 3) << fraction;
        EXPECT_TRUE(fraction == 0.0 || grey > before);
        before = grey;
    }
}

TEST(Surround, AQrCodeKeepsItsModulesAndItsQuietZone) {
    const QrCode code = qr_code("http://192.168.0.7:8470/join/abcdef");
    Image8 picture(400, 400, 3);
    const int modules = code.size + 2 * kQrQuietZone, scale = 300 / modules;
    draw_qr_code(picture, {50, 60, 350, 360}, code);
    for (int y = 0; y < modules; ++y) {
        for (int x = 0; x < modules; ++x) {
            const bool dark = code.at(x - kQrQuietZone, y - kQrQuietZone);
            EXPECT_EQ(picture.at(50 + x * scale + scale / 2, 60 + y * scale + scale / 2),
                      dark ? 0 : 255);
        }
    }
    EXPECT_THROW(draw_qr_code(picture, {0, 0, 20, 20}, code), std::invalid_argument);
}

}  // namespace
}  // namespace livery
