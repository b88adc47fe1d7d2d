#include "studio/results.h"

#include "gl/window.h"

namespace livery {

namespace {

std::shared_ptr<const ProjectorPicture> picture_of(
    const std::shared_ptr<const FinishedFrame>& frame) {
    auto picture = std::make_shared<ProjectorPicture>();
    picture->number = frame->number;
    picture->texture = frame->drive_texture;
    picture->size_px = frame->size_px;
    picture->ready = frame->ready;
    picture->owner = frame;
    picture->fade_s = frame->fade_s;
    return picture;
}

}  // namespace

void Results::take(std::shared_ptr<const FinishedFrame> finished) {
    trace_->write("frame-done", finished->number, finished->problem);
    {
        const std::lock_guard lock(mutex_);
        frame_ = finished;
        if (finished->problem.empty()) {
            drawn_ = std::move(finished);
            if (!instead_) present_locked();
        }
    }
    wake_main_thread();
}

void Results::take(std::shared_ptr<const PreviewPicture> finished) {
    {
        const std::lock_guard lock(mutex_);
        preview_ = std::move(finished);
    }
    wake_main_thread();
}

void Results::shown(const ShownPicture& picture) const {
    trace_->write("shown", picture.number, {}, picture.at);
    wake_main_thread();
}

void Results::use(ProjectorScreen* screen) {
    const std::lock_guard lock(mutex_);
    projector_ = screen;
    present_locked();
}

void Results::show_instead(std::shared_ptr<const ProjectorPicture> picture) {
    const std::lock_guard lock(mutex_);
    instead_ = std::move(picture);
    present_locked();
}

void Results::present_locked() {
    if (!projector_) return;
    if (instead_) {
        projector_->present(instead_);
    } else if (drawn_) {
        projector_->present(picture_of(drawn_));
    }
}

bool Results::awaits_projector() const {
    const std::lock_guard lock(mutex_);
    if (!projector_ || instead_ || !drawn_) return false;
    return projector_->state() == ProjectorScreen::State::showing && !projector_->is_black() &&
           !projector_->is_frozen() && projector_->shown().number < drawn_->number;
}

std::shared_ptr<const FinishedFrame> Results::newest_frame() const {
    const std::lock_guard lock(mutex_);
    return frame_;
}

std::shared_ptr<const FinishedFrame> Results::newest_drawn() const {
    const std::lock_guard lock(mutex_);
    return drawn_;
}

std::shared_ptr<const PreviewPicture> Results::newest_preview() const {
    const std::lock_guard lock(mutex_);
    return preview_;
}

void Results::clear() {
    const std::lock_guard lock(mutex_);
    instead_.reset();
    frame_.reset();
    drawn_.reset();
    preview_.reset();
}

}  // namespace livery
