#include "support/effect_lacquer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "core/random.h"

namespace livery {
namespace {

using Complex = std::complex<double>;

constexpr double kVarnish = 1.5;
constexpr int kBands = 31;
constexpr double kPi = std::numbers::pi;

double wavelength_nm(int band) { return 400.0 + 10.0 * band; }

/// Straight between values at 400, 550 and 700 nm, roughly those of handbooks.
Complex index_at(double nm, const std::array<Complex, 3>& at) {
    const double t = (nm - 400.0) / 150.0;
    return t < 1.0 ? at[0] + t * (at[1] - at[0]) : at[1] + (t - 1.0) * (at[2] - at[1]);
}
const std::array<Complex, 3> kChromium{{{2.0, -2.9}, {3.0, -3.3}, {3.8, -4.4}}};
const std::array<Complex, 3> kAluminium{{{0.5, -4.9}, {1.0, -6.6}, {1.8, -8.3}}};
const std::array<Complex, 3> kTitania{{{2.7, 0.0}, {2.5, 0.0}, {2.4, 0.0}}};

struct Layer {
    Complex index;
    double nm = 0.0;
};

/// Of a stack in varnish, unpolarised, by characteristic matrices (Macleod).
double reflectance(std::span<const Layer> layers, Complex beneath, double sine, double nm) {
    double sum = 0.0;
    for (const bool across : {false, true}) {
        const auto admittance = [&](Complex index) {
            const Complex ratio = kVarnish * sine / index;
            Complex cosine = std::sqrt(1.0 - ratio * ratio);
            return std::pair(across ? index * cosine : index / cosine, cosine);
        };
        Complex b = 1.0, c = admittance(beneath).first;
        for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
            const auto [eta, cosine] = admittance(layer->index);
            const Complex phase = 2.0 * kPi * layer->index * layer->nm * cosine / nm;
            const Complex i(0.0, 1.0);
            const Complex next = std::cos(phase) * b + i * std::sin(phase) / eta * c;
            c = i * eta * std::sin(phase) * b + std::cos(phase) * c;
            b = next;
        }
        const Complex front = admittance(kVarnish).first * b;
        sum += 0.5 * std::norm((front - c) / (front + c));
    }
    return sum;
}

/// Mean over flakes whose films differ.
double flake_reflectance(const EffectLacquer& lacquer, double sine, double nm) {
    double sum = 0.0, weights = 0.0;
    for (int k = -2; k <= 2; ++k) {
        const double weight = std::exp(-0.5 * k * k);
        const double film_nm = lacquer.film_nm * (1.0 + 0.04 * k);
        double r = 0.0;
        if (lacquer.stack == FlakeStack::chromium_fluoride) {
            const std::array layers{Layer{index_at(nm, kChromium), 7.0}, Layer{1.38, film_nm}};
            r = reflectance(layers, index_at(nm, kAluminium), sine, nm);
        } else {
            // Mica is too thick for its two sides to interfere; light goes to and fro.
            const std::array layers{Layer{index_at(nm, kTitania), film_nm}};
            const double side = reflectance(layers, 1.58, sine, nm);
            r = 2.0 * side / (1.0 + side);
        }
        sum += weight * r;
        weights += weight;
    }
    return sum / weights;
}

double fresnel(double cosine) {
    const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (kVarnish * kVarnish));
    const double s = (cosine - kVarnish * inside) / (cosine + kVarnish * inside);
    const double p = (kVarnish * cosine - inside) / (kVarnish * cosine + inside);
    return 0.5 * (s * s + p * p);
}

double beckmann(double cosine2, double width) {
    const double tan2 = (1.0 - cosine2) / cosine2;
    return std::exp(-tan2 / (width * width)) / (kPi * width * width * cosine2 * cosine2);
}

glm::dvec3 refracted(const glm::dvec3& w) {
    const glm::dvec3 in(w.x / kVarnish, w.y / kVarnish, 0.0);
    return {in.x, in.y, std::sqrt(1.0 - in.x * in.x - in.y * in.y)};
}

/// Flakes and pigment are met in the varnish; what comes out is spread over n^2 more solid angle.
std::array<double, kBands> spectrum_of(const EffectLacquer& lacquer, const DirectionPair& pair) {
    const glm::dvec3 outer = glm::normalize(pair.wi + pair.wo);
    const double coat = fresnel(glm::dot(outer, pair.wi)) *
                        beckmann(outer.z * outer.z, lacquer.highlight_alpha) /
                        (4.0 * pair.wi.z * pair.wo.z);
    const double through =
        (1.0 - fresnel(pair.wi.z)) * (1.0 - fresnel(pair.wo.z)) / (kVarnish * kVarnish);
    const glm::dvec3 wi = refracted(pair.wi), wo = refracted(pair.wo);
    const glm::dvec3 half = glm::normalize(wi + wo);
    const double flakes =
        (1.0 - lacquer.wide_share) * beckmann(half.z * half.z, lacquer.narrow_lean) +
        lacquer.wide_share * beckmann(half.z * half.z, lacquer.wide_lean);
    const double cosine = std::min(glm::dot(half, wi), 1.0);
    const double sine = std::sqrt(1.0 - cosine * cosine);
    std::array<double, kBands> spectrum{};
    for (int band = 0; band < kBands; ++band) {
        const double nm = wavelength_nm(band);
        const double t = std::clamp((nm - 450.0) / 100.0, 0.0, 2.0);
        const glm::dvec3& p = lacquer.pigment;
        const double pigment = t < 1.0 ? p.x + t * (p.y - p.x) : p.y + (t - 1.0) * (p.z - p.y);
        const double under =
            lacquer.coverage * flakes * flake_reflectance(lacquer, sine, nm) / (4.0 * wi.z * wo.z) +
            (1.0 - lacquer.coverage) * pigment / kPi;
        spectrum[static_cast<std::size_t>(band)] = coat + through * under;
    }
    return spectrum;
}

}  // namespace

MeasuredSamples samples_of(const EffectLacquer& lacquer,
                           std::span<const DirectionPair> pairs,
                           double noise,
                           unsigned seed) {
    constexpr double kNoiseFloor = 2e-4;
    Random random(seed);
    MeasuredSamples samples;
    for (int band = 0; band < kBands; ++band) {
        samples.wavelengths_nm.push_back(wavelength_nm(band));
    }
    for (const DirectionPair& pair : pairs) {
        samples.pairs.push_back(pair);
        const double gain = std::exp(noise * random.normal());
        for (const double value : spectrum_of(lacquer, pair)) {
            samples.values.push_back(std::max(0.0, gain * value + kNoiseFloor * random.normal()));
        }
    }
    return samples;
}

}  // namespace livery
