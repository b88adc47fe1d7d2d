// What a capture is made with: a camera of any kind, and the simulated bench where it is one.
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

/// As people write it: "bench" or "bench:NAME|FILE", "tethered" (the first on USB) or
/// "tethered:PORT", "video:N|FILE|ADDRESS", "folder:DIR".
struct CameraChoice {
    enum class Kind { bench, tethered, video, folder };
    Kind kind = Kind::bench;
    std::string what;  ///< behind the colon
    bool operator==(const CameraChoice&) const = default;
};
/// Throws std::invalid_argument that says what there is.
CameraChoice parse_camera_choice(const std::string& text);
std::string text_of(const CameraChoice& choice);
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
std::vector<ListedCamera> list_cameras();
std::vector<ListedCamera> found_cameras();  ///< the same without simulated benches

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
