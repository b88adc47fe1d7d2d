#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/mutation.h"
#include "core/random.h"
#include "twin/light_paths.h"

namespace livery {

namespace {

/// Noise value in [0, 1] of a lattice point.
double lattice(int x, int y, int z) {
    const auto bits = hash_3d(static_cast<std::uint32_t>(x),
                              static_cast<std::uint32_t>(y),
                              static_cast<std::uint32_t>(z));
    return bits * 0x1p-32;
}

/// Oren and Nayar 1994, their qualitative model: 1 for a smooth surface.
double rough_diffuse(double sigma_rad, double nl, double nv, double cos_azimuth) {
    const double s2 = sigma_rad * sigma_rad;
    const double a = 1.0 - 0.5 * s2 / (s2 + 0.33);
    const double b = 0.45 * s2 / (s2 + 0.09);
    const double sin_l = std::sqrt(std::max(0.0, 1.0 - nl * nl));
    const double sin_v = std::sqrt(std::max(0.0, 1.0 - nv * nv));
    // sin(larger angle) tan(smaller angle): the smaller angle has the larger cosine.
    const double slant = sin_l * sin_v / std::max({nl, nv, 1e-6});
    return LIVERY_MUTATED(twin_rough_diffuse, a + b * std::max(0.0, cos_azimuth) * slant);
}

/// pi times the GGX lobe with Smith's separable shadowing (Walter et al. 2007) and Schlick's
/// Fresnel.
double sheen_lobe(
    double f0, double alpha, double nl, double nv, const glm::dvec3& n, glm::dvec3 h) {
    const double length = glm::length(h);
    if (nl <= 0.0 || nv <= 0.0 || length < 1e-9) return 0.0;
    h /= length;
    const double nh = glm::dot(n, h);
    const double t = nh * nh * (alpha * alpha - 1.0) + 1.0;
    const double d = alpha * alpha / (t * t);  // pi D
    const auto shadow = [alpha](double mu) {
        return 2.0 * mu / (mu + std::sqrt(alpha * alpha + (1.0 - alpha * alpha) * mu * mu));
    };
    const double vh = 0.5 * length;  // l + v = 2 (v.h) h for unit l and v
    const double fresnel = f0 + (1.0 - f0) * std::pow(1.0 - std::min(vh, 1.0), 5.0);
    return LIVERY_MUTATED(twin_sheen, d * shadow(nl) * shadow(nv) * fresnel / (4.0 * nl * nv));
}

}  // namespace

Mesh with_surroundings(const Mesh& mockup, const BenchDescription& bench) {
    Mesh world = mockup;
    for (const auto& [name, around] : bench.surroundings) {
        for (const Part& part : mockup.parts) {
            check_argument(part.name != name, "bench: '" + name + "' is a part and a surrounding");
        }
        const glm::vec3 corner(around.corner_mm), a(around.side_a_mm), b(around.side_b_mm);
        Mesh rectangle;
        rectangle.positions_mm = {corner, corner + a, corner + a + b, corner + b};
        rectangle.triangles = {{0, 1, 2}, {0, 2, 3}};
        rectangle.triangle_part = {0, 0};
        rectangle.uvs.assign(4, glm::vec2(0.0f));
        rectangle.parts.emplace_back().name = name;
        compute_normals(rectangle);
        compute_tangents(rectangle);
        append(world, rectangle, "");
    }
    return world;
}

SurfaceSet make_surfaces(const BenchDescription& bench, const Mesh& mesh) {
    MockupDescription mockup = bench.mockup;
    for (const auto& [name, around] : bench.surroundings) mockup.surfaces[name] = around.surface;
    SurfaceSet set;
    set.diffuse_sigma_rad = mockup.diffuse_sigma_rad;
    set.sheen_f0 = mockup.sheen_f0;
    set.sheen_alpha = mockup.sheen_alpha;
    std::string names;
    for (const Part& part : mesh.parts) names += (names.empty() ? "" : ", ") + part.name;
    for (const auto& [name, surface] : mockup.surfaces) {
        const bool known =
            name == "*" || std::any_of(mesh.parts.begin(), mesh.parts.end(), [&](const Part& part) {
                return part.name == name;
            });
        check_argument(known, "bench: no part '" + name + "' in the mock-up; it has " + names);
    }
    // Parts that share a description share its reflectances: fewer terms to sum.
    std::map<std::string, SurfaceSet::PartSurface> made;
    for (const Part& part : mesh.parts) {
        const std::string key = mockup.surfaces.contains(part.name) ? part.name : "*";
        const auto found = mockup.surfaces.find(key);
        check_argument(found != mockup.surfaces.end(),
                       "bench: no reflectance for part '" + part.name + "' and none for \"*\"");
        if (!made.contains(key)) {
            const SurfaceDescription& from = found->second;
            SurfaceSet::PartSurface surface;
            surface.first = surface.second = static_cast<std::uint16_t>(set.reflectances.size());
            set.reflectances.push_back(from.reflectance);
            if (from.second_share > 0.0) {
                surface.second = static_cast<std::uint16_t>(set.reflectances.size());
                set.reflectances.push_back(from.second);
            }
            surface.second_share = from.second_share;
            surface.pattern_mm = from.pattern_mm;
            made[key] = surface;
        }
        set.parts.push_back(made[key]);
    }
    set.sheen = static_cast<std::uint16_t>(set.reflectances.size());
    Spectrum neutral;
    neutral.fill(1.0);
    set.reflectances.push_back(neutral);
    check_argument(set.reflectances.size() < std::numeric_limits<std::uint16_t>::max(),
                   "bench: too many parts with surfaces of their own");
    return set;
}

double pattern_share(const glm::dvec3& position_mm, double pattern_mm) {
    // Value noise with a smooth step between lattice points.
    const glm::dvec3 p = position_mm / pattern_mm;
    const glm::dvec3 cell = glm::floor(p);
    const glm::dvec3 f = p - cell;
    const glm::dvec3 w = f * f * (3.0 - 2.0 * f);
    const glm::ivec3 c(cell);
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
        const int dx = k & 1, dy = (k >> 1) & 1, dz = k >> 2;
        sum += (dx ? w.x : 1.0 - w.x) * (dy ? w.y : 1.0 - w.y) * (dz ? w.z : 1.0 - w.z) *
               lattice(c.x + dx, c.y + dy, c.z + dz);
    }
    return sum;
}

SurfaceFactors surface_shares(const SurfaceSet& surfaces,
                              std::uint16_t part,
                              const glm::dvec3& position_mm) {
    const auto& surface = surfaces.parts[part];
    SurfaceFactors factors;
    double second = 0.0;
    if (surface.second_share > 0.0) {
        second = surface.second_share * pattern_share(position_mm, surface.pattern_mm);
        factors.list[1] = {surface.second, second};
        factors.count = 2;
    } else {
        factors.count = 1;
    }
    factors.list[0] = {surface.first, 1.0 - second};
    return factors;
}

SurfaceFactors surface_factors(const SurfaceSet& surfaces,
                               std::uint16_t part,
                               const glm::dvec3& position_mm,
                               const glm::dvec3& normal,
                               const glm::dvec3& to_light,
                               const glm::dvec3& to_viewer) {
    SurfaceFactors factors = surface_shares(surfaces, part, position_mm);
    if (surfaces.diffuse_sigma_rad <= 0.0 && surfaces.sheen_f0 <= 0.0) return factors;
    const double nl = glm::dot(normal, to_light), nv = glm::dot(normal, to_viewer);
    double diffuse = 1.0 - surfaces.sheen_f0;  // what the sheen reflects does not reach the paint
    if (surfaces.diffuse_sigma_rad > 0.0 && nl > 0.0 && nv > 0.0) {
        const glm::dvec3 l = to_light - nl * normal, v = to_viewer - nv * normal;
        const double lengths = glm::length(l) * glm::length(v);
        const double cos_azimuth = lengths > 1e-12 ? glm::dot(l, v) / lengths : 0.0;
        diffuse *= rough_diffuse(surfaces.diffuse_sigma_rad, nl, nv, cos_azimuth);
    }
    for (int k = 0; k < factors.count; ++k) {
        factors.list[static_cast<std::size_t>(k)].factor *= diffuse;
    }
    if (surfaces.sheen_f0 > 0.0) {
        const double lobe = sheen_lobe(
            surfaces.sheen_f0, surfaces.sheen_alpha, nl, nv, normal, to_light + to_viewer);
        factors.list[static_cast<std::size_t>(factors.count++)] = {surfaces.sheen, lobe};
    }
    return factors;
}

}  // namespace livery
