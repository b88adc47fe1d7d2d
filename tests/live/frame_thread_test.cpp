#include "live/frame_thread.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <deque>
#include <functional>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"
#include "gl/read_back.h"
#include "jobs/comparison.h"
#include "live/frame_lane.h"
#include "live/frame_thread_fixture.h"
#include "support/shading_devices.h"
#include "support/thorough.h"

namespace livery {
namespace {

LIVERY_ON_DEVICES(FrameThreadOnADevice, ShadingDevice::gl, ShadingDevice::processor);

TEST_P(FrameThreadOnADevice, FramesAreRenderFramesOwn) {
    start();
    const auto first = gallery_.whole(show());
    ASSERT_TRUE(first);
    EXPECT_EQ(first->problem, "");
    EXPECT_EQ(drive(*first).values, from_scratch(description_.scene).drive.values);
    const Image8 bright = drive(*first);
    EXPECT_GT(*std::max_element(bright.values.begin(), bright.values.end()), 50);

    paint(description_.scene, 0, ReflectanceModel::ggx, {0.1, 0.2, 0.7});
    const auto second = gallery_.whole(show());
    ASSERT_TRUE(second);
    const RenderedFrame truth = from_scratch(description_.scene);
    EXPECT_EQ(drive(*second).values, truth.drive.values);
    EXPECT_EQ(radiance(*second).values, truth.radiance_working.values);
    EXPECT_EQ(second->compensation.out_of_gamut_fraction, truth.compensation.out_of_gamut_fraction);
    EXPECT_NE(drive(*second).values, drive(*first).values);
}

TEST_P(FrameThreadOnADevice, TheTextureIsTheDriveInTheShareGroup) {
    start();
    const auto frame = gallery_.whole(show());
    ASSERT_TRUE(frame);
    const View& view = description_.setup->view;
    const Image8 fetched = drive(*frame);
    const ImageF texels = in_window([&] {
        frame->ready->wait_on_device();
        return read_floats(frame->drive_texture, view.width, view.height, 4);
    });
    for (std::size_t i = 0; i < texels.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_EQ(std::lround(255.0f * texels.values[4 * i + c]), fetched.values[3 * i + c])
                << i;
        }
        ASSERT_EQ(texels.values[4 * i + 3], 1.0f);
    }
}

TEST_P(FrameThreadOnADevice, UncorrectedIsSrgb) {
    auto setup = std::make_shared<ProjectorSetup>();
    setup->view = description_.setup->view;
    setup->why_uncorrected = "no calibration";
    description_.setup = setup;
    start();
    const auto frame = gallery_.whole(show());
    ASSERT_TRUE(frame);
    const Image8 sent = drive(*frame);
    const Image8 wanted = srgb_from_working(from_scratch(description_.scene).radiance_working);
    if (GetParam() != ShadingDevice::gl) {
        EXPECT_EQ(sent.values, wanted.values);
    }
    // The shader has the curve in floats: where doubles lie next to the middle between two levels
    // it may take the other.
    std::size_t changed = 0;
    for (std::size_t i = 0; i < wanted.values.size(); ++i) {
        ASSERT_NEAR(sent.values[i], wanted.values[i], 1) << i;
        changed += sent.values[i] != wanted.values[i] ? 1u : 0u;
    }
    EXPECT_LT(changed, wanted.values.size() / 1000);
    EXPECT_EQ(frame->compensation.out_of_gamut_fraction, 0.0);
}

TEST_P(FrameThreadOnADevice, PaintsDuringASlowSolveShowInTheOldLightAndThenInTheNew) {
    leave_out_light_between_parts();
    description_.scene.environment = sky(0.8);
    start();
    ASSERT_TRUE(gallery_.whole(show()));
    const auto old = description_.scene.environment;
    // A big map takes long to filter.
    description_.scene.environment = sky(0.1, 2048);
    show();
    paint(description_.scene, 0, ReflectanceModel::clearcoat, {0.1, 0.5, 0.1});
    const auto painted = show();

    const auto between = gallery_.wait_for([&](const FinishedFrame& frame) {
        return frame.number == painted && frame.unfinished == "environment: solving";
    });
    ASSERT_TRUE(between);
    Scene in_old_light = description_.scene;
    in_old_light.environment = old;
    EXPECT_EQ(drive(*between).values, from_scratch(in_old_light).drive.values);

    const auto end = gallery_.whole(painted);
    ASSERT_TRUE(end);
    EXPECT_EQ(drive(*end).values, from_scratch(description_.scene).drive.values);
    std::uint64_t before = 0;
    for (const FramePointer& frame : gallery_.all()) {
        EXPECT_GE(frame->number, before);
        before = frame->number;
    }
}

TEST_F(FrameThreadTest, ADraftComesFirstAndSaysSo) {
    description_.scene.environment = sky(0.8);
    start();
    const auto number = show();
    const auto end = gallery_.whole(number);
    ASSERT_TRUE(end);
    const auto frames = gallery_.all();
    ASSERT_GE(frames.size(), 2u);
    EXPECT_EQ(frames.front()->plan.quality, Quality::draft);
    EXPECT_TRUE(frames.front()->unfinished == "normal quality: solving")
        << frames.front()->unfinished;
    EXPECT_EQ(end->plan.quality, Quality::normal);
    EXPECT_GT(*find_pass(frames.front()->plan, PassKind::surface_map)->ms, 0.0);
    EXPECT_GT(*find_pass(end->plan, PassKind::reflection_occlusion)->ms, 0.0);
    EXPECT_GT(end->shade_ms, 0.0);
}

TEST_F(FrameThreadTest, PreparingIsAListedPass) {
    PaintLibrary library;
    library.shipped = {paint_of(ReflectanceModel::ggx, 0.2),
                       paint_of(ReflectanceModel::clearcoat, 0.1)};
    description_.library = std::make_shared<const PaintLibrary>(std::move(library));
    start();
    const auto number = show();
    const auto end = gallery_.whole(number);
    ASSERT_TRUE(end);
    for (const ReflectanceModel model : {ReflectanceModel::lambert, ReflectanceModel::ggx}) {
        const PassId id(PassKind::prepare, "", model);
        const PlannedPass* pass = find_pass(end->plan, id);
        ASSERT_TRUE(pass) << to_string(id);
        EXPECT_GT(*pass->ms, 0.0);
        EXPECT_NE(pass->why, "");
    }
    // All parts wear it: no preparing is needed.
    EXPECT_FALSE(find_pass(end->plan, {PassKind::prepare, "", ReflectanceModel::clearcoat}));
}

TEST_F(FrameThreadTest, TheNewestWins) {
    start();
    std::uint64_t last = 0;
    for (int k = 0; k < 200; ++k) {
        paint(description_.scene, 0, ReflectanceModel::ggx, {0.004 * k, 0.3, 0.2});
        last = show();
    }
    const auto end = gallery_.whole(last);
    ASSERT_TRUE(end);
    EXPECT_EQ(drive(*end).values, from_scratch(description_.scene).drive.values);
    EXPECT_LT(gallery_.all().size(), 100u);
}

TEST_F(FrameThreadTest, ANewerLightStopsASlowSolve) {
    start();
    ASSERT_TRUE(gallery_.whole(show()));
    description_.scene.environment = sky(0.1, 2048);
    const auto first = show();
    ASSERT_TRUE(
        gallery_.wait_for([&](const FinishedFrame& frame) { return frame.number == first; }));
    description_.scene.environment = sky(0.5);
    const auto second = show();
    const auto end = gallery_.whole(second);
    ASSERT_TRUE(end);
    EXPECT_EQ(drive(*end).values, from_scratch(description_.scene).drive.values);
    for (const FramePointer& frame : gallery_.all()) {
        EXPECT_FALSE(frame->number == first && frame->unfinished.empty());
    }
}

TEST_F(FrameThreadTest, SolvingTellsHowFarItIsAndNeverGoesBack) {
    start();
    ASSERT_TRUE(gallery_.whole(show()));
    // Two lights, each as a draft and then whole: one count for all four
    description_.scene.environment = sky(0.1);
    description_.wipe_to = description_.scene;
    description_.wipe_to->environment = sky(0.3);
    const auto number = show();
    std::vector<FrameThread::Solving> told;
    while (!thread_->is_idle()) {
        const auto solving = thread_->solving();
        if (solving && (told.empty() || told.back().fraction != solving->fraction)) {
            told.push_back(*solving);
        }
    }
    ASSERT_GT(told.size(), 4u);
    for (std::size_t k = 0; k < told.size(); ++k) {
        EXPECT_GE(told[k].fraction, k == 0 ? 0.0 : told[k - 1].fraction) << told[k].stage;
        EXPECT_LE(told[k].fraction, 1.0);
        EXPECT_NE(told[k].stage, "");
    }
    EXPECT_GT(told.back().fraction, 0.5);
    ASSERT_TRUE(gallery_.whole(number));
    wait_until_idle();
    EXPECT_FALSE(thread_->solving());
}

TEST_P(FrameThreadOnADevice, WipeShowsEachLookInItsColumns) {
    leave_out_light_between_parts();
    for (const bool same_light : {true, false}) {
        Scene right = description_.scene;
        paint(right, 0, ReflectanceModel::ggx, {0.1, 0.1, 0.7});
        if (!same_light) right.lights = {light_from({-0.5, 0.6, 0.4}, 0.0)};
        description_.wipe_to = right;
        description_.wipe_at = 0.4;
        if (!thread_) start();
        const auto frame = gallery_.whole(show());
        ASSERT_TRUE(frame);
        expect_wiped(*frame, right);

        // Moving the line composes, and shades nothing.
        description_.wipe_at = 0.8;
        const auto moved = gallery_.whole(show());
        ASSERT_TRUE(moved);
        expect_wiped(*moved, right);
        EXPECT_EQ(moved->shade_ms + moved->compensate_ms, 0.0);

        // A paint shades its own look only.
        paint(*description_.wipe_to, 1, ReflectanceModel::clearcoat, {0.6, 0.6, 0.1});
        const auto painted = gallery_.whole(show());
        ASSERT_TRUE(painted);
        expect_wiped(*painted, *description_.wipe_to);
    }
    wait_until_idle();
    description_.wipe_to.reset();
    const auto alone = gallery_.whole(show());
    ASSERT_TRUE(alone);
    EXPECT_EQ(drive(*alone).values, from_scratch(description_.scene).drive.values);
}

TEST_F(FrameThreadTest, LightBetweenPartsFollowsAPaintOnce) {
    start();
    ASSERT_TRUE(gallery_.whole(show()));
    wait_until_idle();
    gallery_.clear();
    paint(description_.scene, 0, ReflectanceModel::clearcoat, {0.9, 0.1, 0.1});
    const std::uint64_t number = show();
    const auto frame = gallery_.whole(number);
    ASSERT_TRUE(frame);
    EXPECT_EQ(drive(*frame).values, from_scratch(description_.scene).drive.values);
    wait_until_idle();
    const auto told = gallery_.all();
    ASSERT_EQ(told.size(), 2u);
    EXPECT_EQ(told.front()->number, number) << "the paint waits for nothing";
    EXPECT_EQ(told.front()->unfinished, "light between parts: solving");
    EXPECT_EQ(told.back(), frame);
}

TEST_F(FrameThreadTest, AGlowingPartGlowsAndStops) {
    leave_out_light_between_parts();
    start();
    const auto before = gallery_.whole(show());
    ASSERT_TRUE(before);
    description_.glowing_part = 1;
    const auto glowing = gallery_.whole(show());
    ASSERT_TRUE(glowing);
    Scene painted = description_.scene;
    painted.part_materials[1] = glow_paint();
    EXPECT_EQ(drive(*glowing).values, from_scratch(painted).drive.values);
    EXPECT_NE(drive(*glowing).values, drive(*before).values);
    description_.glowing_part.reset();
    const auto after = gallery_.whole(show());
    ASSERT_TRUE(after);
    EXPECT_EQ(drive(*after).values, drive(*before).values);
}

TEST_P(FrameThreadOnADevice, AnotherCalibrationOfTheSameProjectorOnlyCorrectsAgain) {
    start();
    const auto before = gallery_.whole(show());
    ASSERT_TRUE(before);
    auto dimmer = std::make_shared<ProjectorSetup>(*description_.setup);
    auto calibration =
        synthetic_calibration(FrameGeometry(description_.scene.product, dimmer->view).map.coverage);
    dimmer->design_white_y *= 0.5;
    dimmer->table = bake(calibration, dimmer->design_white_y);
    description_.setup = dimmer;
    const auto after = gallery_.whole(show());
    ASSERT_TRUE(after);
    EXPECT_EQ(drive(*after).values, from_scratch(description_.scene).drive.values);
    EXPECT_NE(drive(*after).values, drive(*before).values);
    EXPECT_EQ(after->shade_ms, 0.0);
}

// Both scenes of a comparison go through one map: that of the setup.
TEST_P(FrameThreadOnADevice, MapsTheGamutOfEverySceneAlike) {
    leave_out_light_between_parts();
    start();
    description_.scene.exposure_ev = 2.0;  // much of it out of reach
    const auto clipped = gallery_.whole(show());
    ASSERT_TRUE(clipped);
    EXPECT_GT(clipped->compensation.out_of_gamut_fraction, 0.1);
    auto preserving = std::make_shared<ProjectorSetup>(*description_.setup);
    const auto calibration = synthetic_calibration(
        FrameGeometry(description_.scene.product, preserving->view).map.coverage);
    preserving->table = bake(calibration, preserving->design_white_y, GamutMapping::preserve);
    description_.setup = preserving;
    const auto mapped = gallery_.whole(show());
    ASSERT_TRUE(mapped);
    EXPECT_EQ(drive(*mapped).values, compensate(*preserving->table, radiance(*mapped)).values);
    EXPECT_NE(drive(*mapped).values, drive(*clipped).values);
    EXPECT_EQ(mapped->compensation.out_of_gamut_fraction,
              clipped->compensation.out_of_gamut_fraction);
    EXPECT_EQ(mapped->shade_ms, 0.0);
    description_.wipe_to = description_.scene;
    const auto wiped = gallery_.whole(show());
    ASSERT_TRUE(wiped);
    EXPECT_EQ(drive(*wiped).values, drive(*mapped).values);
}

// Whoever holds a frame has its picture, whatever both lanes have drawn since.
TEST_P(FrameThreadOnADevice, HeldFramesKeepTheirPictures) {
    leave_out_light_between_parts();
    auto preserving = std::make_shared<ProjectorSetup>(*description_.setup);
    preserving->table =
        bake(synthetic_calibration(
                 FrameGeometry(description_.scene.product, preserving->view).map.coverage),
             preserving->design_white_y,
             GamutMapping::preserve);
    start();
    struct Held {
        FramePointer frame;
        std::shared_ptr<const ProjectorSetup> setup;
        Image8 drive;
        ImageF radiance;
    };
    std::vector<Held> held;
    for (int k = 0; k < 12; ++k) {
        SCOPED_TRACE(k);
        description_.scene.exposure_ev = k % 3 == 2 ? 2.0 : 0.0;
        if (k % 4 == 3) description_.setup = preserving;
        // Another light changes the lanes' places.
        if (k % 3 == 0) description_.scene.lights = {light_from({0.1 * k - 0.5, 0.8, 0.5}, 0.0)};
        description_.wipe_to.reset();
        if (k % 2 == 1) description_.wipe_to = description_.scene;
        paint(description_.scene, 0, ReflectanceModel::ggx, {0.08 * k, 0.3, 0.6});
        const auto frame = gallery_.whole(show());
        ASSERT_TRUE(frame);
        held.push_back({frame, description_.setup, drive(*frame), radiance(*frame)});
        const Held& now = held.back();
        CompensationStats stats;
        EXPECT_EQ(now.drive.values, compensate(*now.setup->table, now.radiance, &stats).values);
        if (description_.wipe_to) continue;
        const CompensationStats& told = frame->compensation;
        EXPECT_EQ(told.out_of_gamut_fraction, stats.out_of_gamut_fraction);
        EXPECT_EQ(told.invalid_fraction, stats.invalid_fraction);
        EXPECT_EQ(told.clipped_high_fraction, stats.clipped_high_fraction);
        EXPECT_EQ(told.clipped_low_fraction, stats.clipped_low_fraction);
    }
    for (const Held& before : held) {
        EXPECT_EQ(drive(*before.frame).values, before.drive.values);
        EXPECT_EQ(radiance(*before.frame).values, before.radiance.values);
        EXPECT_NE(&before == &held.front() ? held.back().drive.values : held.front().drive.values,
                  before.drive.values);
    }
}

TEST_P(FrameThreadOnADevice, ThePlanSaysWhereThePictureIsMade) {
    start();
    const auto frame = gallery_.whole(show());
    ASSERT_TRUE(frame);
    const bool on_card = GetParam() == ShadingDevice::gl;
    const PlannedPass& pass = *find_pass(frame->plan, PassKind::compensation);
    EXPECT_NE(pass.why.find(on_card ? "on the graphics card" : "on the processor"),
              std::string::npos)
        << pass.why;
    EXPECT_GT(*pass.ms, 0.0);
    EXPECT_EQ(*pass.ms, frame->compensate_ms);
    // A picture that is there already was made there, too.
    const auto again = gallery_.whole(show());
    ASSERT_TRUE(again);
    EXPECT_EQ(find_pass(again->plan, PassKind::compensation)->why, pass.why);
    // What the card has stays there until it is asked for, and is gone with its thread.
    EXPECT_EQ(frame->pictures->drive.image == nullptr, on_card);
    EXPECT_EQ(frame->pictures->radiance[0].image == nullptr, on_card);
    thread_.reset();
    if (on_card) {
        EXPECT_THROW(drive(*frame), std::invalid_argument);
    } else {
        EXPECT_EQ(drive(*frame).values, from_scratch(description_.scene).drive.values);
    }
}

TEST_P(FrameThreadOnADevice, AnotherProjectorAndAnotherProductAreSolvedFromTheStart) {
    start();
    ASSERT_TRUE(gallery_.whole(show()));
    description_.setup = setup_of(test_view(96, 80), description_.scene);
    const auto smaller = gallery_.whole(show());
    ASSERT_TRUE(smaller);
    EXPECT_EQ(smaller->size_px.x, 96);
    EXPECT_EQ(drive(*smaller).values, from_scratch(description_.scene).drive.values);

    const Scene other = scene_of(make_sphere({0, 0, 0}, 30.0, 64, "body"),
                                 paint_of(ReflectanceModel::lambert, 0.1));
    description_.scene.product = other.product;
    description_.scene.part_materials = other.part_materials;
    const auto sphere = gallery_.whole(show());
    ASSERT_TRUE(sphere);
    EXPECT_EQ(drive(*sphere).values, from_scratch(description_.scene).drive.values);
}

TEST_F(FrameThreadTest, TheFirstPaintThatMirrorsIsDrawnRight) {
    description_.scene.environment = sky(0.8);
    description_.scene.part_materials.assign(2, paint_of(ReflectanceModel::lambert, 0.1));
    start();
    const auto number = show();
    ASSERT_TRUE(
        gallery_.wait_for([&](const FinishedFrame& frame) { return frame.number == number; }));
    paint(description_.scene, 0, ReflectanceModel::clearcoat, {0.5, 0.1, 0.1});
    const auto mirroring = gallery_.whole(show());
    ASSERT_TRUE(mirroring);
    EXPECT_EQ(drive(*mirroring).values, from_scratch(description_.scene).drive.values);
}

TEST_F(FrameThreadTest, AnotherRoughnessIsDrawnAtOnceAndThenAtTheQualityAskedFor) {
    leave_out_light_between_parts();
    description_.scene.environment = sky(0.8);
    start();
    const auto first = show();
    ASSERT_TRUE(
        gallery_.wait_for([&](const FinishedFrame& frame) { return frame.number == first; }));
    // Whatever the lanes are at, a paint that mirrors what nobody has solved comes soon, marked
    for (const double alpha : {0.6, 0.01, 0.2}) {
        description_.scene.part_materials[0] = paint_of(ReflectanceModel::ggx, alpha);
        const auto number = show();
        const auto soon =
            gallery_.wait_for([&](const FinishedFrame& frame) { return frame.number == number; });
        ASSERT_TRUE(soon);
        EXPECT_EQ(soon->problem, "");
    }
    const auto end = gallery_.whole(description_.number - 1);
    ASSERT_TRUE(end);
    EXPECT_EQ(drive(*end).values, from_scratch(description_.scene).drive.values);
    // By then all others are solved: a listed pass
    FramePlan plan = end->plan;
    say_why(end->scene, plan);
    const PlannedPass* ahead = find_pass(plan, mirrored_ahead_pass());
    ASSERT_TRUE(ahead);
    EXPECT_NE(ahead->why, "");
    EXPECT_GT(*ahead->ms, 0.0);
    description_.scene.part_materials[1] = paint_of(ReflectanceModel::clearcoat, 0.3);
    const auto last = gallery_.whole(show());
    ASSERT_TRUE(last);
    EXPECT_EQ(*find_pass(last->plan, mirrored_ahead_pass())->ms, 0.0);
    EXPECT_EQ(*find_pass(last->plan, PassKind::mirrored_environment)->ms, 0.0);
    EXPECT_EQ(drive(*last).values, from_scratch(description_.scene).drive.values);
}

TEST_F(FrameThreadTest, IdleMeansThatNothingIsDone) {
    start();
    ASSERT_TRUE(gallery_.whole(show()));
    wait_until_idle();
    const std::size_t frames = gallery_.all().size();
    const std::clock_t before = std::clock();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    // Processor time of the whole program; a draft of this picture alone takes more.
    EXPECT_LT(std::clock() - before, CLOCKS_PER_SEC / 50);
    EXPECT_EQ(gallery_.all().size(), frames);
    EXPECT_TRUE(thread_->is_idle());
}

TEST_P(FrameThreadOnADevice, ManySwapsUseAFewTextures) {
    // A dozen would be used up in twenty; a texture lost once in a while shows in a thousand.
    const int swaps = thorough() ? 1000 : 60;
    leave_out_light_between_parts();
    start();
    ASSERT_TRUE(gallery_.whole(show()));
    std::set<unsigned> textures;
    std::set<const void*> pictures;
    for (int k = 0; k < swaps; ++k) {
        gallery_.clear();
        paint(description_.scene, 1, ReflectanceModel::ggx, {0.001 * k, 0.3, 0.2});
        const auto frame = gallery_.whole(show());
        ASSERT_TRUE(frame);
        textures.insert(frame->drive_texture);
        const FramePictures& made = *frame->pictures;
        pictures.insert(made.drive.image ? static_cast<const void*>(made.drive.image.get())
                                         : made.radiance[0].slot.get());
    }
    EXPECT_LE(textures.size(), 12u);
    EXPECT_LE(pictures.size(), 12u);
}

TEST_P(FrameThreadOnADevice, EndsAtAnyMoment) {
    Random random(7, 1);
    for (int round = 0; round < 25; ++round) {
        start();
        const int shows = static_cast<int>(random.uniform() * 6.0);
        for (int k = 0; k < shows; ++k) {
            paint(description_.scene, 0, ReflectanceModel::ggx, {0.1 * k, 0.3, 0.2});
            if (random.uniform() < 0.4) description_.scene.environment = sky(random.uniform());
            show();
            std::this_thread::sleep_for(
                std::chrono::microseconds(static_cast<int>(random.uniform() * 60000.0)));
        }
        thread_.reset();
        gallery_.clear();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        EXPECT_TRUE(gallery_.all().empty()) << "a frame after its end";
    }
}

}  // namespace
}  // namespace livery
