#include "jobs/calibrate/nudged_calibration.h"

#include "core/error.h"
#include "core/utc.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/calibration_origin.h"
#include "scene/nudge.h"

namespace livery {

std::string write_nudged(const std::filesystem::path& from,
                         const std::filesystem::path& to,
                         const View& projector,
                         const Bounds& mockup) {
    const auto before = projector_view_of(from);
    if (!before) {
        throw FileError(
            from / "projector.json", "", "nothing", "the projector's camera file: nothing to move");
    }
    View elsewhere = *before;
    elsewhere.view_from_world = projector.view_from_world;
    check_argument(elsewhere == projector, "a nudge moves the mock-up, not the projector's lens");
    const std::string moved = in_words(motion_between(*before, projector, mockup));
    ColourCalibration calibration = read_calibration(from);
    calibration.made_with += "; moved by hand: " + moved;
    calibration.created = utc_now();
    seal(calibration);
    auto origin = read_origin(from);
    write_setup(to, calibration, projector);
    if (!origin) return calibration.id;
    if (origin->room) {
        // camera from product = camera from projector * projector from product
        View& camera = origin->room->camera;
        camera.view_from_world =
            camera.view_from_world * inverse(before->view_from_world) * projector.view_from_world;
        origin->room->projector = projector;
        origin->room->warnings.push_back("moved by hand after it was found: " + moved);
    }
    write_origin(to, *origin);
    return calibration.id;
}

}  // namespace livery
