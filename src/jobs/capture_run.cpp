#include "jobs/capture_run.h"

#include <chrono>

#include "calibration/nothing_shown.h"
#include "capture/camera.h"

namespace livery {
namespace {

/// Adds the seconds that a call takes.
template <typename Call>
auto timed(double& seconds, const Call& call) {
    const auto start = std::chrono::steady_clock::now();
    struct Add {
        double& seconds;
        std::chrono::steady_clock::time_point start;
        ~Add() {
            seconds +=
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        }
    } add{seconds, start};
    return call();
}

}  // namespace

LiveResult calibrate_recorded(Recording& recording,
                              const BenchPorts& bench,
                              const LiveOptions& options,
                              const Progress& progress) {
    // Until it is made anew it is not a whole captures folder.
    std::error_code ignored;
    std::filesystem::remove(recording.folder() / "manifest.json", ignored);
    double camera_s = 0.0, projector_s = 0.0;
    BenchPorts ports = bench;
    ports.show = [&](const Image8& drive) { timed(projector_s, [&] { bench.show(drive); }); };
    ports.photograph = [&](double exposure_s) {
        return timed(camera_s, [&] { return bench.photograph(exposure_s); });
    };
    try {
        LiveResult result = calibrate_live(recording.ports(ports), options, progress);
        result.camera_seconds = camera_s;
        result.projector_seconds = projector_s;
        recording.write_manifest(options.width, options.height, result.kept);
        return result;
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

}  // namespace livery
