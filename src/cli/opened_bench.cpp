#include "cli/opened_bench.h"

#include "capture/patient_camera.h"

namespace livery {

OpenedBench open_bench(const std::string& camera,
                       const std::string& monitor,
                       std::shared_ptr<const Product> product,
                       const Progress& progress) {
    const CameraChoice choice = parse_camera_choice(camera);
    if (choice.kind == CameraChoice::Kind::folder)
        throw std::invalid_argument("--camera: found a folder, expected a camera");
    OpenedBench opened;
    opened.bench = open_capture_bench(choice, std::move(product), progress);
    opened.ports.show = opened.bench.show;
    if (!opened.ports.show) {
        if (monitor.empty())
            throw std::invalid_argument(
                "--monitor: found none, expected the projector's (livery capture --list)");
        opened.projector = std::make_unique<MonitorProjector>(monitor);
        opened.ports.show = opened.projector->port(progress);
    }
    opened.ports.photograph = patient(*opened.bench.camera, progress, say_wait);
    return opened;
}

}  // namespace livery
