// Large numbers on monitors.
#include <stdexcept>

#include <gtest/gtest.h>

#include "projection/numerals.h"
#include "stage.h"

namespace livery {
namespace {

/// Fraction of the picture that is ink.
double ink(int number, double height_px) {
    Image8 picture(600, 400, 3);
    draw_number(picture, number, {300.0, 200.0}, height_px, {255, 255, 255});
    double sum = 0.0;
    for (const auto value : picture.values) sum += value / 255.0;
    return sum / static_cast<double>(picture.values.size());
}

TEST(Numerals, DifferFromOneAnother) {
    std::vector<Image8> pictures;
    for (int number = 0; number < 10; ++number) {
        Image8 picture(70, 110, 3);
        draw_number(picture, number, {35.0, 55.0}, 100.0, {255, 255, 255});
        for (const auto& other : pictures) {
            EXPECT_GT(fraction_different(picture, other, 128), 0.05) << number;
        }
        pictures.push_back(picture);
    }
}

TEST(Numerals, ScaleAndStayInside) {
    EXPECT_NEAR(ink(8, 300.0) / ink(8, 150.0), 4.0, 0.05);
    EXPECT_GT(ink(88, 300.0), 1.9 * ink(8, 300.0));
    Image8 picture(100, 100, 3);
    draw_number(picture, 4, {0.0, 100.0}, 300.0, {1, 2, 3});  // cut off by the edges
    EXPECT_THROW(draw_number(picture, -1, {50.0, 50.0}, 20.0, {}), std::invalid_argument);
}

struct MonitorNumbersTest : ::testing::TestWithParam<bool> {
    Stage stage{GetParam()};

    bool is_tile(const Rectangle& monitor) const {
        const auto picture = stage.desktop.read(monitor);
        const int x = monitor.width / 2, y = monitor.height / 2;
        int white = 0;
        for (int dy = -150; dy < 150; ++dy) {
            for (int dx = -100; dx < 100; ++dx) {
                white += colour_at(picture, x + dx, y + dy) == Rgb{255, 255, 255};
            }
        }
        return white > 5000 && colour_at(picture, x - 200, y) == Rgb{24, 26, 30};
    }
};

TEST_P(MonitorNumbersTest, AreOnEveryMonitorForAsLongAsTheyLive) {
    const auto before = stage.desktop.read({0, 0, 2560, 800});
    {
        const MonitorNumbers numbers(list_monitors());
        EXPECT_TRUE(is_tile(stage.desktop.operator_area()));
        EXPECT_TRUE(is_tile(stage.desktop.projector_area()));
        // Round corners show what is behind.
        EXPECT_EQ(stage.desktop.pixel(640 - 255, 400 - 255), colour_at(before, 385, 145));
        EXPECT_NE(stage.desktop.pixel(640 - 255, 400), colour_at(before, 385, 400));
    }
    EXPECT_TRUE(wait_until([&] {
        return stage.desktop.read({0, 0, 2560, 800}).values == before.values;
    }));
}

TEST_P(MonitorNumbersTest, LieAboveTheProjectorsPictureAndLeaveItWhole) {
    ProjectorScreen screen(stage.share);
    screen.present(stage.plain(1, kMagenta));
    screen.use_monitor(Desktop::projector_output);
    ASSERT_TRUE(stage.projector_becomes(kMagenta));
    {
        const MonitorNumbers numbers(list_monitors());
        sleep_ms(100);
        EXPECT_TRUE(is_tile(stage.desktop.projector_area()));
        EXPECT_EQ(stage.desktop.pixel(1300, 20), kMagenta);
        screen.present(stage.plain(2, kGreen));
        EXPECT_TRUE(wait_until([&] { return stage.desktop.pixel(1300, 20) == kGreen; }));
        EXPECT_TRUE(is_tile(stage.desktop.projector_area()));
    }
    EXPECT_TRUE(stage.projector_becomes(kGreen));
}

INSTANTIATE_TEST_SUITE_P(Desktops,
                         MonitorNumbersTest,
                         ::testing::Bool(),
                         [](const auto& parameter) {
                             return parameter.param ? "openbox" : "bare";
                         });

}  // namespace
}  // namespace livery
