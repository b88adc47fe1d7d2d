// The mock-up scanned and registered from files: what `livery calibrate scan` and `livery calibrate
// register` do.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/correspondence/fringe_decode.h"
#include "calibration/registration/picked_points.h"
#include "calibration/registration/register_scan.h"
#include "calibration/scan/scan_planes.h"
#include "core/progress.h"
#include "scene/mockup_pose.h"
#include "scene/product.h"

namespace livery {

/// Lenses and poses of a camera and a projector, in one frame.
struct CalibratedPair {
    View camera, projector;
};

/// `camera.json` and `projector.json` of a geometry's calibration. Throws FileError.
CalibratedPair read_calibrated_pair(const std::filesystem::path& folder);

/// Structured light seen from one position of the camera or more.
struct ScannedLight {
    View projector;  ///< world: the first camera's calibration's
    std::vector<Sight> sights;
    /// One a sight: direct light and what comes over other parts; empty pictures without fringes.
    std::vector<SeparatedLight> separated;
    std::vector<std::string> warnings;
};

/// Decodes Gray code photographs, a folder a position of the camera; `calibrations` is one folder
/// for all, or one for each, `patterns_manifest` says what folders without a manifest show (empty:
/// the usual 42 pictures). The projector stands where it stood, so it joins the positions. Throws
/// FileError, Refused, std::invalid_argument.
ScannedLight decode_light(const std::vector<std::filesystem::path>& captures,
                          const std::vector<std::filesystem::path>& calibrations,
                          const std::filesystem::path& patterns_manifest = {},
                          const Progress& progress = {});

struct ScanFiles {
    Mesh surface;            ///< product frame: millimetres, y up in the camera's picture
    View projector, camera;  ///< world: that frame
    Scan scan;
    RemovedPlanes removed;
    double spacing_mm = 0.0;
};

/// The scan as a product: its frame has its origin in the scan's middle, x to the camera's right, y
/// up in its picture, z toward it. Neighbouring vertices are about `spacing_mm` apart, or as far as
/// the projector's pixels. `without_planes`: as remove_planes().
ScanFiles scan_product(const ScannedLight& light,
                       double spacing_mm,
                       int without_planes,
                       const Progress& progress = {});

/// Writes `scan.ply`, `projector.json` and `camera.json`. Throws FileError.
void write_scan(const std::filesystem::path& folder, const ScanFiles& scan);

/// Writes `direct.exr` and `global.exr`, one channel in the units of the photograph of white, NaN
/// where nothing is known; of further positions `direct-2.exr` and so on. Says whether there was
/// anything to write: without fringes there is not. Throws FileError.
bool write_separated_light(const std::filesystem::path& folder, const ScannedLight& light);

/// In which picture points were picked.
enum class PickView { either, camera, projector };

struct RegistrationRequest {
    std::shared_ptr<const Product> product;
    std::string product_name;                     ///< as it was given
    std::vector<std::filesystem::path> captures;  ///< empty: points alone
    std::filesystem::path patterns_manifest;      ///< of captures without a manifest of their own
    std::filesystem::path points;                 ///< empty: captures alone
    std::vector<std::filesystem::path> calibrations;
    PickView pick_view = PickView::either;
    bool scale_free = false;
    bool lens_fixed = false;
};

struct RegisteredMockup {
    MockupPose pose;
    View camera, projector;  ///< world: the product's frame
    std::optional<Registration> by_scan;
    std::optional<PickedPose> by_points;
    double held_px = 0.0;   ///< by_points: as held_px() of the projector's picture
    std::string picked_in;  ///< "camera" or "projector"
    std::vector<MeshPick> points;
};

/// From points, from captures, or from captures that begin with points. Points whose view is not
/// said are taken in the one whose lens they fit. Throws FileError, Refused.
RegisteredMockup register_mockup(const RegistrationRequest& request, const Progress& progress = {});

/// Writes `camera.json`, `projector.json` and, last, `pose.json`. Throws FileError.
void write_registration(const std::filesystem::path& folder, const RegisteredMockup& mockup);

}  // namespace livery
