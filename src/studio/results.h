// What the threads leave for the main one, and the straight way of a finished frame to the
// projector.
#pragma once

#include <memory>
#include <mutex>

#include "live/frame_thread.h"
#include "live/preview_thread.h"
#include "projection/projector_screen.h"
#include "studio/window/trace.h"

namespace livery {

/// Must outlive the threads that deliver; the projector must outlive the frame thread.
struct Results {
    explicit Results(std::shared_ptr<Trace> where_to) : trace_(std::move(where_to)) {}

    // On the threads that finished something.
    void take(std::shared_ptr<const FinishedFrame> finished);
    void take(std::shared_ptr<const PreviewPicture> finished);
    void shown(const ShownPicture& picture) const;

    // Main thread.
    void use(ProjectorScreen* screen);  ///< null: none
    /// Shown instead of the frames; none: the frames again.
    void show_instead(std::shared_ptr<const ProjectorPicture> picture);
    /// The newest frame could be on the projector, and is not yet.
    bool awaits_projector() const;
    std::shared_ptr<const FinishedFrame> newest_frame() const;  ///< with its problem, if it has one
    std::shared_ptr<const FinishedFrame> newest_drawn() const;  ///< the last that could be drawn
    std::shared_ptr<const PreviewPicture> newest_preview() const;
    void clear();  ///< with a context of the share group current

  private:
    void present_locked();

    std::shared_ptr<Trace> trace_;
    mutable std::mutex mutex_;
    ProjectorScreen* projector_ = nullptr;
    std::shared_ptr<const ProjectorPicture> instead_;
    std::shared_ptr<const FinishedFrame> frame_, drawn_;
    std::shared_ptr<const PreviewPicture> preview_;
};

}  // namespace livery
