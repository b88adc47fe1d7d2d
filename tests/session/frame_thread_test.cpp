#include "session/frame_thread.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "core/random.h"
#include "gl/handles.h"
#include "gl/read_back.h"
#include "radiance/scenes.h"
#include "session/frame_lane.h"
#include "session/picture.h"
#include "session/render.h"
#include "session/synthetic_calibration.h"

namespace livery {
namespace {

using FramePointer = std::shared_ptr<const FinishedFrame>;
constexpr auto kPatience = std::chrono::seconds(60);

/// What the frame thread tells, to be waited for.
class Gallery {
  public:
    void add(FramePointer frame) {
        const std::scoped_lock lock(mutex_);
        frames_.push_back(std::move(frame));
        changed_.notify_all();
    }
    auto adder() {
        return [this](FramePointer frame) { add(std::move(frame)); };
    }
    /// The first frame, from now on or told before, that is as wanted; null after a minute.
    FramePointer wait_for(const std::function<bool(const FinishedFrame&)>& wanted) {
        std::unique_lock lock(mutex_);
        FramePointer found;
        changed_.wait_for(lock, kPatience, [&] {
            for (const FramePointer& frame : frames_) {
                if (wanted(*frame)) found = frame;
                if (found) break;
            }
            return found != nullptr;
        });
        return found;
    }
    FramePointer whole(std::uint64_t number) {
        return wait_for([&](const FinishedFrame& frame) {
            return frame.number == number && frame.unfinished.empty();
        });
    }
    std::deque<FramePointer> all() {
        const std::scoped_lock lock(mutex_);
        return frames_;
    }
    void clear() {
        const std::scoped_lock lock(mutex_);
        frames_.clear();
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<FramePointer> frames_;
};

std::shared_ptr<const Environment> sky(double upper) {
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(64, 32, 3, 0.2f);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 64; ++x) {
            for (int c = 0; c < 3; ++c) {
                environment->radiance_working.at(x, y, c) = static_cast<float>(upper);
            }
        }
    }
    return environment;
}

std::shared_ptr<const ProjectorSetup> setup_of(const View& view, const Scene& scene) {
    auto setup = std::make_shared<ProjectorSetup>();
    setup->view = view;
    const FrameGeometry geometry(scene.product, view);
    const ColourCalibration calibration = synthetic_calibration(geometry.map.coverage);
    setup->design_white_y = design_white_luminance(calibration, 20.0);
    setup->table = bake(calibration, setup->design_white_y);
    return setup;
}

/// Two spheres under a key light and a sky, and a frame thread in two contexts that share.
class FrameThreadTest : public testing::Test {
  protected:
    FrameThreadTest() {
        for (HeadlessContext* context : {&window_, &front_, &back_}) context->release();
        description_.scene = scene_of(two_spheres(), paint_of(ReflectanceModel::clearcoat, 0.05));
        description_.scene.lights = {light_from({0.4, 0.8, 0.5}, 3.0 * kDegree_rad)};
        description_.scene.environment = sky(0.8);
        description_.setup = setup_of(test_view(128, 96), description_.scene);
        description_.number = 1;
    }

    void start() { thread_ = std::make_unique<FrameThread>(front_, back_, gallery_.adder()); }
    /// The next number, shown.
    std::uint64_t show() {
        thread_->show(description_);
        return description_.number++;
    }
    void paint(Scene& scene, std::size_t part, ReflectanceModel model, glm::dvec3 diffuse) {
        scene.part_materials[part] = paint_of(model, 0.1);
        scene.part_materials[part].diffuse = diffuse;
    }
    RenderedFrame from_scratch(const Scene& scene) const {
        RenderRequest request;
        request.scene = scene;
        request.view = description_.setup->view;
        request.quality = description_.quality;
        request.gl_device = GlDevice::software;
        if (description_.setup->table) {
            request.stage = FrameStage::projector;
            request.compensation = &*description_.setup->table;
        }
        return render_frame(request);
    }

    HeadlessContext window_{GlDevice::software}, front_{GlDevice::software, &window_},
        back_{GlDevice::software, &window_};
    Gallery gallery_;
    FrameDescription description_;
    std::unique_ptr<FrameThread> thread_;
};

TEST_F(FrameThreadTest, FramesAreRenderFramesOwn) {
    start();
    const auto first = gallery_.whole(show());
    ASSERT_TRUE(first);
    EXPECT_EQ(first->problem, "");
    EXPECT_EQ(first->drive->values, from_scratch(description_.scene).drive.values);
    EXPECT_GT(*std::max_element(first->drive->values.begin(), first->drive->values.end()), 50);

    paint(description_.scene, 0, ReflectanceModel::ggx, {0.1, 0.2, 0.7});
    const auto second = gallery_.whole(show());
    ASSERT_TRUE(second);
    const RenderedFrame truth = from_scratch(description_.scene);
    EXPECT_EQ(second->drive->values, truth.drive.values);
    EXPECT_EQ(second->radiance_working->values, truth.radiance_working.values);
    EXPECT_EQ(second->compensation.out_of_gamut_fraction, truth.compensation.out_of_gamut_fraction);
    EXPECT_NE(second->drive->values, first->drive->values);
}

TEST_F(FrameThreadTest, TheTextureIsTheDriveInTheShareGroup) {
    start();
    const auto frame = gallery_.whole(show());
    ASSERT_TRUE(frame);
    window_.make_current();
    frame->ready->wait_on_device();
    const View& view = description_.setup->view;
    const ImageF texels = read_floats(frame->drive_texture, view.width, view.height, 4);
    for (std::size_t i = 0; i < texels.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_EQ(std::lround(255.0f * texels.values[4 * i + c]),
                      frame->drive->values[3 * i + c])
                << i;
        }
        ASSERT_EQ(texels.values[4 * i + 3], 1.0f);
    }
    window_.release();
}

TEST_F(FrameThreadTest, UncorrectedIsSrgb) {
    auto setup = std::make_shared<ProjectorSetup>();
    setup->view = description_.setup->view;
    setup->why_uncorrected = "no calibration";
    description_.setup = setup;
    start();
    const auto frame = gallery_.whole(show());
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->drive->values,
              srgb_from_working(from_scratch(description_.scene).radiance_working).values);
}

}  // namespace
}  // namespace livery
