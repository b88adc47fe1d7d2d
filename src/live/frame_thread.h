// Frame descriptions in, projector pictures out, on a thread of its own: nothing else waits for it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "gl/context.h"
#include "gl/timer.h"
#include "live/frame_description.h"
#include "live/frame_pictures.h"
#include "radiance/lanes/input_layers.h"

namespace livery {

/// A finished one. Textures belong to the share group and live as long as this value, which may be
/// let go of on any thread, and end with the FrameThread. A number comes again when more of the
/// same description is there.
struct FinishedFrame {
    std::uint64_t number = 0;
    unsigned drive_texture = 0;  ///< RGBA8 projector input; 0 before the first good frame
    glm::ivec2 size_px{0};
    std::shared_ptr<const Fence> ready;
    double fade_s = 0.0;                            ///< as described
    std::shared_ptr<const FramePictures> pictures;  ///< for the bench and for files
    Scene scene;                                    ///< drawn, left of a wipe
    std::optional<Scene> wiped_to;                  ///< right of it
    FramePlan plan;  ///< measured milliseconds, and "prepare:..." passes that ran ahead
    CompensationStats compensation;
    double shade_ms = 0.0, compensate_ms = 0.0, ms_total = 0.0;
    /// While light, environment, eye or quality are still being solved the last solved ones are
    /// shown with the new paints: what it is not yet; empty when it is all there.
    std::string unfinished;
    /// Why a description could not be drawn; everything but number and times is the last good
    /// frame's, if there was one.
    std::string problem;
    std::chrono::steady_clock::time_point asked_at{}, done_at{};
};

/// Two lanes, each a thread with a context and a renderer. The front lane answers paint swaps at
/// once with the light that it has solved; a change of light, environment, eye, quality or
/// projector is solved on the back lane, at draft first, and the lanes change places when it is
/// done. So nothing slow ever delays a paint. The newest description wins; those in between are
/// dropped. Before a lane comes to the front for good it compiles what any paint of the library may
/// need (listed passes), and while idle the back lane follows the front's light.
class FrameThread {
  public:
    /// Contexts of one share group, current nowhere; they must outlive this. `on_finished` is
    /// called on a lane's thread, one call at a time; it may call show(). `device` shades and
    /// corrects.
    FrameThread(GlContext& front,
                GlContext& back,
                std::function<void(std::shared_ptr<const FinishedFrame>)> on_finished,
                ShadingDevice device = ShadingDevice::automatic);
    ~FrameThread();
    FrameThread(const FrameThread&) = delete;
    FrameThread& operator=(const FrameThread&) = delete;

    void show(WantedFrame frame);  ///< any thread, returns at once
    /// How far a slow solve is; nothing when none runs.
    struct Solving {
        double fraction = 0.0;
        std::string stage;
    };
    std::optional<Solving> solving() const;
    /// Nothing is drawn, solved or prepared until something is shown.
    bool is_idle() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
