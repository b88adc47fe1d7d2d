// Pictures on the projector's monitor: which, where, when, and how often.
#include "projection/projector_screen.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <optional>

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "gl/draw.h"
#include "pointer.h"
#include "projection/outputs.h"
#include "stage.h"

namespace livery {
namespace {

using State = ProjectorScreen::State;

struct ProjectorScreenTest : ::testing::TestWithParam<bool> {
    Stage stage{GetParam()};
    std::string projector = Desktop::projector_output;
};

Image8 unlike_anywhere(int width, int height) {
    Image8 picture(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            auto* pixel = picture.pixel(x, y);
            pixel[0] = static_cast<std::uint8_t>(x % 251);
            pixel[1] = static_cast<std::uint8_t>(y % 241);
            pixel[2] = static_cast<std::uint8_t>((7 * x + 3 * y) % 256);
        }
    }
    return picture;
}

TEST_P(ProjectorScreenTest, ShowsEveryPixelOfThePictureAsItIs) {
    const auto operator_before = stage.desktop.read(stage.desktop.operator_area());
    ProjectorScreen screen(stage.share);
    EXPECT_EQ(screen.state(), State::off);
    const auto expected = unlike_anywhere(1280, 800);
    screen.present(stage.picture(7, expected));
    screen.use_monitor(projector);
    EXPECT_EQ(screen.state(), State::showing);
    EXPECT_EQ(screen.why_waiting(), "");
    EXPECT_TRUE(wait_until([&] {
        return stage.desktop.read(stage.desktop.projector_area()).values == expected.values;
    }));
    EXPECT_EQ(screen.shown().number, 7u);
    EXPECT_EQ(stage.desktop.read(stage.desktop.operator_area()).values, operator_before.values);
    screen.use_monitor(std::nullopt);
    EXPECT_EQ(screen.state(), State::off);
    EXPECT_NE(stage.on_projector(), colour_at(expected, 640, 400));
}

/// The window is made in another size. What is drawn first is all that is drawn: nothing else comes
/// that would put a wrong picture right.
TEST(ProjectorScreenOfAnotherSize, IsFilledByItsFirstFrame) {
    const Stage small(false, {640, 400});
    const auto expected = unlike_anywhere(640, 400);
    for (int times = 0; times < 10; ++times) {
        ProjectorScreen screen(small.share);
        screen.present(small.picture(7, expected));
        screen.use_monitor(Desktop::projector_output);
        EXPECT_TRUE(wait_until(
            [&] {
                return small.desktop.read(small.desktop.projector_area()).values == expected.values;
            },
            std::chrono::seconds(5)))
            << times << ": " << screen.shown().frames << " frames";
    }
}

TEST_P(ProjectorScreenTest, FollowsTheProjectorToEitherSideOfTheOperator) {
    ProjectorScreen screen(stage.share);
    screen.present(stage.plain(1, kMagenta));
    screen.use_monitor(projector);
    for (const auto side : {Desktop::Side::left, Desktop::Side::below, Desktop::Side::right}) {
        stage.desktop.plug_projector(side);
        EXPECT_TRUE(stage.projector_becomes(kMagenta)) << static_cast<int>(side);
        const Rectangle area = stage.desktop.projector_area();
        const auto picture = stage.desktop.read(area);
        EXPECT_EQ(colour_at(picture, 0, 0), kMagenta);
        EXPECT_EQ(colour_at(picture, area.width - 1, area.height - 1), kMagenta);
        const auto others = stage.desktop.read(stage.desktop.operator_area());
        EXPECT_NE(colour_at(others, 0, 0), kMagenta);
        EXPECT_NE(colour_at(others, others.width - 1, others.height - 1), kMagenta);
    }
}

TEST_P(ProjectorScreenTest, BlackComesBeforeEverythingElse) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    screen.present(stage.plain(1, kMagenta));
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    // A picture is on the screen before it is counted, and until then the number is 0, as it is
    // under the black: only a count that was waited for can be held against a later one.
    ASSERT_TRUE(wait_until([&] { return screen.shown().number == 1; }));
    screen.set_black(true);
    EXPECT_TRUE(screen.is_black());
    ASSERT_TRUE(stage.projector_becomes(kBlack));
    // Told by the thread that draws: whatever it had begun before is counted.
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 0; }));
    const auto frames = screen.shown().frames;
    screen.present(stage.plain(2, kGreen));  // under the black
    sleep_ms(100);
    EXPECT_EQ(stage.on_projector(), kBlack);
    EXPECT_EQ(screen.shown().frames, frames);
    screen.set_black(false);
    EXPECT_TRUE(stage.projector_becomes(kGreen));
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 2; }));
}

TEST_P(ProjectorScreenTest, FrozenKeepsAndThawedShowsTheNewest) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    screen.present(stage.plain(1, kMagenta));
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    screen.set_frozen(true);
    EXPECT_TRUE(screen.is_frozen());
    screen.present(stage.plain(2, kBlue));
    screen.present(stage.plain(3, kGreen));
    sleep_ms(100);
    EXPECT_EQ(stage.on_projector(), kMagenta);
    screen.set_black(true);
    EXPECT_TRUE(stage.projector_becomes(kBlack));
    screen.set_black(false);
    EXPECT_TRUE(stage.projector_becomes(kMagenta));
    screen.set_frozen(false);
    EXPECT_TRUE(stage.projector_becomes(kGreen));
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 3; }));
}

std::shared_ptr<const ProjectorPicture> fading(const std::shared_ptr<const ProjectorPicture>& whole,
                                               double fade_s) {
    auto picture = std::make_shared<ProjectorPicture>(*whole);
    picture->fade_s = fade_s;
    return picture;
}

TEST_P(ProjectorScreenTest, FadesInWhatOnlyGotBetter) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    screen.present(fading(stage.plain(1, kMagenta), 30.0));  // over nothing: at once
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    screen.present(fading(stage.plain(2, kGreen), 0.5));
    Rgb before = kMagenta;
    int between = 0;
    ASSERT_TRUE(wait_until([&] {
        const Rgb now = stage.on_projector();
        // Each channel goes one way, and no further than its end
        EXPECT_TRUE(now.r <= before.r && now.r >= kGreen.r) << now.r << " after " << before.r;
        EXPECT_TRUE(now.g >= before.g && now.g <= kGreen.g) << now.g << " after " << before.g;
        EXPECT_TRUE(now.b <= before.b && now.b >= kGreen.b) << now.b << " after " << before.b;
        if (now != before && now != kGreen) ++between;
        before = now;
        return now == kGreen;
    }));
    EXPECT_GT(between, 0);
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 2; }));
    const auto frames = screen.shown().frames;
    sleep_ms(100);
    EXPECT_EQ(screen.shown().frames, frames) << "it goes on drawing when all is there";
}

TEST_P(ProjectorScreenTest, CutsAFadeShortForWhatIsNew) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    screen.present(stage.plain(1, kMagenta));
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    screen.present(fading(stage.plain(2, kGreen), 3600.0));
    ASSERT_TRUE(wait_until([&] { return screen.shown().frames >= 5; }));
    screen.present(stage.plain(3, kBlue));
    EXPECT_TRUE(stage.projector_becomes(kBlue));
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 3; }));
    screen.present(fading(stage.plain(4, kGreen), 3600.0));
    screen.set_black(true);
    EXPECT_TRUE(stage.projector_becomes(kBlack));
    screen.set_black(false);
    screen.present(fading(stage.plain(5, kMagenta, {640, 400}), 3600.0));
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 5; })) << "sizes do not mix";
}

TEST_P(ProjectorScreenTest, DrawsNothingWhileNothingChanges) {
    std::atomic<std::uint64_t> told{0};
    ProjectorScreen screen(
        stage.share, nullptr, [&](const ShownPicture& shown) { told = shown.frames; });
    screen.use_monitor(projector);
    ASSERT_TRUE(wait_until([&] { return screen.shown().frames == 1; }));
    for (std::uint64_t i = 1; i <= 5; ++i) {
        screen.present(stage.plain(i, {static_cast<int>(i), 0, 0}));
        ASSERT_TRUE(wait_until([&] { return screen.shown().number == i; }));
        EXPECT_EQ(screen.shown().frames, i + 1);
    }
    stage.desktop.move_pointer(100, 100);
    stage.desktop.move_pointer(1800, 300);
    sleep_ms(200);
    EXPECT_EQ(screen.shown().frames, 6u);
    EXPECT_EQ(told, 6u);
}

TEST_P(ProjectorScreenTest, ComesBackAboveWindowsThatCoverIt) {
    ProjectorScreen screen(stage.share);
    screen.present(stage.plain(1, kMagenta));
    screen.use_monitor(projector);
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    WindowOptions options;
    options.title = "covers";
    options.size_px = {300, 300};
    options.visible = false;
    Window other(options);
    glfwSetWindowPos(other.native(), 1780, 300);
    glfwShowWindow(other.native());
    EXPECT_TRUE(wait_until([&] {
        glfwPollEvents();
        return stage.desktop.windows().size() >= 2;
    }));
    EXPECT_TRUE(wait_until([&] {
        return stage.desktop.windows().back().title == "Livery projector" &&
               stage.desktop.pixel(1900, 450) == kMagenta;
    }));
}

TEST_P(ProjectorScreenTest, HidesThePointerAndTakesNoFocus) {
    const XConnection x;
    const auto focus = [&] {
        const XReply<xcb_get_input_focus_reply_t> reply(
            xcb_get_input_focus_reply(x.get(), xcb_get_input_focus(x.get()), nullptr));
        return reply->focus;
    };
    ProjectorScreen screen(stage.share);
    screen.present(stage.plain(1, kMagenta));
    stage.desktop.move_pointer(1920, 400);
    EXPECT_TRUE(wait_until([&] { return visible_pointer_pixels() > 0; }));
    const auto focus_before = focus();
    screen.use_monitor(projector);
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    EXPECT_TRUE(wait_until([&] { return visible_pointer_pixels() == 0; }));
    stage.desktop.press_button();
    stage.desktop.release_button();
    sleep_ms(100);
    EXPECT_EQ(focus(), focus_before);
    stage.desktop.move_pointer(640, 400);
    EXPECT_TRUE(wait_until([&] { return visible_pointer_pixels() > 0; }));
}

TEST_P(ProjectorScreenTest, OtherSizesFillOrStandInTheMiddle) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    screen.present(stage.plain(1, kMagenta, {640, 400}));  // same shape: fills
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    EXPECT_EQ(stage.desktop.pixel(1280, 0), kMagenta);
    EXPECT_EQ(stage.desktop.pixel(2559, 799), kMagenta);
    screen.present(stage.plain(2, kGreen, {400, 400}));  // pixel for pixel
    ASSERT_TRUE(stage.projector_becomes(kGreen));
    EXPECT_EQ(stage.desktop.pixel(1280 + 440, 200), kGreen);
    EXPECT_EQ(stage.desktop.pixel(1280 + 439, 200), kBlack);
    EXPECT_EQ(stage.desktop.pixel(1280 + 839, 599), kGreen);
    EXPECT_EQ(stage.desktop.pixel(1280 + 840, 599), kBlack);
    screen.present(stage.plain(3, kBlue, {1600, 1600}));  // as large as fits
    ASSERT_TRUE(stage.projector_becomes(kBlue));
    EXPECT_EQ(stage.desktop.pixel(1280 + 240, 0), kBlue);
    EXPECT_EQ(stage.desktop.pixel(1280 + 239, 0), kBlack);
    EXPECT_EQ(stage.desktop.pixel(1280 + 1039, 799), kBlue);
    EXPECT_EQ(stage.desktop.pixel(1280 + 1040, 799), kBlack);
}

TEST_P(ProjectorScreenTest, LetsPicturesGoWhileHidden) {
    ProjectorScreen screen(stage.share);
    std::weak_ptr<const void> first;
    {
        const auto picture = stage.plain(1, kMagenta);
        first = picture->owner;
        screen.present(picture);
    }
    screen.present(stage.plain(2, kGreen));
    EXPECT_TRUE(wait_until([&] { return first.expired(); }));
    EXPECT_EQ(screen.shown().frames, 0u);
}

/// What a graphics card is busy with for a while.
ShaderSource long_work() {
    return {"long work", R"(#version 450 core
uniform int turns;
out vec4 colour;
void main() {
    float sum = gl_FragCoord.x;
    for (int i = 0; i < turns; ++i) sum = fract(sin(sum) * 43758.5453 + float(i));
    colour = vec4(0.0, sum < 2.0 ? 1.0 : 0.0, 0.0, 1.0);
}
)"};
}

TEST_P(ProjectorScreenTest, BlackDoesNotWaitForAPictureThatIsNotFinished) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    screen.present(stage.plain(1, kMagenta));
    ASSERT_TRUE(stage.projector_becomes(kMagenta));

    auto program = Program::screen_pass(long_work());
    program.use();
    program.set("turns", 200);
    auto texture = std::make_shared<Texture2D>(1280, 800, TexelFormat::rgba8);
    const Framebuffer framebuffer({texture.get()});
    ScreenPass().run(program, framebuffer);
    const auto ready = std::make_shared<Fence>(Fence::after_everything_so_far());
    auto picture = std::make_shared<ProjectorPicture>();
    picture->number = 2;
    picture->texture = texture->name();
    picture->size_px = {1280, 800};
    picture->ready = ready;
    picture->owner = texture;
    screen.present(picture);
    screen.set_black(true);
    EXPECT_TRUE(stage.projector_becomes(kBlack));
    EXPECT_FALSE(ready->is_reached()) << "too quick a machine for this test's work";
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 0; }));
    screen.set_black(false);
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 2; }));
    EXPECT_TRUE(ready->is_reached());
    EXPECT_TRUE(stage.projector_becomes({0, 255, 0}));
}

TEST_P(ProjectorScreenTest, NoPictureIsBlack) {
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    screen.present(stage.plain(1, kMagenta));
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    screen.present(nullptr);
    EXPECT_TRUE(stage.projector_becomes(kBlack));
    EXPECT_TRUE(wait_until([&] { return screen.shown().number == 0; }));
}

/// No time can be asserted of a machine with other work; this prints them.
TEST_P(ProjectorScreenTest, TellsHowSoonItShowsAndIsBlack) {
    constexpr int kRounds = 21;
    using Clock = std::chrono::steady_clock;
    ProjectorScreen screen(stage.share);
    screen.use_monitor(projector);
    std::vector<std::shared_ptr<const ProjectorPicture>> pictures;
    for (std::uint64_t i = 1; i <= 2; ++i) pictures.push_back(stage.plain(i, kMagenta));
    std::vector<double> shown_ms, black_ms;
    const auto since = [&](Clock::time_point start, std::uint64_t number) {
        EXPECT_TRUE(wait_until([&] { return screen.shown().number == number; }));
        return std::chrono::duration<double, std::milli>(screen.shown().at - start).count();
    };
    for (int round = 0; round < kRounds; ++round) {
        const auto& picture = pictures[static_cast<std::size_t>(round % 2)];
        auto start = Clock::now();
        screen.present(picture);
        shown_ms.push_back(since(start, picture->number));
        start = Clock::now();
        screen.set_black(true);
        black_ms.push_back(since(start, 0));
        screen.set_black(false);
        since(start, picture->number);
    }
    std::sort(shown_ms.begin(), shown_ms.end());
    std::sort(black_ms.begin(), black_ms.end());
    std::printf("a picture of 1280x800 shown after %.2f ms, black after %.2f ms (medians of %d)\n",
                shown_ms[kRounds / 2],
                black_ms[kRounds / 2],
                kRounds);
}

INSTANTIATE_TEST_SUITE_P(Desktops,
                         ProjectorScreenTest,
                         ::testing::Bool(),
                         [](const auto& parameter) {
                             return parameter.param ? "openbox" : "bare";
                         });

}  // namespace
}  // namespace livery
