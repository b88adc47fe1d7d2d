// A look as its file says it: paints by name, lights, environment, exposure.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "scene/artwork.h"

namespace livery {

/// A distant light. `radiance_rec709` is what a perfect white diffuser facing it reflects, that is
/// its irradiance / pi; the key light of the default looks has 1.
struct DirectionalLight {
    glm::dvec3 direction{0.0, 1.0, 0.0};  ///< toward the light, normalised on reading
    glm::dvec3 radiance_rec709{1.0};
    double angle_rad = 0.0;  ///< angular diameter of its disc; 0: a point at infinity

    bool operator==(const DirectionalLight&) const = default;
};

/// Whether two lights stand in the same place at the same size, whatever their radiance.
inline bool same_disc(const DirectionalLight& a, const DirectionalLight& b) {
    return a.direction == b.direction && a.angle_rad == b.angle_rad;
}

/// Of length 1. What already is, to rounding, comes back as it is: writing and reading a light
/// again and again never moves it.
glm::dvec3 unit_direction(const glm::dvec3& direction);

struct EnvironmentReference {
    std::string file;  ///< empty: no environment; relative names are looked up by load_scene
    double rotation_rad = 0.0;  ///< turns the map about +y, counter-clockwise seen from above
    double scale = 1.0;
};

struct Look {
    std::string name;
    std::map<std::string, std::string>
        parts;            ///< part name -> material name or file; "*": the rest
    std::string variant;  ///< of the product's file: what parts wear that have no paint here
    std::vector<Artwork> artwork;  ///< over these paints, each over those before it
    std::vector<DirectionalLight> lights;
    EnvironmentReference environment;
    double exposure_ev = 0.0;
    std::filesystem::path file;
};

/// Calls `change` for every name in a look that may be one of a file: paints, pictures, the
/// environment.
void for_each_file(Look& look, const std::function<void(std::string&)>& change);
/// For every paint, the parts' and artwork's that has one of its own.
void for_each_paint(Look& look, const std::function<void(std::string&)>& change);

/// Look file (docs/files.md). Throws FileError; an unknown field is refused, by name.
Look read_look_file(const std::filesystem::path& file);
/// The same of its text.
Look parse_look(const std::string& text, const std::filesystem::path& file);
void write_look_file(const std::filesystem::path& file, const Look& look);

/// Light from all directions: latitude-longitude, linear, in the working space. Row 0 looks up
/// (+y); column u in [0,1) looks toward azimuth 2 pi (u - 1/2) measured from -z toward +x, before
/// the rotation.
struct Environment {
    ImageF radiance_working;  ///< 3 channels; empty: none
    double rotation_rad = 0.0;
    double scale = 1.0;
    std::filesystem::path file;  ///< where it came from; empty: made in memory
};

/// The file that a look's environment means: as named, in the folder `beside`, or shipped. Throws
/// FileError.
std::filesystem::path find_environment_map(const std::string& name,
                                           const std::filesystem::path& beside);

/// Reads an .hdr or .exr map (linear Rec.709), checks that it is 2:1, finite, not negative by more
/// than rounding. A relative name is looked for in the folder `beside`, then among shipped data. No
/// name, no environment. Throws FileError.
Environment load_environment(const EnvironmentReference& reference,
                             const std::filesystem::path& beside);

/// Why load_environment() would refuse it now, as a session names files: by their whole paths or
/// among the shipped data. Reads a map once, and again when its file was changed.
std::optional<std::string> environment_problem(const EnvironmentReference& reference);

/// Direction -> map coordinates in [0,1)^2 and back, rotation included.
glm::dvec2 uv_from_direction(const Environment& environment, const glm::dvec3& direction);
glm::dvec3 direction_from_uv(const Environment& environment, const glm::dvec2& uv);

}  // namespace livery
