// The geometry of a bench, traced once: which projector pixels light what each camera pixel sees
// (and each projector pixel's own patch of mock-up, as the eye sees it), with which weight and on
// which reflectance. What remains for a picture is a sparse sum.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "mesh/mesh.h"
#include "tracing/tracer.h"
#include "twin/description.h"

namespace livery {

/// The reflectances of a mock-up: two a part (its own and the one mixed in by a pattern), then the
/// neutral one of the sheen.
struct SurfaceSet {
    std::vector<Spectrum> reflectances;
    struct PartSurface {
        std::uint16_t first = 0, second = 0;  ///< into reflectances
        double second_share = 0.0, pattern_mm = 1.0;
    };
    std::vector<PartSurface> parts;
    std::uint16_t sheen = 0;
    double diffuse_sigma_rad = 0.0, sheen_f0 = 0.0, sheen_alpha = 0.4;
};
/// The description's surroundings follow the mock-up's parts.
SurfaceSet make_surfaces(const BenchDescription& bench, const Mesh& mesh);

/// The mock-up with the rectangles around it as further parts. Throws std::invalid_argument for a
/// name that a part has.
Mesh with_surroundings(const Mesh& mockup, const BenchDescription& bench);

/// Light from one projector pixel, reflected toward the receiver: weight times the pixel's light
/// times the reflectance, in units of a white diffuser that faces the projector at the reference
/// distance.
struct PathTerm {
    std::uint32_t pixel = 0;  ///< of the projector
    std::uint16_t surface = 0;
    float weight = 0.0f;
};

/// How much of a receiver one reflectance covers, lit or not.
struct CoverTerm {
    std::uint16_t surface = 0;
    float share = 0.0f;
};

/// Terms of receiver i: [begin[i], begin[i + 1]).
struct LightPaths {
    std::vector<std::uint32_t> receiver;  ///< pixel index, rising
    std::vector<std::uint32_t> term_begin, cover_begin;
    std::vector<PathTerm> terms;  ///< of one receiver: by surface, then by projector pixel
    std::vector<CoverTerm> covers;
    std::vector<glm::vec3> position_mm, normal;  ///< means over the receiver
};

/// Everything that the tracing needs to know of the world.
struct TracedWorld {
    const Mesh& mesh;              ///< the mock-up, then its surroundings
    std::size_t mockup_parts = 0;  ///< parts before this one are the mock-up's
    const Tracer& tracer;
    const SurfaceSet& surfaces;
    const BenchDescription& bench;
    double reference_mm = 1.0;  ///< projector to the middle of the mock-up
};

/// Receivers are camera pixels; a term's weight is its share of the pixel's area.
LightPaths trace_camera(const TracedWorld& world, const Progress& progress);

/// What an observer's pixels see, with what is true of each.
struct ObservedPaths {
    LightPaths paths;
    Image8 lit;          ///< 255 where at least half of the pixel lies on lit mock-up
    Image8 edge;         ///< 255 within 2 px of a silhouette, depth or part edge
    Image8 seen_by_eye;  ///< 255 where the eye sees at least half of the mock-up in the pixel
};
/// Receivers are projector pixels, seen from the eye; weights are means over the lit part of the
/// pixel. `seen_by_eye` counts what is lit.
ObservedPaths trace_projector(const TracedWorld& world, const Progress& progress);
/// Receivers are the pixels of the eye's picture; a term's weight is its share of the pixel's area.
ObservedPaths trace_eye(const TracedWorld& world, const View& eye, const Progress& progress);

/// What a point of the surface gets from the projector pixel that lights it.
struct Illumination {
    std::uint32_t pixel = 0;
    double irradiance = 0.0;  ///< cosine, inverse square, vignetting; 1 at the reference
};

/// Nothing where the point faces away or lies outside the picture; visibility is the caller's.
std::optional<Illumination> illumination_of(const ProjectorDescription& projector,
                                            double reference_mm,
                                            const glm::dvec3& position_mm,
                                            const glm::dvec3& normal);

/// Reflectances at a surface point with their factors: radiance = irradiance x sum factor R, in
/// units of a white diffuser. `to_light` and `to_viewer` are unit vectors.
struct SurfaceFactor {
    std::uint16_t surface = 0;
    double factor = 0.0;
};
struct SurfaceFactors {
    std::array<SurfaceFactor, 3> list{};
    int count = 0;
};
SurfaceFactors surface_factors(const SurfaceSet& surfaces,
                               std::uint16_t part,
                               const glm::dvec3& position_mm,
                               const glm::dvec3& normal,
                               const glm::dvec3& to_light,
                               const glm::dvec3& to_viewer);

/// Reflectances at a place, whatever the light and the viewer: shares that sum to 1.
SurfaceFactors surface_shares(const SurfaceSet& surfaces,
                              std::uint16_t part,
                              const glm::dvec3& position_mm);

/// Share of a surface's second reflectance at a place: smooth in space, 0 to 1.
double pattern_share(const glm::dvec3& position_mm, double pattern_mm);

}  // namespace livery
