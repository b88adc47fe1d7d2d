#include "jobs/capture_run.h"

#include "capture/camera.h"

namespace livery {

LiveResult calibrate_recorded(Recording& recording,
                              const BenchPorts& bench,
                              const LiveOptions& options,
                              const Progress& progress) {
    // Until it is made anew it is not a whole captures folder.
    std::error_code ignored;
    std::filesystem::remove(recording.folder() / "manifest.json", ignored);
    try {
        LiveResult result = calibrate_live(recording.ports(bench), options, progress);
        recording.write_manifest(options.width, options.height, result.kept);
        return result;
    } catch (const CameraFault&) {
        recording.flush();  // There is no photograph to blame.
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
