#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "scene/pose_io.h"
#include "twin/description.h"

namespace livery {

namespace {

constexpr int kNewestVersion = 1;
constexpr double kDegrees = std::numbers::pi / 180.0;

/// A name in a bench file: beside it, or among the shipped benches' files.
std::filesystem::path file_beside(const std::filesystem::path& bench, const std::string& name) {
    const auto beside = bench.parent_path() / name;
    std::error_code error;
    if (std::filesystem::is_regular_file(beside, error)) return beside;
    return shipped_path(std::filesystem::path("calibration") / name);
}

/// The rotation that turns world to view so that `at_mm` appears in direction `toward` of the view
/// and the world's up stays up in the picture.
glm::dmat3 aimed_rotation(const glm::dvec3& from_mm,
                          const glm::dvec3& at_mm,
                          const glm::dvec3& toward) {
    const glm::dvec3 z = glm::normalize(at_mm - from_mm);
    const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0.0, 1.0, 0.0)));
    const glm::dvec3 y = glm::cross(z, x);
    const glm::dmat3 axis_from_world = glm::transpose(glm::dmat3(x, y, z));

    // The axis (0, 0, 1) is pitched, then turned, into `toward`.
    const double slope_y = toward.y / std::hypot(toward.x, toward.z);
    const double pitch = std::atan(slope_y), turn = std::atan2(toward.x, toward.z);
    const glm::dmat3 pitched(1.0,
                             0.0,
                             0.0,  //
                             0.0,
                             std::cos(pitch),
                             -std::sin(pitch),
                             0.0,
                             std::sin(pitch),
                             std::cos(pitch));
    const glm::dmat3 turned(std::cos(turn),
                            0.0,
                            -std::sin(turn),  //
                            0.0,
                            1.0,
                            0.0,
                            std::sin(turn),
                            0.0,
                            std::cos(turn));
    return turned * pitched * axis_from_world;
}

/// A camera file's fields, or `from_mm` and `at_mm` (with `at_px`) in the place of the pose.
View read_view(const JsonReader& json) {
    View view;
    view.width = json["width"].integer(2, 16384);
    view.height = json["height"].integer(2, 16384);
    read_lens(json, view);
    const bool posed = json.has("rotation") || json.has("translation_mm");
    const bool aimed = json.has("from_mm") || json.has("at_mm");
    if (posed == aimed) {
        json.fail(posed ? "two poses" : "no pose",
                  "either rotation and translation_mm, or from_mm and at_mm");
    }
    Rigid3& pose = view.view_from_world;
    if (posed) {
        pose = read_pose(json);
        return view;
    }
    const glm::dvec3 from = place_mm(json["from_mm"]), at = place_mm(json["at_mm"]);
    const glm::dvec3 line = at - from;
    if (std::hypot(line.x, line.z) < 1e-6 * std::max(1.0, glm::length(line))) {
        json["from_mm"].fail("a place straight above, below or at at_mm", "a place beside it");
    }
    glm::dvec3 toward(0.0, 0.0, 1.0);
    if (json.has("at_px")) {
        const auto pixel = numbers_between(json["at_px"], 2, -1e6, 1e6);
        try {
            toward = ray_through(view, glm::dvec2(pixel[0], pixel[1]) + 0.5).direction;
        } catch (const std::invalid_argument&) {
            json["at_px"].fail(json["at_px"].found(),
                               "a pixel that light reaches through this lens");
        }
    }
    pose.rotation = aimed_rotation(from, at, toward);
    pose.translation = -(pose.rotation * from);
    return view;
}

/// "file.csv" (its first column) or "file.csv#column".
Spectrum read_column(const JsonReader& json) {
    const std::string text = json.text();
    const auto hash = text.find('#');
    const auto file = file_beside(json.file(), text.substr(0, hash));
    const SpectrumTable table = read_spectra_csv(file);
    if (hash == std::string::npos) return table.columns.front();
    const std::string column = text.substr(hash + 1);
    const auto found = std::find(table.names.begin(), table.names.end(), column);
    if (found == table.names.end()) {
        std::string names;
        for (const auto& name : table.names) names += (names.empty() ? "" : ", ") + name;
        json.fail("the column '" + column + "'", "one of " + names + " in " + file.string());
    }
    return table.columns[static_cast<std::size_t>(found - table.names.begin())];
}

Spectrum read_reflectance(const JsonReader& json) {
    Spectrum reflectance;
    if (json.is_number()) {
        reflectance.fill(json.number_between(0.0, 1.0));
        return reflectance;
    }
    if (json.text() == "grey-spray-paint") return grey_spray_paint();
    reflectance = read_column(json);
    const double largest = *std::max_element(reflectance.begin(), reflectance.end());
    if (largest > 1.0) json.fail("a reflectance of " + std::to_string(largest), "at most 1");
    return reflectance;
}

Spectrum read_ambient_spectrum(const JsonReader& json) {
    const std::string name = json.text();
    if (name == "D65") return illuminant_d65();
    if (name == "white-led") return white_led();
    return read_column(json);
}

/// The three columns R, G, B of a file, and `clear` where there is one.
SpectrumTable read_rgb_table(const JsonReader& json) {
    const auto file = file_beside(json.file(), json.text());
    SpectrumTable table = read_spectra_csv(file);
    const bool rgb = table.names.size() >= 3 && table.names[0] == "R" && table.names[1] == "G" &&
                     table.names[2] == "B";
    if (!rgb) throw FileError(file, "header", "other columns", "R, G, B after the wavelength");
    return table;
}

ProjectorSpectra read_primaries(const JsonReader& json) {
    const std::string name = json.text();
    if (name == "uhp") return uhp_projector();
    if (name == "led") return led_projector();
    const SpectrumTable table = read_rgb_table(json);
    ProjectorSpectra spectra;
    std::copy_n(table.columns.begin(), 3, spectra.primaries.begin());
    for (std::size_t k = 0; k < spectra.clear.size(); ++k) {
        spectra.clear[k] = table.columns.size() > 3
                               ? table.columns[3][k]
                               : table.columns[0][k] + table.columns[1][k] + table.columns[2][k];
    }
    return spectra;
}

void read_number(const JsonReader& json, const char* key, double low, double high, double& value) {
    if (json.has(key)) value = json[key].number_between(low, high);
}

void read_integer(const JsonReader& json, const char* key, int low, int high, int& value) {
    if (json.has(key)) value = json[key].integer(low, high);
}

ProjectorDescription read_projector(const JsonReader& json) {
    json.allow_only({"width",
                     "height",
                     "matrix",
                     "distortion",
                     "rotation",
                     "translation_mm",
                     "from_mm",
                     "at_mm",
                     "at_px",
                     "primaries",
                     "gamma",
                     "s_curve",
                     "gamma_spread",
                     "leak",
                     "white_segment",
                     "vignetting",
                     "defocus_sigma_px",
                     "flicker",
                     "drift_per_photograph",
                     "latency_photographs"});
    ProjectorDescription projector;
    projector.view = read_view(json);
    if (json.has("primaries")) projector.spectra = read_primaries(json["primaries"]);
    if (json.has("gamma")) {
        const auto gamma = json["gamma"];
        for (int k = 0; k < 3; ++k) {
            projector.gamma[k] =
                gamma.is_array() ? (gamma.numbers(3),
                                    gamma.at(static_cast<std::size_t>(k)).number_between(0.2, 5.0))
                                 : gamma.number_between(0.2, 5.0);
        }
    }
    read_number(json, "s_curve", 0.0, 1.0, projector.s_curve);
    read_number(json, "gamma_spread", -0.5, 0.5, projector.gamma_spread);
    read_number(json, "leak", 0.0, 0.5, projector.leak);
    read_number(json, "white_segment", 0.0, 5.0, projector.white_segment);
    read_number(json, "vignetting", 0.0, 0.95, projector.vignetting);
    read_number(json, "defocus_sigma_px", 0.0, 20.0, projector.defocus_sigma_px);
    read_number(json, "flicker", 0.0, 0.3, projector.flicker);
    read_number(json, "drift_per_photograph", -0.1, 0.1, projector.drift_per_photograph);
    read_integer(json, "latency_photographs", 0, 100, projector.latency_photographs);
    return projector;
}

CameraDescription read_camera(const JsonReader& json) {
    json.allow_only({"width",
                     "height",
                     "matrix",
                     "distortion",
                     "rotation",
                     "translation_mm",
                     "from_mm",
                     "at_mm",
                     "at_px",
                     "sensitivities",
                     "encoding",
                     "exposure_s",
                     "metered_peak",
                     "sensitivity_units_per_s",
                     "black_level_units",
                     "electrons_per_unit",
                     "read_noise_units",
                     "vignetting",
                     "flare",
                     "flare_radius",
                     "shift_px",
                     "shift_photographs"});
    CameraDescription camera;
    camera.view = read_view(json);
    const SpectrumTable table = read_rgb_table(json["sensitivities"]);
    std::copy_n(table.columns.begin(), 3, camera.sensitivities.begin());
    if (json.has("encoding")) {
        const std::string name = json["encoding"].text();
        if (name != "raw14" && name != "srgb8")
            json["encoding"].fail("'" + name + "'", "raw14 or srgb8");
        camera.encoding = name == "raw14" ? CameraEncoding::raw14 : CameraEncoding::srgb8;
    }
    read_number(json, "exposure_s", 0.0, 3600.0, camera.exposure_s);
    read_number(json, "metered_peak", 0.1, 4.0, camera.metered_peak);
    read_number(json, "sensitivity_units_per_s", 1.0, 1e9, camera.sensitivity_units_per_s);
    read_number(json, "black_level_units", 0.0, 8192.0, camera.black_level_units);
    read_number(json, "electrons_per_unit", 0.0, 1e6, camera.electrons_per_unit);
    read_number(json, "read_noise_units", 0.0, 1000.0, camera.read_noise_units);
    read_number(json, "vignetting", 0.0, 0.95, camera.vignetting);
    read_number(json, "flare", 0.0, 0.5, camera.flare);
    read_number(json, "flare_radius", 0.02, 1.0, camera.flare_radius);
    read_number(json, "shift_px", 0.0, 20.0, camera.shift_px);
    read_integer(json, "shift_photographs", 1, 100'000, camera.shift_photographs);
    return camera;
}

SurfaceDescription read_surface(const JsonReader& entry) {
    SurfaceDescription surface;
    surface.reflectance = read_reflectance(entry["reflectance"]);
    read_number(entry, "second_share", 0.0, 1.0, surface.second_share);
    read_number(entry, "pattern_mm", 0.1, 10'000.0, surface.pattern_mm);
    if (surface.second_share > 0.0 || entry.has("second")) {
        surface.second = read_reflectance(entry["second"]);
    }
    return surface;
}

std::map<std::string, SurroundingDescription> read_surroundings(const JsonReader& json) {
    std::map<std::string, SurroundingDescription> surroundings;
    for (const auto& name : json.keys()) {
        const auto entry = json[name];
        entry.allow_only({"reflectance",
                          "second",
                          "second_share",
                          "pattern_mm",
                          "corner_mm",
                          "side_a_mm",
                          "side_b_mm"});
        SurroundingDescription one;
        one.surface = read_surface(entry);
        one.corner_mm = place_mm(entry["corner_mm"]);
        one.side_a_mm = place_mm(entry["side_a_mm"]);
        one.side_b_mm = place_mm(entry["side_b_mm"]);
        const double area = glm::length(glm::cross(one.side_a_mm, one.side_b_mm));
        if (!(area > 1e-6)) {
            entry.fail("a rectangle of " + std::to_string(area) + " mm2",
                       "two sides that span a rectangle");
        }
        surroundings[name] = one;
    }
    return surroundings;
}

MockupDescription read_mockup(const JsonReader& json) {
    json.allow_only(
        {"surfaces", "diffuse_sigma_deg", "sheen_f0", "sheen_alpha", "interreflection"});
    MockupDescription mockup;
    const auto surfaces = json["surfaces"];
    for (const auto& part : surfaces.keys()) {
        const auto entry = surfaces[part];
        entry.allow_only({"reflectance", "second", "second_share", "pattern_mm"});
        mockup.surfaces[part] = read_surface(entry);
    }
    double sigma_deg = 0.0;
    read_number(json, "diffuse_sigma_deg", 0.0, 60.0, sigma_deg);
    mockup.diffuse_sigma_rad = sigma_deg * kDegrees;
    read_number(json, "sheen_f0", 0.0, 0.5, mockup.sheen_f0);
    read_number(json, "sheen_alpha", 0.05, 1.0, mockup.sheen_alpha);
    if (json.has("interreflection")) mockup.interreflection = json["interreflection"].boolean();
    return mockup;
}

std::vector<MishapDescription> read_mishaps(const JsonReader& json) {
    struct Kind {
        const char* name;
        MishapKind kind;
        double low, high;
    };
    static constexpr Kind kinds[] = {
        {"shadow", MishapKind::shadow, 0.0, 1.0},
        {"exposure", MishapKind::exposure, 0.01, 100.0},
        {"automatic-exposure", MishapKind::automatic_exposure, 0.01, 0.9},
        {"room-light", MishapKind::room_light, 0.0, 10.0},
        {"camera-moved", MishapKind::camera_moved, 0.0, 100.0},
    };
    std::vector<MishapDescription> mishaps;
    for (std::size_t k = 0; k < json.size(); ++k) {
        const auto entry = json.at(k);
        entry.allow_only({"what", "from", "to", "size"});
        const std::string what = entry["what"].text();
        const auto kind = std::find_if(
            std::begin(kinds), std::end(kinds), [&](const Kind& one) { return one.name == what; });
        if (kind == std::end(kinds)) {
            entry["what"].fail("'" + what + "'",
                               "shadow, exposure, automatic-exposure, room-light or camera-moved");
        }
        MishapDescription mishap;
        mishap.kind = kind->kind;
        mishap.size = entry["size"].number_between(kind->low, kind->high);
        read_integer(entry, "from", 0, 1'000'000, mishap.from);
        read_integer(entry, "to", mishap.from, 1'000'000, mishap.to);
        mishaps.push_back(mishap);
    }
    return mishaps;
}

/// The file's own fields over those of its base, which must stand on its own.
Json with_base(const std::string& text, const std::filesystem::path& file) {
    Json own = parse_json(text, file);
    const JsonReader json(file, own);
    json.require_format_version(kNewestVersion);
    if (!json.has("base")) return own;
    const auto base_file = file_beside(file, json["base"].text());
    Json merged = read_json_file(base_file);
    const JsonReader base(base_file, merged);
    base.require_format_version(kNewestVersion);
    if (base.has("base")) base["base"].fail("a base", "none in a file that is itself a base");
    own.erase("base");
    merged.merge_patch(own);
    return merged;
}

}  // namespace

BenchDescription read_bench_file(const std::filesystem::path& file_or_name) {
    std::filesystem::path file = file_or_name;
    std::error_code error;
    // A bare name is a shipped bench's, whatever lies in the folder where the program runs.
    if (file.extension() != ".json" && !file.has_parent_path()) {
        const auto names = shipped_names("calibration");
        const bool shipped = std::find(names.begin(), names.end(), file.string()) != names.end();
        if (!shipped && std::filesystem::is_regular_file(file, error)) {
            return parse_bench(read_text_file(file), file);
        }
        if (!shipped) {
            throw FileError(file,
                            "bench",
                            "no such file or shipped bench",
                            "a bench file or " + list_of(names));
        }
        file = shipped_path(std::filesystem::path("calibration") / (file.string() + ".json"));
    }
    return parse_bench(read_text_file(file), file);
}

BenchDescription parse_bench(const std::string& text, const std::filesystem::path& file) {
    const Json merged = with_base(text, file);
    const JsonReader json(file, merged);
    json.allow_only({"format_version",
                     "kind",
                     "name",
                     "product",
                     "projector",
                     "camera",
                     "mockup",
                     "surroundings",
                     "eye_mm",
                     "data_sheets",
                     "ambient",
                     "ambient_spectrum",
                     "mishaps",
                     "samples_a_side",
                     "seed"});
    if (const std::string kind = json["kind"].text(); kind != "bench") {
        json["kind"].fail("'" + kind + "'", "'bench'");
    }
    BenchDescription bench;
    bench.file = file;
    bench.name = json["name"].text();
    const std::filesystem::path product = json["product"].text();
    bench.projector = read_projector(json["projector"]);
    bench.camera = read_camera(json["camera"]);
    bench.mockup = read_mockup(json["mockup"]);
    if (json.has("surroundings")) {
        bench.surroundings = read_surroundings(json["surroundings"]);
    }
    bench.eye_mm = place_mm(json["eye_mm"]);
    if (json.has("data_sheets")) bench.data_sheets = read_data_sheets(json["data_sheets"]);
    read_number(json, "ambient", 0.0, 10.0, bench.ambient);
    if (json.has("ambient_spectrum")) {
        bench.ambient_spectrum = read_ambient_spectrum(json["ambient_spectrum"]);
    }
    if (json.has("mishaps")) bench.mishaps = read_mishaps(json["mishaps"]);
    read_integer(json, "samples_a_side", 1, 16, bench.samples_a_side);
    if (json.has("seed"))
        bench.seed = static_cast<std::uint64_t>(json["seed"].integer(0, 2'000'000'000));
    bench.product = file.parent_path() / product;
    std::error_code error;
    if (!std::filesystem::is_regular_file(bench.product, error))
        bench.product = shipped_path(product);
    return bench;
}

}  // namespace livery
