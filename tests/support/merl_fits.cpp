#include "support/merl_fits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "appearance/directions.h"
#include "core/colour.h"
#include "core/paths.h"
#include "core/text/csv.h"

namespace livery {

namespace {

constexpr double kLowestCosine = 0.17364817766693033;  ///< 80 degrees

/// Calls read(csv, name, number, colour) for each row, where number("B") and colour("kD") look
/// columns up, a colour's being kD_r, kD_g, kD_b.
template <typename Read>
void for_each_material(const std::filesystem::path& file, const Read& read) {
    const std::string text = read_text_file(file);
    CsvReader csv(text, file);
    const std::size_t name = csv.column("name", "a table of fits");
    const auto number = [&](const std::string& column) {
        return csv.number(csv.column(column, "a table of fits"));
    };
    const auto colour = [&](const std::string& column) {
        return glm::dvec3(number(column + "_r"), number(column + "_g"), number(column + "_b"));
    };
    while (csv.next()) read(std::string(csv.text(name)), number, colour);
}

struct Cosines {
    double light, eye, half, difference;  ///< N.L, N.V, N.H, V.H
};
Cosines cosines_of(const glm::dvec3& wi, const glm::dvec3& wo) {
    const glm::dvec3 h = glm::normalize(wi + wo);
    return {wi.z, wo.z, std::min(h.z, 1.0), std::min(glm::dot(wo, h), 1.0)};
}

/// Unpolarised light on glass, or on anything by an index alone.
double fresnel(double cosine, double index) {
    const double sine2 = (1.0 - cosine * cosine) / (index * index);
    if (sine2 >= 1.0) return 1.0;
    const double inside = std::sqrt(1.0 - sine2);
    const double s = (cosine - index * inside) / (cosine + index * inside);
    const double p = (inside - index * cosine) / (inside + index * cosine);
    return 0.5 * (s * s + p * p);
}

}  // namespace

std::vector<SgdFit> read_sgd_fits(const std::filesystem::path& csv) {
    std::vector<SgdFit> fits;
    for_each_material(csv, [&](const std::string& name, const auto&, const auto& colour) {
        fits.push_back({name,
                        colour("rhoD"),
                        colour("rhoS"),
                        colour("alpha"),
                        colour("p"),
                        colour("kap"),
                        colour("f0"),
                        colour("f1"),
                        colour("lambda"),
                        colour("c"),
                        colour("k"),
                        colour("theta0")});
    });
    return fits;
}

std::vector<AbcFit> read_abc_fits(const std::filesystem::path& csv) {
    std::vector<AbcFit> fits;
    for_each_material(csv, [&](const std::string& name, const auto& number, const auto& colour) {
        fits.push_back({name, colour("kD"), colour("A"), number("B"), number("C"), number("ior")});
    });
    return fits;
}

glm::dvec3 evaluate(const SgdFit& fit, glm::dvec3 wi, glm::dvec3 wo) {
    if (!(wi.z > 0.0 && wo.z > 0.0)) return glm::dvec3(0.0);
    const Cosines cosines = cosines_of(wi, wo);
    const double half2 = cosines.half * cosines.half;
    const double tan2 = (1.0 - half2) / half2;
    const double m = 1.0 - cosines.difference;
    const double schlick = m * m * m * m * m;
    glm::dvec3 value(0.0);
    for (int c = 0; c < 3; ++c) {
        const double x = fit.alpha[c] + tan2 / fit.alpha[c];
        const double distribution = fit.kappa[c] * std::exp(-x) /
                                    (std::numbers::pi * std::pow(x, fit.p[c]) * half2 * half2);
        const double f = fit.f0[c] - cosines.difference * fit.f1[c] + schlick * (1.0 - fit.f0[c]);
        const auto unmasked = [&](double cosine) {
            const double beyond = std::max(std::acos(std::min(cosine, 1.0)) - fit.theta0[c], 0.0);
            const double g =
                1.0 + fit.lambda[c] * (1.0 - std::exp(fit.c[c] * std::pow(beyond, fit.k[c])));
            return std::clamp(g, 0.0, 1.0);
        };
        const double lobe = fit.specular[c] * f * distribution * unmasked(cosines.light) *
                            unmasked(cosines.eye) / (cosines.light * cosines.eye);
        value[c] = (fit.diffuse[c] + lobe) / std::numbers::pi;
    }
    return value;
}

glm::dvec3 evaluate(const AbcFit& fit, glm::dvec3 wi, glm::dvec3 wo) {
    if (!(wi.z > 0.0 && wo.z > 0.0)) return glm::dvec3(0.0);
    const Cosines cosines = cosines_of(wi, wo);
    const glm::dvec3 distribution = fit.a / std::pow(1.0 + fit.b * (1.0 - cosines.half), fit.c);
    const double groove = 2.0 * cosines.half / cosines.difference;
    const double g = std::min({1.0, groove * cosines.eye, groove * cosines.light});
    return (fit.diffuse + distribution * (fresnel(cosines.difference, fit.index) * g /
                                          (cosines.light * cosines.eye))) /
           std::numbers::pi;
}

template <typename Fit>
MeasuredSamples samples_of(const Fit& fit, int theta_h, int theta_d, int phi_d) {
    MeasuredSamples samples;
    for (int h = 0; h < theta_h; ++h) {
        const double root = (h + 0.5) / theta_h;
        const double half = 0.5 * std::numbers::pi * root * root;
        const glm::dvec3 n(std::sin(half), 0.0, std::cos(half));
        const glm::dvec3 t(std::cos(half), 0.0, -std::sin(half));
        for (int d = 0; d < theta_d; ++d) {
            const double difference = 0.5 * std::numbers::pi * (d + 0.5) / theta_d;
            for (int p = 0; p < phi_d; ++p) {
                const double phi = std::numbers::pi * (p + 0.5) / phi_d;
                const glm::dvec3 across =
                    std::sin(difference) *
                    (std::cos(phi) * t + std::sin(phi) * glm::dvec3(0.0, 1.0, 0.0));
                const DirectionPair pair{std::cos(difference) * n + across,
                                         std::cos(difference) * n - across};
                if (pair.wi.z < kLowestCosine || pair.wo.z < kLowestCosine) continue;
                const glm::dvec3 value = evaluate(fit, pair.wi, pair.wo);
                const glm::dvec3 xyz = xyz_from_rec709() * value;
                if (std::min({value.x, value.y, value.z}) < 0.0) {
                    ++samples.masked;
                    continue;
                }
                samples.pairs.push_back(pair);
                samples.values.insert(samples.values.end(), {xyz.x, xyz.y, xyz.z});
            }
        }
    }
    return samples;
}

template MeasuredSamples samples_of(const SgdFit&, int, int, int);
template MeasuredSamples samples_of(const AbcFit&, int, int, int);

}  // namespace livery
