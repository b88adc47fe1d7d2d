// From any paint of the library to any other: the very next picture, and nothing made for it.
#include <algorithm>
#include <cstdlib>
#include <set>

#include <gtest/gtest.h>

#include "appearance/material_library.h"
#include "core/random.h"
#include "live/frame_lane.h"
#include "live/frame_thread_fixture.h"
#include "support/gl_device.h"
#include "support/shading_devices.h"

namespace livery {
namespace {

/// Every shipped paint in an order of chance, and from each to the next a second time both ways.
std::vector<Material> walk_through_the_library() {
    std::vector<Material> paints = read_paint_library()->shipped;
    Random random(63, 1);
    shuffle(paints, random);
    std::vector<Material> walk = paints;
    for (std::size_t k = 0; k + 1 < paints.size(); k += 4) {
        walk.insert(walk.end(), {paints[k], paints[k + 1], paints[k]});
    }
    return walk;
}

/// What a swap may cost: the part is shaded, its pixels are mixed and corrected.
bool belongs_to_a_swap(const PassId& pass) {
    return pass.kind == PassKind::shade || pass == PassKind::resolve ||
           pass == PassKind::compensation;
}

using PaintSwaps = FrameThreadTest;

TEST_F(PaintSwaps, EachIsTheVeryNextFrameAndSolvesNothing) {
    leave_out_light_between_parts();
    description_.scene.environment = sky(0.8);
    description_.library = read_paint_library();
    start();
    ASSERT_TRUE(gallery_.whole(show()));
    wait_until_idle();
    gallery_.clear();
    const std::uint64_t first = description_.number;
    std::set<std::string> worn;
    std::size_t k = 0;
    for (const Material& paint : walk_through_the_library()) {
        SCOPED_TRACE(paint.name);
        worn.insert(paint.name);
        description_.scene.part_materials[k++ % 2] = paint;
        const std::uint64_t number = show();
        const auto frame =
            gallery_.wait_for([&](const auto& shown) { return shown.number >= number; });
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->number, number);
        EXPECT_EQ(frame->problem, "");
        EXPECT_EQ(frame->unfinished, "");
        EXPECT_FALSE(thread_->solving());
        for (const PlannedPass& pass : frame->plan.passes) {
            EXPECT_TRUE(pass.ms.value_or(0.0) == 0.0 || belongs_to_a_swap(pass.id))
                << to_string(pass.id);
        }
        if (k % 12 == 0) {
            EXPECT_EQ(drive(*frame).values, from_scratch(description_.scene).drive.values);
        }
    }
    EXPECT_EQ(worn.size(), read_paint_library()->shipped.size());
    // One picture a swap, in their order, and none besides.
    std::uint64_t expected = first;
    for (const FramePointer& frame : gallery_.all()) EXPECT_EQ(frame->number, expected++);
    EXPECT_EQ(expected, description_.number);
}

class PaintSwapsOnADevice : public ::testing::TestWithParam<ShadingDevice> {};

LIVERY_ON_DEVICES(PaintSwapsOnADevice, ShadingDevice::gl, ShadingDevice::processor);

FrameDescription glossy_spheres() {
    FrameDescription description;
    description.scene = scene_of(two_spheres(), paint_of(ReflectanceModel::clearcoat, 0.05));
    description.scene.environment = sky(0.8);
    description.setup = setup_of(test_view(64, 48), description.scene);
    return description;
}

TEST_P(PaintSwapsOnADevice, CompileAndAllocateNothing) {
    HeadlessContext context(tested_gl());
    FrameDescription description = glossy_spheres();
    description.scene.lights = {light_from({0.4, 0.8, 0.5}, 3.0 * kDegree_rad)};
    description.library = read_paint_library();
    FrameLane lane(std::make_shared<GeometryCache>(), GetParam());
    lane.solve(description, levels_of(description.quality), {}, {});
    lane.prepare(description, {});
    // The first few make what later ones take turns with.
    for (int k = 0; k < 6; ++k) {
        description.scene.part_materials[0].diffuse.x = 0.1 * k;
        lane.draw(description);
    }
    const RadianceRenderer::Counters warm = lane.counters();
    EXPECT_EQ(warm.programs > 0, GetParam() == ShadingDevice::gl);
    EXPECT_GT(warm.textures, 0);
    int swaps = 0;
    for (const Material& paint : walk_through_the_library()) {
        SCOPED_TRACE(paint.name);
        description.scene.part_materials[0] = paint;
        ASSERT_TRUE(lane.can_draw(description));
        lane.draw(description);
        ++swaps;
        const RadianceRenderer::Counters now = lane.counters();
        ASSERT_EQ(now.programs, warm.programs);
        ASSERT_EQ(now.textures, warm.textures);
        ASSERT_EQ(now.passes_run, warm.passes_run + 2 * swaps) << "shading of its part, mixing";
    }
}

// Budgets are made by the frame that was told last, drawn or not.
TEST_P(PaintSwapsOnADevice, APictureThatIsThereAlreadySaysWhatItTakes) {
    HeadlessContext context(tested_gl());
    FrameDescription description = glossy_spheres();
    FrameLane lane(std::make_shared<GeometryCache>(), GetParam());
    lane.solve(description, levels_of(description.quality), {}, {});
    const FramePlan drawn = lane.draw(description)->plan;
    const FramePlan again = lane.draw(description)->plan;
    ASSERT_EQ(again.passes.size(), drawn.passes.size());
    int told = 0;
    for (std::size_t k = 0; k < drawn.passes.size(); ++k) {
        EXPECT_EQ(again.passes[k].work_items, drawn.passes[k].work_items)
            << to_string(drawn.passes[k].id);
        told += drawn.passes[k].work_items > 0.0 ? 1 : 0;
    }
    EXPECT_GT(told, 4);
}

TEST_P(PaintSwapsOnADevice, ADraftLooksUpWhatAPaintMirrorsAsItIsDrawn) {
    // While another light is solved, which may take seconds, paints are swapped in its draft.
    HeadlessContext context(tested_gl());
    FrameDescription description = glossy_spheres();
    FrameLane lane(std::make_shared<GeometryCache>(), GetParam());
    lane.solve(description, levels_of(Quality::draft), {}, {});
    lane.draw(description);
    for (const double alpha : {0.02, 0.11, 0.3, 0.7}) {
        SCOPED_TRACE(alpha);
        for (const ReflectanceModel model : {ReflectanceModel::ggx, ReflectanceModel::car_paint}) {
            description.scene.part_materials[0] = paint_of(model, alpha);
            ASSERT_TRUE(lane.can_draw(description));
            const auto swapped = lane.draw(description);
            FrameLane anew(std::make_shared<GeometryCache>(), GetParam());
            anew.solve(description, levels_of(Quality::draft), {}, {});
            const auto solved = anew.draw(description);
            const std::vector<std::uint8_t> one = drive_of(*swapped->pictures)->values;
            const std::vector<std::uint8_t> other = drive_of(*solved->pictures)->values;
            ASSERT_EQ(one.size(), other.size());
            int most = 0;
            for (std::size_t i = 0; i < one.size(); ++i) {
                most = std::max(most, std::abs(int{one[i]} - int{other[i]}));
            }
            // Between which fragments one interpolates depends on all lobes that are looked up
            EXPECT_LE(most, 1);
        }
    }
    // In better light it would not be there in time
    lane.solve(description, levels_of(Quality::normal), {}, {});
    description.scene.part_materials[0] = paint_of(ReflectanceModel::ggx, 0.05);
    EXPECT_FALSE(lane.can_draw(description));
}

}  // namespace
}  // namespace livery
