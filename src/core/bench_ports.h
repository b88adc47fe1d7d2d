// The three things that a calibration may ask of the world, real or simulated.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "core/pictures/exposure_settings.h"

namespace livery {

/// A photograph's file as a camera gave it: RAW, JPEG.
struct CameraFile {
    std::string name;  ///< with its ending
    std::vector<unsigned char> bytes;
};

/// One photograph in the camera's own units.
struct Photograph {
    ImageF image;  ///< RGB, file units, before black subtraction
    double exposure_s = 1.0;
    double black_level = 0.0;                                       ///< file units
    double saturates_at = std::numeric_limits<double>::infinity();  ///< file units
    ExposureSettings settings;  ///< as its file tells; `exposure_s` is what counts
    std::string name;           ///< file name or pattern role, for messages
    double taken_at = -1.0;     ///< when, in photographs; negative: in the order in which they come
    std::shared_ptr<const CameraFile> file;  ///< what `image` was read from; null: nothing else
    /// Files of a recording that it was kept in: one, or of a mean all.
    std::vector<std::string> kept_as;
};

/// File units: what is brighter counts as saturated.
inline double saturation_limit(const Photograph& photograph) {
    return photograph.black_level + 0.98 * (photograph.saturates_at - photograph.black_level);
}

/// Linear camera colour per second: (value - black_level) / exposure_s.
inline double linear_from_file_units(const Photograph& photograph, double value) {
    return (value - photograph.black_level) / photograph.exposure_s;
}

/// Shows device values (RGB, 8 bit, the projector's resolution); returns when they are visible.
using ShowPicture = std::function<void(const Image8& drive)>;

/// Photographs what is shown; exposure 0 asks the camera to keep its last exposure.
using TakePhotograph = std::function<Photograph(double exposure_s)>;

/// Turns to the photographs of the picture called `role` (docs/files.md) and says how many there
/// are; `photograph` then answers with one after the other. Throws FileError where there is none.
using TurnToRole = std::function<int(const std::string& role)>;

/// A colorimeter at the eye point, aimed at the point of the mock-up that projector pixel
/// `pixel_in_projector` lights: absolute XYZ of the light that the mock-up sends to the eye there.
using MeasureXyz = std::function<glm::dvec3(glm::dvec2 pixel_in_projector)>;

/// Told what the next photograph is to show ("gray-column-3", "white at half the exposure").
using AnnouncePicture = std::function<void(const std::string& what)>;

struct BenchPorts {
    ShowPicture show;
    TakePhotograph photograph;
    MeasureXyz measure_xyz;    ///< may be empty: no colorimeter at hand
    AnnouncePicture announce;  ///< may be empty: nobody wants to know
    /// Not empty where the photographs are what they are, taken by somebody else: in a folder, or
    /// with a camera that the program has no hold of. None can be repeated, the exposures are those
    /// that they have, and each is known to show the picture that it is said to show.
    TurnToRole turn_to;
};

/// What a capture waits for that somebody can put right; empty `why`: for nothing any more.
struct CaptureWait {
    std::string why, fix;
};
using TellWait = std::function<void(const CaptureWait&)>;

}  // namespace livery
