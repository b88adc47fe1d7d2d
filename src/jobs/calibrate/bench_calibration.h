// A bench calibrated through its ports, simulated or real, as the demo, `livery capture` and the
// desktop do it.
#pragma once

#include <optional>
#include <string>

#include "calibration/colour/colour.h"
#include "capture/recording.h"
#include "core/image.h"
#include "core/progress.h"
#include "jobs/calibrate/room_pose.h"
#include "scene/colour_calibration.h"
#include "scene/product.h"
#include "scene/view.h"
#include "twin/bench.h"

namespace livery {

struct BenchCalibration {
    std::optional<RoomPose> room;   ///< as found; nothing: the request said it, or nobody does
    ColourCalibration calibration;  ///< with what the camera does not see predicted from the pose
    LiveResult live;                ///< its own calibration is moved out
    std::optional<View> projector;  ///< where it stands; nothing: that is not known
    ImageF geometry;                ///< projector_irradiance() of the pose; empty: it is not known
    double predict_seconds = 0.0;
};

struct BenchCalibrationRequest {
    std::string made_with;  ///< projector and camera, in words
    int width = 0, height = 0;
    /// Where the projector stands, and the mock-up: it alone is then lit, and what the camera does
    /// not see is predicted. Both or none.
    std::optional<View> projector;
    std::shared_ptr<const Product> product;
    /// What is lit for the colours, one channel; empty: mockup_mask() of the two above.
    Image8 lit;
    PlaceCode places = PlaceCode::gray;  ///< what is shown to find where the camera sees them
    /// Where the projector is not known to stand, but its lens and the camera's are: the Gray code
    /// is photographed first and tells, with the mock-up's mesh (find_room).
    std::optional<DataSheets> data_sheets;
    std::optional<View> turned_as;  ///< how a sphere is turned, which its photographs do not tell
    /// Where the camera sees the projector's pixels, where that was photographed before.
    std::optional<ProjectorToCamera> map;
    std::optional<CameraToXyz> camera_to_xyz;
    int colour_shots = 2;  ///< photographs of each colour picture
    ColourMode mode = ColourMode::robust;
    /// What keeps the photographs that a room is found from, with what was found (`room.json`,
    /// `map.exr`); and those of the colours. Not for photographs taken before.
    Recording* room_recording = nullptr;
    Recording* recording = nullptr;
};

/// Whether where everything stands is to be found first.
bool finds_room(const BenchCalibrationRequest& request);
/// That stage alone. Throws as find_room().
RoomPose find_room_for(const BenchPorts& ports,
                       const BenchCalibrationRequest& request,
                       const Progress& progress);
/// The request after it: the colours alone are left.
BenchCalibrationRequest with_room(BenchCalibrationRequest request, const RoomPose& room);

/// What the pictures of this request are, where no pose is to be found; also what a preflight
/// needs.
LiveOptions live_options_of(const BenchCalibrationRequest& request);

/// Shows the patterns, photographs them, solves, and predicts. Throws as calibrate_live() and
/// calibrate_recorded().
BenchCalibration calibrate_through_ports(const BenchPorts& ports,
                                         const BenchCalibrationRequest& request,
                                         const Progress& progress);

/// What is asked of a simulated bench: its pose and lenses are found from photographs and from what
/// its file's `data_sheets` say; a file without them says where everything stands.
BenchCalibrationRequest request_of(const BenchDescription& description,
                                   std::shared_ptr<const Product> product);
/// calibrate_through_ports() with that.
BenchCalibration calibrate_through_ports(Bench& bench,
                                         std::shared_ptr<const Product> product,
                                         const Progress& progress);

}  // namespace livery
