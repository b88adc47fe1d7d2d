// One of the frame thread's two lanes: renderers in one context, what they have solved, and how a
// description becomes a finished frame with it.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "live/drive_path.h"
#include "live/frame_description.h"
#include "live/frame_thread.h"
#include "live/low_priority.h"
#include "radiance/renderer.h"

namespace livery {

/// The column where the right scene of a wipe begins: a fraction of the mock-up's width.
int wipe_column(const SurfaceMap& map, double wipe_at);

/// What a part that was clicked in the preview is painted with for a moment.
Material glow_paint();

/// The surface map of the newest product and view, for both lanes: with as many sub-samples as
/// levels ask for, or more.
class GeometryCache {
  public:
    std::shared_ptr<const FrameGeometry> get(const SolveKey& key, const Progress& progress);

  private:
    std::mutex mutex_;
    std::shared_ptr<const FrameGeometry> newest_;
};

/// Of each light that is solved.
using SolvedMirrors = std::array<SolvedMirror, 2>;

/// Whether a lane that has solved this can draw the description without solving more: the same
/// pose, and all that its paints mirror.
bool can_draw(const SolveKeys& solved, const SolvedMirrors& mirrors, const WantedFrame& frame);

/// For one thread, with its context current from creation to destruction.
class FrameLane {
  public:
    explicit FrameLane(std::shared_ptr<GeometryCache> geometries,
                       ShadingDevice device = ShadingDevice::automatic);

    /// Solves the description's light at these levels; rays are traced on threads that give way as
    /// `urgency` says (none: on this thread, at its own priority). After a stop nothing can be
    /// drawn until a solve went through, which takes up what is there.
    void solve(const WantedFrame& frame,
               const EffectLevels& levels,
               std::optional<Urgency> urgency,
               const Progress& progress);
    /// What any other paint may need in the light that is solved, so that none has to wait.
    void prepare(const WantedFrame& frame, const Progress& progress);

    const SolveKeys& solved() const { return solved_; }
    const SolvedMirrors& mirrors() const { return mirrors_; }
    bool is_prepared() const { return prepared_; }  ///< for any other paint
    bool can_draw(const WantedFrame& frame) const;

    /// The description's paints in the light that is solved; only what changed since the last one
    /// is drawn. Throws what goes wrong; after anything but std::invalid_argument the lane starts
    /// anew.
    std::shared_ptr<FinishedFrame> draw(const WantedFrame& frame);
    /// The same ahead of draw(), which then tells what it cost.
    void draw_ahead(const WantedFrame& frame);

    /// Of all its renderers and what follows on them.
    RadianceRenderer::Counters counters() const;

  private:
    /// One scene as last drawn.
    struct Side {
        Scene scene;            ///< in the light that is solved, and with the glow
        std::size_t light = 0;  ///< of lights_
        std::shared_ptr<const ProjectorSetup> setup;
        FramePicture<ImageF> radiance;  ///< none: not drawn
        FramePicture<Image8> drive;
        bool to_measure = false;  ///< corrected, and not yet asked what that took
        FramePlan plan;
        CompensationStats compensation;
        double shade_ms = 0.0, compensate_ms = 0.0;
        bool told = true;  ///< false: drawn ahead, no frame's plan has said so
    };
    /// The picture of all sides.
    struct Composed {
        std::array<FramePicture<Image8>, 2> from;
        std::shared_ptr<const FramePictures> pictures;
    };

    void note_mirrors();
    void prepare_mirrors(const WantedFrame& frame, const Progress& progress);
    void prepare_programs(const WantedFrame& frame, const Progress& progress);
    void solve_light(std::size_t index,
                     const Scene& scene,
                     const SolveKey& key,
                     std::optional<Urgency> urgency,
                     const Progress& progress);
    std::shared_ptr<FinishedFrame> draw_picture(const WantedFrame& frame);
    Scene scene_of(const WantedFrame& frame, std::size_t side) const;
    /// Its passes, the correction's for the setup and this lane's device.
    FramePlan plan_side(const Scene& scene, std::size_t light, const ProjectorSetup& setup) const;
    void draw_side(const WantedFrame& frame, std::size_t side);
    void correct_side(const std::shared_ptr<const ProjectorSetup>& setup, std::size_t index);
    void measure_side(std::size_t index);
    void compose(const WantedFrame& frame);
    FramePlan told_plan(bool wiped);

    std::shared_ptr<GeometryCache> geometries_;
    const ShadingDevice device_;  ///< not automatic
    std::unique_ptr<DrivePath> path_;

    struct Solved {
        std::unique_ptr<RadianceRenderer> renderer;
        std::optional<FramePlan> untold;            ///< milliseconds that no frame's plan told yet
        std::optional<std::size_t> covered_pixels;  ///< as corrections ask
    };
    std::array<Solved, 2> lights_;
    SolveKeys solved_;
    SolvedMirrors mirrors_;
    bool prepared_ = false;
    std::vector<PlannedPass> prepare_passes_;

    std::array<Side, 2> sides_;
    Composed composed_;
};

}  // namespace livery
