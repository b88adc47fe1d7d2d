// What a bench file says: every nuisance a switch, off unless the file turns it on (docs/bench.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/data_sheet.h"
#include "scene/view.h"
#include "twin/spectra.h"

namespace livery {

/// Response of one channel: p(x) = (1 - s) x^gamma + s x^2 (3 - 2 x), x = drive / 255.
struct ProjectorDescription {
    View view;
    ProjectorSpectra spectra = uhp_projector();
    glm::dvec3 gamma{2.2};      ///< one a channel
    double s_curve = 0.0;       ///< s above
    double gamma_spread = 0.0;  ///< relative change of gamma from the picture's middle to a corner
    double leak = 0.0;          ///< light of each channel at drive 0, over full drive
    double white_segment =
        0.0;  ///< luminance that the clear segment adds, over the white of r + g + b
    double vignetting = 0.0;  ///< light lost at the corner, quadratic in the radius
    double defocus_sigma_px = 0.0;
    double flicker = 0.0;               ///< standard deviation of the lamp between photographs
    double drift_per_photograph = 0.0;  ///< relative change of the lamp a photograph
    int latency_photographs = 0;        ///< that many still see the picture before
};

enum class CameraEncoding { raw14, srgb8 };

struct CameraDescription {
    View view;
    std::array<Spectrum, 3> sensitivities{};
    CameraEncoding encoding = CameraEncoding::raw14;
    double exposure_s = 0.0;     ///< 0: metered so that full white peaks at `metered_peak`
    double metered_peak = 0.82;  ///< of full scale
    /// What green reads each second off a white diffuser that faces the projector's full white.
    double sensitivity_units_per_s = 150'000.0;
    double black_level_units = 1024.0;  ///< raw14 only
    double electrons_per_unit = 0.0;    ///< shot noise; 0: none
    double read_noise_units = 0.0;
    double vignetting = 0.0;     ///< light lost at the corner, quadratic in the radius
    double flare = 0.0;          ///< share of the light that scatters in the lens
    double flare_radius = 0.2;   ///< sigma of that scatter over the picture's width
    double shift_px = 0.0;       ///< the camera sags: largest displacement of the picture
    int shift_photographs = 50;  ///< reached, linearly, after so many photographs
};

/// What one part of the mock-up is sprayed with.
struct SurfaceDescription {
    Spectrum reflectance{};
    Spectrum second{};          ///< mixed in by a smooth pattern in space
    double second_share = 0.0;  ///< largest share of `second`; 0: no pattern
    double pattern_mm = 20.0;   ///< size of the pattern's features
};

struct MockupDescription {
    std::map<std::string, SurfaceDescription> surfaces;  ///< by part name; "*": the rest
    double diffuse_sigma_rad = 0.0;  ///< roughness of the diffuse part (Oren-Nayar); 0: Lambert
    double sheen_f0 = 0.0;           ///< Fresnel reflectance of a GGX lobe over it
    double sheen_alpha = 0.4;
    bool interreflection = false;  ///< one bounce between parts, and from what stands around
};

/// A rectangle that the projector lights besides the mock-up: a table, a wall, a floor. Its front
/// is where side_a x side_b points.
struct SurroundingDescription {
    SurfaceDescription surface;
    glm::dvec3 corner_mm{0.0}, side_a_mm{0.0}, side_b_mm{0.0};
};

enum class MishapKind {
    shadow,              ///< somebody in the light: `size` of it is lost in the shadow's middle
    exposure,            ///< one that is `size` times what the camera says
    automatic_exposure,  ///< the picture's mean held at `size` of full scale, and nothing said
    room_light,          ///< switched on: luminance of a white diffuser in it, over projector white
    camera_moved,        ///< by `size` pixels
};
/// What happens while photographs are taken, from the photograph `from` to `to`, counted from 0.
struct MishapDescription {
    MishapKind kind = MishapKind::shadow;
    int from = 0, to = std::numeric_limits<int>::max();
    double size = 0.0;
};

struct BenchDescription {
    std::string name;
    std::filesystem::path file;     ///< where it came from; empty: made in memory
    std::filesystem::path product;  ///< mesh or product file of the mock-up
    ProjectorDescription projector;
    CameraDescription camera;
    MockupDescription mockup;
    std::map<std::string, SurroundingDescription> surroundings;  ///< by name
    glm::dvec3 eye_mm{0.0};                                      ///< the observer
    /// What its operator would know without a photograph; nothing: a bench for which nobody said.
    std::optional<DataSheets> data_sheets;
    double ambient =
        0.0;  ///< luminance of a white diffuser in the room's light, over projector white
    Spectrum ambient_spectrum = illuminant_d65();
    std::vector<MishapDescription> mishaps;
    int samples_a_side = 4;  ///< sub-samples a pixel, squared
    std::uint64_t seed = 1;
};

/// A bench file, or the name of a shipped one ("default", "paper-2.75m"). Throws FileError.
BenchDescription read_bench_file(const std::filesystem::path& file_or_name);
/// The same of a file's text; what it names lies beside the file or among the shipped data.
BenchDescription parse_bench(const std::string& text, const std::filesystem::path& file);

}  // namespace livery
