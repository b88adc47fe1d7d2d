// A bench calibrated through its ports, simulated or real, as the demo, `livery capture`,
// `livery calibrate color` and the desktop do it, with everything kept.
#pragma once

#include <functional>
#include <memory>

#include "calibration/calibrate_live.h"
#include "capture/recording.h"
#include "core/image.h"
#include "core/progress.h"
#include "scene/product.h"
#include "scene/view.h"
#include "twin/bench.h"

namespace livery {

/// cos(theta) / distance^2 (1/mm^2) of the surface that each projector pixel lights, its mean over
/// the lit part of the pixel; one channel, 0 where the mesh covers less than half of the pixel.
ImageF projector_irradiance(const Mesh& mesh, const View& projector, const Progress& progress = {});

/// Shows the patterns, photographs them, solves, and predicts; before it find_room_for(), where
/// finds_room(). `recording`, if there is one, keeps the photographs of the colours and is
/// afterwards a captures folder with its manifest.json; not with a room to be found, and not for
/// photographs taken before. The photograph over which it fails (of another size, automatically
/// exposed) is dropped, so that the next run takes it anew, as are those of pictures that are not
/// known to have arrived (NothingShown); the others stay. Throws as find_room(), calibrate_live()
/// and Recording do, and CameraFault.
CalibrationResult calibrate_through_ports(const BenchPorts& ports,
                                          CalibrationSettings settings,
                                          const Progress& progress = {},
                                          Recording* recording = nullptr);

/// find_room(). The recording keeps its photographs, with what was found (`room.json`, `map.exr`).
RoomPose find_room_for(const BenchPorts& ports,
                       const CalibrationSettings& settings,
                       const Progress& progress,
                       Recording* recording = nullptr);
/// The settings after it: the colours alone are left.
CalibrationSettings with_room(CalibrationSettings settings, const RoomPose& room);

/// What is asked of a simulated bench: its pose and lenses are found from photographs and from what
/// its file's `data_sheets` say; a file without them says where everything stands.
CalibrationSettings settings_of(const BenchDescription& description,
                                std::shared_ptr<const Product> product);

}  // namespace livery
