#include "jobs/capture_run.h"

#include "calibration/nothing_shown.h"
#include "capture/camera.h"

namespace livery {
PortSeconds run_recorded(Recording& recording,
                         const BenchPorts& bench,
                         const std::function<void(const BenchPorts&)>& work) {
    // Until it is made anew it is not a whole captures folder.
    std::error_code ignored;
    std::filesystem::remove(recording.folder() / "manifest.json", ignored);
    PortSeconds seconds;
    BenchPorts ports = bench;
    ports.show = [&](const Image8& drive) { timed(seconds.projector, [&] { bench.show(drive); }); };
    ports.photograph = [&](double exposure_s) {
        return timed(seconds.camera, [&] { return bench.photograph(exposure_s); });
    };
    try {
        work(recording.ports(ports));
        return seconds;
    } catch (const CameraFault&) {
        recording.flush();  // There is no photograph to blame.
        throw;
    } catch (const NothingShown& nothing) {
        recording.drop_newest(nothing.pictures());
        throw;
    } catch (const Refused&) {
        recording.drop_last();
        throw;
    } catch (const FileError&) {
        recording.drop_last();
        throw;
    } catch (const Cancelled&) {
        recording.flush();
        throw;
    }
}

LiveResult calibrate_recorded(Recording& recording,
                              const BenchPorts& bench,
                              const LiveOptions& options,
                              const Progress& progress) {
    LiveResult result;
    const PortSeconds seconds = run_recorded(recording, bench, [&](const BenchPorts& ports) {
        result = calibrate_live(ports, options, progress);
    });
    result.camera_seconds = seconds.camera;
    result.projector_seconds = seconds.projector;
    recording.write_manifest(options.width, options.height, result.kept);
    return result;
}

}  // namespace livery
