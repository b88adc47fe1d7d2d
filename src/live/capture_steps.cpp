#include "live/capture_steps.h"

#include <stdexcept>

#include "core/error.h"
#include "core/log.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/calibration_origin.h"
#include "jobs/calibrate/calibration_versions.h"
#include "scene/mockup_mask.h"

namespace livery {

CaptureView::Doing doing_of(CaptureStep step) {
    switch (step) {
        case CaptureStep::look:
            return CaptureView::Doing::preflight;
        case CaptureStep::geometry:
        case CaptureStep::colour:
            return CaptureView::Doing::capturing;
        case CaptureStep::check:
            return CaptureView::Doing::checking;
    }
    throw std::invalid_argument("unknown step");
}

CaptureStep photographed_last(const CaptureView& view) {
    return view.doing_step == CaptureStep::geometry ? CaptureStep::geometry : CaptureStep::colour;
}

bool asks_for_the_same(const BenchCalibrationRequest& a, const BenchCalibrationRequest& b) {
    return a.made_with == b.made_with && a.width == b.width && a.height == b.height &&
           a.projector == b.projector && a.product == b.product && a.data_sheets == b.data_sheets &&
           a.turned_as == b.turned_as && a.places == b.places;
}

std::vector<GradedFigure> compared_with(const std::filesystem::path& kept,
                                        const StagedCalibration& run) {
    if (kept.empty() || !run.made || !run.made->projector) return {};
    try {
        const auto projector = projector_view_of(kept);
        if (!projector) return {};
        return grade_figures(compare_calibrations(read_calibration(kept),
                                                  *projector,
                                                  run.made->calibration,
                                                  *run.made->projector,
                                                  run.request.product->mesh));
    } catch (const FileError& error) {
        log_line(LogLevel::warning, error.what());  // One that is gone is no fault of the new one.
    } catch (const Refused& refused) {
        log_line(LogLevel::warning, refused.what());
    } catch (const std::invalid_argument& other_size) {
        log_line(LogLevel::warning, other_size.what());
    }
    return {};
}

DriftSource drift_source(const std::filesystem::path& calibration, const Product& product) {
    const char* const fix = "calibrate with a camera first: what it photographs last is kept";
    if (calibration.empty()) throw Refused("no calibration is in use", fix);
    const auto origin = read_origin(calibration);
    const auto projector = projector_view_of(calibration);
    if (!origin || !origin->ends || !projector)
        throw Refused("the calibration in use keeps no photographs of how the bench was", fix);
    return {*origin->ends, mockup_mask(product.mesh, *projector)};
}

}  // namespace livery
