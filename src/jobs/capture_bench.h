// What a capture is made with: a camera of any kind with its curve, and the simulated bench.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/camera.h"
#include "core/bench_ports.h"
#include "core/progress.h"
#include "scene/product.h"
#include "twin/bench.h"

namespace livery {

/// The file of the curve that was fitted for this model; none: none was. Throws CameraFault.
std::optional<std::filesystem::path> kept_camera_curve(Camera& camera);

struct CameraCurve {
    std::filesystem::path file;  ///< a response file (docs/files.md)
    double residual = 0.0;       ///< as CameraResponse
};
/// Shows white at width x height, photographs it at other exposures, fits the curve, keeps it, and
/// reads the camera's 8-bit numbers with it from here on. Throws Refused where the camera gives RAW
/// or its photographs do not follow their exposures, FileError, and what the ports throw; the
/// camera then reads as before.
CameraCurve fit_camera_curve(
    Camera& camera, const BenchPorts& ports, int width, int height, const Progress& progress);

/// As people write it, kind and what is behind the colon: "bench" or "bench:NAME|FILE", "tethered"
/// (the first on USB) or "tethered:PORT", "video:N|FILE|ADDRESS", "folder:DIR".
struct CameraChoice {
    std::string kind = "bench";
    std::string what;
    bool operator==(const CameraChoice&) const = default;
};
/// Throws std::invalid_argument that says what there is.
CameraChoice parse_camera_choice(const std::string& text);
std::string text_of(const CameraChoice& choice);
/// "tethered[:PORT], ... or folder:DIR": all kinds.
std::string camera_usage();

/// What its callers must know of a kind of camera.
struct CameraTraits {
    bool is_by_hand = false;    ///< somebody photographs, and copies the files into a folder
    bool is_simulated = false;  ///< of a simulated bench, which has a projector of its own
};
/// Throws std::invalid_argument for a kind that there is not.
CameraTraits traits_of(const CameraChoice& choice);

/// Of a camera that no list can name, its address as people know it: "ptpip:HOST" or
/// "ptpip:HOST:PORT" of a still camera, "http://..." or "rtsp://..." of a network camera's video.
/// Throws std::invalid_argument that says what there is.
CameraChoice camera_at_address(const std::string& address);

/// A camera that could be chosen now.
struct ListedCamera {
    std::string choice;        ///< "video:0"
    std::string name;          ///< for people
    std::string problem, fix;  ///< why it cannot be used at the moment; empty: it can
};
std::vector<ListedCamera> list_cameras(bool with_simulated = true);

struct CaptureBench {
    std::string name;  ///< of the camera, in words
    std::unique_ptr<Bench> simulated;
    std::unique_ptr<Camera> camera;
    /// What its 8-bit numbers are read with, fitted before; none: sRGB, or it has no curve.
    std::optional<std::filesystem::path> curve;
    ShowPicture show;                        ///< of a simulated bench; empty: a projector is needed
    MeasureXyz measure_xyz;                  ///< of a simulated bench
    std::shared_ptr<const Product> product;  ///< a simulated bench's mock-up
};
/// Not for folders, which have no camera. `product`: the mock-up of a simulated bench; null: the
/// one that its file names. Throws CameraFault, FileError.
CaptureBench open_capture_bench(const CameraChoice& choice,
                                std::shared_ptr<const Product> product,
                                const Progress& progress);

}  // namespace livery
