#include "jobs/calibrate/bench_calibration.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "calibration/bench_session.h"
#include "capture/camera.h"
#include "core/error.h"
#include "core/time.h"
#include "jobs/captured_calibration.h"
#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

ImageF projector_irradiance(const Mesh& mesh, const View& projector, const Progress& progress) {
    constexpr int kSamplesPerPixel = 16;
    const Tracer tracer(mesh);
    const SurfaceMap map = build_surface_map(mesh, tracer, projector, kSamplesPerPixel, progress);
    const glm::dvec3 lamp = centre_in_world(projector);

    ImageF irradiance(projector.width, projector.height, 1);
    for (const Fragment& fragment : map.fragments) {
        const glm::dvec3 to_lamp = lamp - glm::dvec3(fragment.position_mm);
        const double distance2 = glm::dot(to_lamp, to_lamp);
        // The mean of the normals is shorter than the unit mean normal by their scatter.
        const double shorter = 1.0 / std::sqrt(1.0 + static_cast<double>(fragment.normal_variance));
        const double cosine =
            shorter * glm::dot(glm::dvec3(fragment.normal), to_lamp) / std::sqrt(distance2);
        irradiance.values[fragment.pixel] += static_cast<float>(
            static_cast<double>(fragment.coverage) * std::max(0.0, cosine) / distance2);
    }
    for (std::size_t i = 0; i < irradiance.values.size(); ++i) {
        const float coverage = map.coverage.values[i];
        irradiance.values[i] = coverage < 0.5f ? 0.0f : irradiance.values[i] / coverage;
    }
    return irradiance;
}

namespace {

/// Runs `work` with the bench's ports through the recording, which has no manifest.json until
/// somebody writes it anew.
CaptureSeconds run_recorded(Recording& recording,
                            const BenchPorts& bench,
                            const std::function<void(const BenchPorts&)>& work) {
    // Until it is made anew it is not a whole captures folder.
    std::error_code ignored;
    std::filesystem::remove(recording.folder() / "manifest.json", ignored);
    CaptureSeconds seconds;
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

}  // namespace

RoomPose find_room_for(const BenchPorts& ports,
                       const CalibrationSettings& settings,
                       const Progress& progress,
                       Recording* recording) {
    if (!recording) return find_room(ports, settings, progress);
    RoomPose room;
    const std::filesystem::path& folder = recording->folder();
    const CaptureSeconds seconds = run_recorded(*recording, ports, [&](const BenchPorts& kept) {
        room = find_room(kept, settings, progress, folder / "room.json");
    });
    room.seen.captured.camera = seconds.camera;
    room.seen.captured.projector = seconds.projector;
    recording->write_manifest(settings.width, settings.height, room.seen.kept);
    write_map(folder / "map.exr", room.seen.map);
    return room;
}

CalibrationSettings with_room(CalibrationSettings settings, const RoomPose& room) {
    settings.projector = room.geometry.projector;
    settings.map = room.seen.map;
    return settings;
}

CalibrationResult calibrate_through_ports(const BenchPorts& ports,
                                          CalibrationSettings settings,
                                          const Progress& progress,
                                          Recording* recording) {
    if (finds_room(settings)) {
        check_argument(!recording, "the room's photographs and the colours' have two recordings");
        RoomPose room = find_room_for(ports, settings, progress.part(0.0, 0.5));
        CalibrationResult result = calibrate_through_ports(
            ports, with_room(std::move(settings), room), progress.part(0.5, 1.0));
        result.room = std::move(room);
        return result;
    }
    double irradiance_seconds = 0.0;
    if (settings.projector && settings.product)
        settings.irradiance = timed(irradiance_seconds, [&] {
            return projector_irradiance(settings.product->mesh, *settings.projector, progress);
        });
    progress.check_stop();
    const int width = settings.width, height = settings.height;
    CalibrationResult result;
    if (recording) {
        const CaptureSeconds seconds = run_recorded(*recording, ports, [&](const BenchPorts& kept) {
            result = calibrate_live(kept, std::move(settings), progress);
        });
        result.captured.camera = seconds.camera;
        result.captured.projector = seconds.projector;
        recording->write_manifest(width, height, result.kept);
    } else {
        result = calibrate_live(ports, std::move(settings), progress);
    }
    result.predict_seconds += irradiance_seconds;
    return result;
}

CalibrationSettings settings_of(const BenchDescription& description,
                                std::shared_ptr<const Product> product) {
    const View& said = description.projector.view;
    CalibrationSettings settings;
    settings.made_with = "simulated bench " + description.name;
    settings.width = said.width;
    settings.height = said.height;
    settings.product = std::move(product);
    settings.data_sheets = description.data_sheets;
    (description.data_sheets ? settings.turned_as : settings.projector) = said;
    return settings;
}

}  // namespace livery
