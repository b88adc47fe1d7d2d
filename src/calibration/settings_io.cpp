#include <cmath>

#include <glm/matrix.hpp>

#include "calibration/settings.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"

namespace livery {

namespace {

/// Three measured primaries whose determinant is under this part of their lengths' product lie in
/// one plane as far as a colorimeter can tell.
constexpr double kSingular = 1e-6;

void refuse_singular(const JsonReader& field, const glm::dmat3& matrix) {
    const double lengths = glm::length(matrix[0]) * glm::length(matrix[1]) * glm::length(matrix[2]);
    if (!(std::abs(glm::determinant(matrix)) > kSingular * lengths)) {
        field.fail("a singular matrix", "three independent columns");
    }
}

CameraToXyz assumed_rec709() {
    CameraToXyz result;
    result.xyz_from_camera = xyz_from_rec709();
    result.origin = "assumed Rec.709";
    return result;
}

}  // namespace

CameraToXyz read_camera_to_xyz(const std::filesystem::path& file) {
    return parse_camera_to_xyz(read_text_file(file), file);
}

CameraToXyz parse_camera_to_xyz(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader reader(file, json);
    if (reader.has("format_version")) reader.require_format_version(1);
    reader.allow_only({"format_version", "matrix", "primaries_xyz", "measured_at_px", "note"});
    CameraToXyz result;
    if (reader.has("matrix") == reader.has("primaries_xyz")) {
        reader.fail(reader.has("matrix") ? "both" : "neither", "either matrix or primaries_xyz");
    }
    if (reader.has("matrix")) {
        result.xyz_from_camera = reader["matrix"].matrix3();
        refuse_singular(reader["matrix"], result.xyz_from_camera);
        result.origin = "matrix";
        return result;
    }
    const JsonReader primaries = reader["primaries_xyz"];
    primaries.allow_only({"red", "green", "blue", "black"});
    result.has_primaries = true;
    result.primaries_xyz =
        glm::dmat3(primaries["red"].vec3(), primaries["green"].vec3(), primaries["blue"].vec3());
    result.black_xyz = primaries["black"].vec3();
    refuse_singular(primaries,
                    glm::dmat3(result.primaries_xyz[0] - result.black_xyz,
                               result.primaries_xyz[1] - result.black_xyz,
                               result.primaries_xyz[2] - result.black_xyz));
    if (reader.has("measured_at_px")) {
        const auto pixel = reader["measured_at_px"].numbers(2);
        result.measured_at_px = glm::dvec2(pixel[0], pixel[1]);
    }
    result.origin = "primaries";
    return result;
}

CameraToXyz camera_matrix(const std::filesystem::path& file) {
    CameraToXyz camera = file.empty() ? assumed_rec709() : read_camera_to_xyz(file);
    if (camera.has_primaries) {
        throw FileError(file,
                        "primaries_xyz",
                        "a projector's primaries",
                        "matrix: linear camera RGB to XYZ, for the lamp's light");
    }
    return camera;
}

}  // namespace livery
