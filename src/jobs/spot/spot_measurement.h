// A folder of photographs of a spot of light on a translucent sample -> its radial profile, one
// file a colour channel.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/spot/spot_profile.h"
#include "core/progress.h"

namespace livery {

struct SpotMeasurementRequest {
    std::filesystem::path captures;  ///< a folder (docs/measuring.md)
    double eta = 1.5;                ///< the sample's index over that of air
    std::filesystem::path out;       ///< marble.csv: becomes marble-red.csv, -green and -blue
};

struct MeasuredChannel {
    std::string channel;         ///< "red", "green", "blue": the camera's
    std::filesystem::path file;  ///< written
    SpotProfile profile;
    std::string fit_command;  ///< what finds the medium of this channel
};

struct SpotMeasurement {
    std::vector<MeasuredChannel> channels;  ///< those in which the spot has light
    std::string fit_command;                ///< of all three channels at once; empty: one lacks
    double incidence_rad = 0.0;             ///< of the projector's light to the normal
    double view_rad = 0.0;                  ///< of the line of sight to the normal
    double best_view_rad = 0.0;             ///< the same where it leaves as in the mean
    double off_mirror_rad = 0.0;            ///< from it to where the surface mirrors the projector
    double reach_mm = 0.0;                  ///< from the spot to the picture's nearest edge
    double pixel_mm = 0.0;
    double shift_mm = 0.0;  ///< from the spot's middle on white to the light's on the sample
    std::size_t photographs = 0;
    std::vector<std::string> notes;
};

/// Writes the CSVs of docs/files.md, all or none. Throws FileError, Refused, std::invalid_argument
/// (a name that does not end in .csv, an index out of range), Cancelled.
SpotMeasurement measure_profile(const SpotMeasurementRequest& request,
                                const Progress& progress = {});

}  // namespace livery
