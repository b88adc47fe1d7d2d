// A bench calibrated through its ports, simulated or real, as the demo, `livery capture` and the
// desktop do it.
#pragma once

#include <optional>
#include <string>

#include "calibration/colour/colour.h"
#include "capture/recording.h"
#include "core/image.h"
#include "core/progress.h"
#include "jobs/room_pose.h"
#include "scene/colour_calibration.h"
#include "scene/product.h"
#include "scene/view.h"
#include "twin/bench.h"

namespace livery {

struct BenchCalibration {
    /// Where the projector was found to stand; not where the request said it.
    std::optional<RoomPose> room;
    ColourCalibration calibration;  ///< with what the camera does not see predicted from the pose
    LiveResult live;                ///< its own calibration is moved out
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
    PlaceCode places = PlaceCode::gray;  ///< what is shown to find where the camera sees them
    /// Where the camera sees the projector's pixels, where that was photographed before.
    std::optional<ProjectorToCamera> map;
    std::optional<CameraToXyz> camera_to_xyz;
    Recording* recording = nullptr;  ///< keeps everything in it; not for photographs taken before
};

/// What the pictures of this request are; also what a preflight needs.
LiveOptions live_options_of(const BenchCalibrationRequest& request);

/// Shows the patterns, photographs them, solves, and predicts. Throws as calibrate_live() and
/// calibrate_recorded().
BenchCalibration calibrate_through_ports(const BenchPorts& ports,
                                         const BenchCalibrationRequest& request,
                                         const Progress& progress);

/// The same on a simulated bench, whose pose and lenses are first found from photographs and from
/// what its file's `data_sheets` say; a file without them says where everything stands. The turn of
/// a sphere, which its photographs do not tell, is the file's.
BenchCalibration calibrate_through_ports(Bench& bench,
                                         std::shared_ptr<const Product> product,
                                         const Progress& progress);

}  // namespace livery
