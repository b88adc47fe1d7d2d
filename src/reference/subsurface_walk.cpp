#include "reference/subsurface_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "appearance/paint_figures.h"
#include "appearance/subsurface/scattering_medium.h"

namespace livery {

namespace {

constexpr int kMostScatterings = 100'000;

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }
double mean(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

void basis(const glm::dvec3& n, glm::dvec3& u, glm::dvec3& v) {
    u = glm::normalize(
        glm::cross(std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), n));
    v = glm::cross(n, u);
}

/// Henyey and Greenstein (1941).
double phase(double g, double cosine) {
    const double square = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * std::numbers::pi * square * std::sqrt(square));
}

glm::dvec3 scattered(double g, const glm::dvec3& direction, Random& random) {
    const double u = random.uniform();
    double cosine = 1.0 - 2.0 * u;
    if (std::abs(g) > 1e-4) {
        const double part = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
        cosine = std::clamp((1.0 + g * g - part * part) / (2.0 * g), -1.0, 1.0);
    }
    const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    glm::dvec3 a, b;
    basis(direction, a, b);
    return glm::normalize(sine * std::cos(angle) * a + sine * std::sin(angle) * b +
                          cosine * direction);
}

/// What a path carries in each channel, and how likely it was sampled in each, both over the mean
/// of the latter.
struct SpectralWeight {
    glm::dvec3 carried{1.0}, likely{1.0};

    void pass(const glm::dvec3& by_channel) { multiply(by_channel, by_channel); }
    void multiply(const glm::dvec3& value, const glm::dvec3& density) {
        carried *= value;
        likely *= density;
        const double all = mean(likely);
        if (!(all > 0.0)) {
            carried = likely = glm::dvec3(0.0);
            return;
        }
        carried /= all;
        likely /= all;
    }
};

/// A light through the boundary: what reaches a point inside of it.
struct Refracted {
    glm::dvec3 travel{0.0};  ///< along which it goes inside
    double distance = 0.0;
    double flux = 0.0;       ///< per unit irradiance outside, before the medium takes its share
    glm::dvec3 normal{0.0};  ///< of the boundary where it enters
    glm::dvec3 irradiance{0.0};
};

std::optional<Refracted> refracted_to(const glm::dvec3& point,
                                      const ArrivingLight& light,
                                      const WalkMedium& medium,
                                      const Boundary& boundary,
                                      const WalkLights& lights,
                                      const glm::dvec3& guess,
                                      double farthest) {
    constexpr int kSteps = 8;
    constexpr double kNear = 1e-4;
    // As if it met the boundary where the last one did, then with the normal that was found, ...
    glm::dvec3 travel = -light.direction;
    if (glm::dot(light.direction, guess) > 0.0) {
        travel = refracted(-light.direction, guess, medium.eta).value_or(travel);
    }
    for (int step = 0; step < kSteps; ++step) {
        const auto at = boundary.first(point, -travel, farthest);
        if (!at || !at->lets_out) return std::nullopt;
        const double cosine = glm::dot(light.direction, at->normal);
        if (!(cosine > 0.0) || !(glm::dot(light.direction, at->geometric_normal) > 0.0)) {
            return std::nullopt;
        }
        const auto next = refracted(-light.direction, at->normal, medium.eta);
        if (!next) return std::nullopt;
        const double off = glm::distance(*next, travel);
        travel = *next;
        if (off > kNear) continue;
        const glm::dvec3 irradiance = lights.reaching(*at, light);
        if (irradiance == glm::dvec3(0.0)) return std::nullopt;

        // A small square of the surface, and what the light through it covers at the point
        glm::dvec3 u, v;
        basis(at->geometric_normal, u, v);
        constexpr double kSide_mm = 1e-4;
        const auto moved = [&](const glm::dvec3& along) {
            const glm::dvec3 normal = glm::normalize(at->normal + at->change * (kSide_mm * along));
            const auto there = refracted(-light.direction, normal, medium.eta);
            return kSide_mm * along + at->distance * (there.value_or(travel) - travel);
        };
        const double covers = std::abs(glm::dot(glm::cross(moved(u), moved(v)), travel));
        const double lit = kSide_mm * kSide_mm * glm::dot(light.direction, at->geometric_normal);
        constexpr double kMostFocused = 50.0;
        const double passes = 1.0 - dielectric_reflectance(cosine, medium.eta);
        return Refracted{travel,
                         at->distance,
                         passes * std::min(lit / std::max(covers, 1e-300), kMostFocused),
                         at->normal,
                         irradiance};
    }
    return std::nullopt;
}

/// At the boundary from inside: out, by chance of Fresnel's term, or the direction back.
std::optional<glm::dvec3> outward(const BoundaryPoint& at,
                                  double eta,
                                  glm::dvec3& direction,
                                  Random& random) {
    glm::dvec3 normal = at.normal;
    if (!(glm::dot(direction, normal) > 1e-6)) normal = at.geometric_normal;
    const double mu = std::clamp(glm::dot(direction, normal), 0.0, 1.0);
    if (!(random.uniform() < inner_reflectance(eta, mu))) {
        const auto out = refracted(direction, -normal, 1.0 / eta);
        if (out && glm::dot(*out, at.geometric_normal) > 0.0) return out;
    }
    const auto mirrored = [&](const glm::dvec3& n) {
        return glm::normalize(direction - 2.0 * glm::dot(direction, n) * n);
    };
    glm::dvec3 back = mirrored(normal);
    if (!(glm::dot(back, at.geometric_normal) < 0.0)) back = mirrored(at.geometric_normal);
    direction = back;
    return std::nullopt;
}

}  // namespace

WalkMedium walk_medium(const TranslucentMaterial& material) {
    WalkMedium medium;
    medium.g = material.g;
    medium.eta = material.eta;
    medium.sigma_a = material.sigma_a_per_mm;
    medium.sigma_s = material.sigma_s_prime_per_mm / (1.0 - material.g);
    medium.sigma_t = medium.sigma_a + medium.sigma_s;
    return medium;
}

std::optional<glm::dvec3> refracted(const glm::dvec3& direction,
                                    const glm::dvec3& normal,
                                    double eta) {
    const double cosine = -glm::dot(direction, normal);
    const double sine2 = (1.0 - cosine * cosine) / (eta * eta);
    if (sine2 >= 1.0) return std::nullopt;
    return glm::normalize(direction / eta +
                          (cosine / eta - std::sqrt(std::max(0.0, 1.0 - sine2))) * normal);
}

WalkResult walk_inside(const WalkMedium& medium,
                       const Boundary& boundary,
                       glm::dvec3 origin,
                       glm::dvec3 direction,
                       double channel,
                       const WalkLights* lights,
                       const std::function<void(const glm::dvec3&, const glm::dvec3&)>& add,
                       Random& random) {
    constexpr double kEverywhere = 1e30;
    // Of what is farther the medium leaves less than 1e-4
    constexpr double kDark = 9.5;
    SpectralWeight weight;
    glm::dvec3 last_normal = -direction;
    double arrives = 1.0;  // of a light that was asked for last
    const double sigma = medium.sigma_t[std::clamp(static_cast<int>(3.0 * channel), 0, 2)];
    const double least = std::min({medium.sigma_t.x, medium.sigma_t.y, medium.sigma_t.z});
    const double seen = least > 0.0 ? kDark / least : kEverywhere;
    for (int scatterings = 0; scatterings < kMostScatterings;) {
        const double free = sigma > 0.0 ? -std::log1p(-random.uniform()) / sigma : kEverywhere;
        const auto at = boundary.first(origin, direction, free);
        if (at) {
            weight.pass(glm::exp(-at->distance * medium.sigma_t));
            if (!at->lets_out || !(largest(weight.carried) > 0.0)) return {};
            if (const auto out = outward(*at, medium.eta, direction, random)) {
                return {true, *at, *out, weight.carried};
            }
            origin = boundary.inside_of(*at);
            // Without a medium a ray could go round for ever
            ++scatterings;
            continue;
        }
        if (free >= kEverywhere) return {};  // out of something that is open
        const glm::dvec3 left = glm::exp(-free * medium.sigma_t);
        weight.multiply(medium.sigma_s * left, medium.sigma_t * left);
        const double most = largest(weight.carried);
        if (!(most > 0.0)) return {};
        // Russian roulette
        constexpr double kFaint = 0.25;
        if (most < kFaint) {
            const double survival = most / kFaint;
            if (!(random.uniform() < survival)) return {};
            weight.carried /= survival;
        }
        ++scatterings;
        origin += free * direction;
        // Deep inside one light in eight is asked for: the last one says how much comes there
        constexpr double kSurelyAbove = 1.0 / 16.0, kRarest = 1.0 / 8.0;
        const double asking = std::clamp(arrives / kSurelyAbove, kRarest, 1.0);
        if (lights && random.uniform() < asking) {
            arrives = 0.0;
            lights->each(origin, random, [&](const ArrivingLight& light) {
                const auto found =
                    refracted_to(origin, light, medium, boundary, *lights, last_normal, seen);
                if (!found) return;
                last_normal = found->normal;
                const glm::dvec3 left_of_it = glm::exp(-found->distance * medium.sigma_t);
                arrives = std::max(arrives, largest(left_of_it));
                const double turned = phase(medium.g, glm::dot(found->travel, -direction));
                add(weight.carried * left_of_it * (found->flux * turned / asking),
                    found->irradiance);
            });
        }
        direction = scattered(medium.g, direction, random);
    }
    return {};
}

namespace {

/// d normal = result * d position over a triangle.
glm::dmat3 normal_change(const Mesh& mesh, std::uint32_t triangle, double length) {
    const glm::uvec3 c = mesh.triangles[triangle];
    const auto p = [&](unsigned k) { return glm::dvec3(mesh.positions_mm[k]); };
    const auto n = [&](unsigned k) { return glm::dvec3(mesh.normals[k]); };
    const glm::dvec3 e = p(c.y) - p(c.x), f = p(c.z) - p(c.x);
    const double ee = glm::dot(e, e), ef = glm::dot(e, f), ff = glm::dot(f, f);
    const double all = (ee * ff - ef * ef) * length;
    if (!(all > 0.0)) return glm::dmat3(0.0);
    return glm::outerProduct(n(c.y) - n(c.x), (ff * e - ef * f) / all) +
           glm::outerProduct(n(c.z) - n(c.x), (ee * f - ef * e) / all);
}

}  // namespace

std::optional<BoundaryPoint> PartBoundary::first(const glm::dvec3& origin,
                                                 const glm::dvec3& direction,
                                                 double farthest) const {
    // What would scatter on the boundary, to rounding, meets it: floats might take it for outside.
    constexpr double kRounding = 1e-6;
    const double reach =
        std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z), 1.0});
    TraceRay ray;
    ray.origin = glm::vec3(origin);
    ray.direction = glm::vec3(direction);
    ray.t_max = static_cast<float>(std::min(farthest + kRounding * reach, 1e30));
    const Hit hit = tracer_.closest(ray);
    if (!hit.valid()) return std::nullopt;
    const SurfacePoint point = surface_point(mesh_, hit);
    BoundaryPoint at;
    at.position = glm::dvec3(point.position_mm);
    at.geometric_normal = glm::dvec3(point.geometric_normal);
    at.normal = glm::dvec3(point.normal);
    at.distance = static_cast<double>(hit.t);
    at.lets_out =
        point.part == part_ && glm::dot(point.geometric_normal, glm::vec3(direction)) > 0.0f;
    const glm::uvec3 c = mesh_.triangles[hit.triangle];
    const glm::vec2 b = hit.barycentric;
    const glm::vec3 mixed = (1.0f - b.x - b.y) * mesh_.normals[c.x] + b.x * mesh_.normals[c.y] +
                            b.y * mesh_.normals[c.z];
    at.change = normal_change(mesh_, hit.triangle, static_cast<double>(glm::length(mixed)));
    return at;
}

glm::dvec3 PartBoundary::inside_of(const BoundaryPoint& at) const {
    return glm::dvec3(offset_origin(glm::vec3(at.position), -glm::vec3(at.geometric_normal)));
}

std::optional<BoundaryPoint> PlaneBoundary::first(const glm::dvec3& origin,
                                                  const glm::dvec3& direction,
                                                  double farthest) const {
    const double along = glm::dot(direction, normal_);
    const bool up = along > 0.0;
    if (!up && !(thickness_mm_ && along < 0.0)) return std::nullopt;
    const glm::dvec3 on = up ? point_ : point_ - *thickness_mm_ * normal_;
    const double distance = std::max(0.0, glm::dot(on - origin, normal_) / along);
    if (distance > farthest) return std::nullopt;
    BoundaryPoint at;
    at.position = origin + distance * direction;
    at.geometric_normal = at.normal = up ? normal_ : -normal_;
    at.distance = distance;
    return at;
}

glm::dvec3 PlaneBoundary::inside_of(const BoundaryPoint& at) const { return at.position; }

}  // namespace livery
