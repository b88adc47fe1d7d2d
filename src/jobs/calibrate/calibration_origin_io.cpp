// The text of origin.json, apart from the photographs beside it.
#include "core/json.h"
#include "jobs/calibrate/calibration_folder.h"

namespace livery {

CalibrationOrigin parse_origin(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.require_format_version(kOriginVersion);
    root.allow_only({"format_version",
                     "kind",
                     "product",
                     "shape",
                     "made_with",
                     "capture_seconds",
                     "solve_seconds",
                     "ends",
                     "reposed_from"});
    root["kind"].one_of({"origin"});
    CalibrationOrigin origin;
    origin.product = root["product"].text();
    origin.shape = root["shape"].text();
    origin.made_with = root["made_with"].text();
    origin.capture_seconds = root["capture_seconds"].number_between(0.0, 1e6);
    origin.solve_seconds = root["solve_seconds"].number_between(0.0, 1e6);
    if (root.has("reposed_from")) origin.reposed_from = root["reposed_from"].text();
    if (root.has("ends")) {
        const JsonReader ends = root["ends"];
        ends.allow_only({"exposure_s", "late", "light"});
        origin.ends.emplace();
        origin.ends->exposure_s = ends["exposure_s"].number_between(1e-9, 1e6);
        origin.ends->late = ends["late"].integer(0, 1000);
        origin.ends->light = vec3_within(ends["light"], 1e12);
    }
    return origin;
}

}  // namespace livery
