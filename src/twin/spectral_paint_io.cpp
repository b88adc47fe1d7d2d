#include <algorithm>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "twin/painted_sphere.h"

namespace livery {

namespace {

constexpr int kNewestPaintVersion = 1;

Spectrum column(const std::filesystem::path& file, const SpectrumTable& table, const char* name) {
    const auto found = std::find(table.names.begin(), table.names.end(), name);
    if (found == table.names.end()) {
        throw FileError(file, "header", "no column '" + std::string(name) + "'", "diffuse and f0");
    }
    const Spectrum& spectrum = table.columns[static_cast<std::size_t>(found - table.names.begin())];
    const double largest = *std::max_element(spectrum.begin(), spectrum.end());
    if (largest > 1.0) {
        throw FileError(file, name, "a reflectance of " + std::to_string(largest), "at most 1");
    }
    return spectrum;
}

}  // namespace

SpectralPaint read_spectral_paint(const std::filesystem::path& file_or_name) {
    std::filesystem::path file = file_or_name;
    std::error_code error;
    // A bare name is a shipped paint's, whatever lies in the folder where the program runs.
    if (file.extension() != ".json" && !file.has_parent_path()) {
        const std::filesystem::path folder = "calibration/paints";
        const auto names = shipped_names(folder);
        const bool shipped = std::find(names.begin(), names.end(), file.string()) != names.end();
        if (shipped || !std::filesystem::is_regular_file(file, error)) {
            file = shipped_path(folder / (file.string() + ".json"));
        }
    }
    return parse_spectral_paint(read_text_file(file), file);
}

SpectralPaint parse_spectral_paint(const std::string& text, const std::filesystem::path& file) {
    const Json content = parse_json(text, file);
    const JsonReader json(file, content);
    json.require_format_version(kNewestPaintVersion);
    json.allow_only({"format_version",
                     "kind",
                     "name",
                     "family",
                     "spectra",
                     "alpha",
                     "coat_alpha",
                     "coat_f0",
                     "provenance"});
    if (const std::string kind = json["kind"].text(); kind != "spectral-paint") {
        json["kind"].fail("'" + kind + "'", "'spectral-paint'");
    }
    SpectralPaint paint;
    paint.name = json["name"].text();
    paint.family = json["family"].text();
    const auto table_file = file.parent_path() / json["spectra"].text();
    paint.alpha = json["alpha"].number_between(1e-3, 1.0);
    paint.coat_alpha = json["coat_alpha"].number_between(1e-3, 1.0);
    paint.coat_f0 = json["coat_f0"].number_between(0.0, 0.5);
    paint.provenance = json["provenance"].text();
    const SpectrumTable table = read_spectra_csv(table_file);
    paint.diffuse = column(table_file, table, "diffuse");
    paint.f0 = column(table_file, table, "f0");
    return paint;
}

std::vector<std::string> spectral_paint_names() {
    std::vector<std::string> names;
    for (const auto& entry :
         std::filesystem::directory_iterator(shipped_path("calibration/paints"))) {
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace livery
