#include "calibration/registration/pair_pose.h"
#include "core/error.h"
#include "core/paths.h"
#include "jobs/pair_geometry.h"

namespace livery {

namespace {

constexpr int kFormatVersion = 1;

Json matrix_of(const View& view) {
    return {view.focal_px.x,
            0.0,
            view.principal_px.x - 0.5,
            0.0,
            view.focal_px.y,
            view.principal_px.y - 0.5,
            0.0,
            0.0,
            1.0};
}

}  // namespace

Json figures_of(const PairGeometry& geometry) {
    const auto or_null = [&](double value) {
        return geometry.from_boards ? Json(value) : Json(nullptr);
    };
    Json poses = Json::array();
    for (const BoardPose& pose : geometry.poses)
        poses.push_back({{"folder", pose.folder},
                         {"used", pose.used},
                         {"reason", pose.reason},
                         {"corners", pose.corners},
                         {"edge_px", pose.edge_px},
                         {"moved_px", pose.moved_px},
                         {"rms_px", pose.used ? Json(pose.rms_px) : Json(nullptr)}});
    const Rigid3& pair = geometry.projector.view_from_world;
    return {{"made_from", geometry.from_boards ? "boards" : "data sheets"},
            {"camera_rms_px", or_null(geometry.camera_rms_px)},
            {"projector_rms_px", or_null(geometry.projector_rms_px)},
            {"stereo_rms_px", geometry.stereo_rms_px},
            {"held_out_rms_px", or_null(geometry.held_out_rms_px)},
            {"camera_matrix", matrix_of(geometry.camera)},
            {"camera_distortion", geometry.camera.distortion},
            {"camera_standard_error_px", geometry.camera_standard_error_px},
            {"projector_matrix", matrix_of(geometry.projector)},
            {"projector_distortion", geometry.projector.distortion},
            {"projector_standard_error_px", geometry.projector_standard_error_px},
            {"pair_turn_standard_error_rad", geometry.turn_standard_error_rad},
            {"pair_shift_standard_error_mm", geometry.shift_standard_error_mm},
            {"rotation", json_from(pair.rotation)},
            {"translation_mm", json_from(pair.translation)},
            {"poses", poses},
            {"warnings", geometry.warnings},
            {"refused", Json::array()}};
}

void write_pair_geometry(const std::filesystem::path& folder, const PairGeometry& geometry) {
    make_output_folder(folder);
    write_camera_file(folder / "camera.json", geometry.camera);
    write_camera_file(folder / "projector.json", geometry.projector);
    Json json = figures_of(geometry);
    json.erase("refused");
    if (geometry.from_boards) json["information"] = geometry.information;
    json["format_version"] = kFormatVersion;
    json["kind"] = "geometry";
    write_json_file(folder / "geometry.json", json);
}

LensPrior parse_lens_prior(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.require_format_version(kFormatVersion);
    root["kind"].one_of({"geometry"});
    for (const char* matrix : {"camera_matrix", "projector_matrix", "rotation"})
        root[matrix].numbers(9);
    for (const char* lens : {"camera_distortion", "projector_distortion"}) root[lens].numbers(5);
    root["translation_mm"].numbers(3);
    root["stereo_rms_px"].number_between(0.0, 1e6);
    if (root["made_from"].one_of({"boards", "data sheets"}) == 1) return data_sheet_prior();
    LensPrior prior;
    if (!root.has("information")) return prior;
    const std::vector<double> values = root["information"].numbers(PairInformation{}.size());
    PairInformation& information = prior.boards.emplace_back();
    std::copy(values.begin(), values.end(), information.begin());
    if (!is_information(information))
        root["information"].fail("a matrix that is none",
                                 "an inverse covariance: symmetric, not negative");
    return prior;
}

void check_geometry_file(const std::filesystem::path& file) {
    parse_lens_prior(read_text_file(file), file);
}

LensPrior lens_prior_of(const std::vector<std::filesystem::path>& folders) {
    LensPrior first;
    std::vector<PairInformation> boards;
    for (const std::filesystem::path& folder : folders) {
        const auto file = folder / "geometry.json";
        std::error_code error;
        const LensPrior prior = std::filesystem::exists(file, error)
                                    ? parse_lens_prior(read_text_file(file), file)
                                    : LensPrior{};
        if (&folder == &folders.front()) first = prior;
        boards.insert(boards.end(), prior.boards.begin(), prior.boards.end());
    }
    // Where one of them does not say, none is taken for another
    first.boards = boards.size() == folders.size() ? boards : std::vector<PairInformation>{};
    return first;
}

}  // namespace livery
