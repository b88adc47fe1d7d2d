// A frame thread in two contexts that share, and what it tells.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "gl/context.h"
#include "jobs/render/render.h"
#include "jobs/synthetic_calibration.h"
#include "live/frame_lane.h"
#include "live/frame_thread.h"
#include "radiance/renderer.h"
#include "radiance/scenes.h"
#include "support/gl_device.h"

namespace livery {

using FramePointer = std::shared_ptr<const FinishedFrame>;
inline constexpr auto kPatience = std::chrono::minutes(5);  // other programs may be busy

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
    /// The first frame, from now on or told before, that is as wanted; null after a long time.
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

inline std::shared_ptr<const Environment> sky(double upper, int width = 64) {
    auto environment = std::make_shared<Environment>();
    ImageF& picture = environment->radiance_working;
    picture = ImageF(width, width / 2, 3, 0.2f);
    std::fill_n(picture.values.begin(), picture.values.size() / 2, static_cast<float>(upper));
    return environment;
}

inline std::shared_ptr<const ProjectorSetup> setup_of(const View& view, const Scene& scene) {
    auto setup = std::make_shared<ProjectorSetup>();
    setup->view = view;
    const FrameGeometry geometry(scene.product, view);
    const ColourCalibration calibration = synthetic_calibration(geometry.map.coverage);
    setup->design_white_y = design_white_luminance(calibration, 20.0, {});
    setup->table = bake(calibration, setup->design_white_y);
    return setup;
}

/// Two spheres under a key light, and a frame thread in two contexts that share.
class FrameThreadTest : public ::testing::Test {
  protected:
    FrameThreadTest() {
        for (HeadlessContext* context : {&window_, &front_, &back_}) context->release();
        description_.scene = scene_of(two_spheres(), paint_of(ReflectanceModel::clearcoat, 0.05));
        description_.scene.lights = {light_from({0.4, 0.8, 0.5}, 3.0 * kDegree_rad)};
        description_.setup = setup_of(test_view(128, 96), description_.scene);
        description_.number = 1;
    }

    void start() {
        thread_ = std::make_unique<FrameThread>(front_, back_, gallery_.adder(), device_);
    }
    template <typename Fetch>
    auto in_window(const Fetch& fetch) {
        struct Current {
            HeadlessContext& context;
            explicit Current(HeadlessContext& its_context) : context(its_context) {
                context.make_current();
            }
            ~Current() { context.release(); }
        };
        const Current current(window_);
        return fetch();
    }
    /// A frame's pictures as a window fetches them, whichever device holds them.
    Image8 drive(const FinishedFrame& frame) {
        return in_window([&] { return *drive_of(*frame.pictures); });
    }
    ImageF radiance(const FinishedFrame& frame) {
        return in_window([&] { return *radiance_of(*frame.pictures); });
    }
    /// The next number, shown.
    std::uint64_t show() {
        thread_->show(description_);
        return description_.number++;
    }
    EffectLevels levels() const {
        return description_.levels.value_or(levels_of(description_.quality));
    }
    /// What a paint sends to other parts follows it on the back lane: not for tests of what comes
    /// with the paint itself.
    void leave_out_light_between_parts() {
        description_.levels = levels();
        (*description_.levels)[Effect::interreflection] = 0;
    }
    void paint(Scene& scene, std::size_t part, ReflectanceModel model, glm::dvec3 diffuse) {
        scene.part_materials[part] = paint_of(model, 0.1);
        scene.part_materials[part].diffuse = diffuse;
    }
    RenderedFrame from_scratch(const Scene& scene) const {
        if (device_ == ShadingDevice::gl) return from_scratch_in_gl(scene);
        RenderRequest request;
        request.scene = scene;
        request.view = description_.setup->view;
        request.quality = description_.quality;
        request.levels = description_.levels;
        request.gl_device = tested_gl();
        if (description_.setup->table) {
            request.stage = FrameStage::projector;
            request.compensation = &*description_.setup->table;
        }
        return render_frame(request);
    }

    /// Shaded in OpenGL, corrected on the processor.
    RenderedFrame from_scratch_in_gl(const Scene& scene) const {
        const HeadlessContext context(tested_gl());
        RadianceRenderer renderer(
            std::make_shared<const FrameGeometry>(
                scene.product, description_.setup->view, Progress{}, sub_samples_of(levels())),
            false,
            ShadingDevice::gl);
        RenderedFrame frame;
        frame.plan = plan_frame(scene, levels(), FrameStage::projector);
        renderer.render(scene, frame.plan);
        frame.radiance_working = renderer.read_back();
        if (const auto& table = description_.setup->table) {
            frame.drive = compensate(*table, frame.radiance_working, &frame.compensation);
        }
        return frame;
    }

    void wait_until_idle() const {
        while (!thread_->is_idle()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    void expect_wiped(const FinishedFrame& frame, const Scene& right) {
        const Image8 shown = drive(frame);
        const Image8 left_drive = from_scratch(description_.scene).drive;
        const Image8 right_drive = from_scratch(right).drive;
        const FrameGeometry geometry(right.product, description_.setup->view);
        const int column = wipe_column(geometry.map, description_.wipe_at);
        int differing = 0;
        for (int y = 0; y < left_drive.height; ++y) {
            for (int x = 0; x < left_drive.width; ++x) {
                for (int c = 0; c < 3; ++c) {
                    const Image8& wanted = x < column ? left_drive : right_drive;
                    differing += shown.at(x, y, c) != wanted.at(x, y, c) ? 1 : 0;
                }
            }
        }
        EXPECT_EQ(differing, 0) << "the line at column " << column;
    }

    HeadlessContext window_{tested_gl()}, front_{tested_gl(), &window_},
        back_{tested_gl(), &window_};
    ShadingDevice device_ = ShadingDevice::automatic;  ///< the processor, in software
    Gallery gallery_;
    FrameDescription description_;
    std::unique_ptr<FrameThread> thread_;
};

/// What both devices have to do alike.
class FrameThreadOnADevice : public FrameThreadTest,
                             public ::testing::WithParamInterface<ShadingDevice> {
  protected:
    FrameThreadOnADevice() { device_ = GetParam(); }
};

}  // namespace livery
