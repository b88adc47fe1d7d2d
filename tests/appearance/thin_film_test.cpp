// Interference colours against Airy's formula, wavelength by wavelength, in double.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/models.h"
#include "core/colour.h"
#include "core/spectrum.h"
#include "core/worst_error.h"

namespace livery {
namespace {

double between_bands(const Spectrum& spectrum, double wavelength_nm) {
    const double at = (wavelength_nm - kSpectrumFirst_nm) / kSpectrumStep_nm;
    const auto k = std::min(static_cast<std::size_t>(at), spectrum.size() - 2);
    return std::lerp(spectrum[k], spectrum[k + 1], at - static_cast<double>(k));
}

/// The indices of varnish, film and what it lies on.
struct Layers {
    double coat, film, base;
};

/// Reflectance of one polarisation and one wavelength under an angle in air, the amplitudes by
/// Fresnel's formulas at each interface.
double airy(const Layers& n, double film_nm, double sine, double wavelength_nm, bool parallel) {
    const auto cosine = [&](double index) {
        return std::sqrt(1.0 - sine * sine / (index * index));
    };
    const auto amplitude = [&](double from, double to) {
        const double a = parallel ? to * cosine(from) : from * cosine(from);
        const double b = parallel ? from * cosine(to) : to * cosine(to);
        return (a - b) / (a + b);
    };
    const double front = amplitude(n.coat, n.film), back = amplitude(n.film, n.base);
    const double phase = 4.0 * std::numbers::pi * n.film * film_nm * cosine(n.film) / wavelength_nm;
    const std::complex<double> turn = std::polar(1.0, phase);
    return std::norm((front + back * turn) / (1.0 + front * back * turn));
}

/// Of both polarisations, under D65 for the CIE 1931 observer, every nanometre; the working space.
glm::dvec3 spectral_colour(const Layers& n, double film_nm, double sine) {
    glm::dvec3 sum(0.0), white(0.0);
    for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
        const glm::dvec3 seen =
            between_bands(illuminant_d65(), nm) * glm::dvec3(between_bands(cie1931_x(), nm),
                                                             between_bands(cie1931_y(), nm),
                                                             between_bands(cie1931_z(), nm));
        white += seen;
        sum += 0.5 * (airy(n, film_nm, sine, nm, false) + airy(n, film_nm, sine, nm, true)) * seen;
    }
    return (working_from_xyz() * sum) / (working_from_xyz() * white);
}

double f0_of(const Layers& n) {
    const double r = (n.coat - n.base) / (n.coat + n.base);
    return r * r;
}

f64::BsdfParameters film_on(const Layers& n, double film_nm) {
    f64::BsdfParameters p = plain_parameters();
    const double r = (n.coat - 1.0) / (n.coat + 1.0);
    p.coat_f0 = r * r;
    p.flake_f0 = glm::dvec3(f0_of(n));
    p.film_nm = film_nm;
    p.film_eta = n.film;
    return p;
}

/// |wi + wo|^2 for light and eye at that angle to a flake.
double hh_of(double sine) { return 4.0 * (1.0 - sine * sine); }

double colour_difference(const glm::dvec3& a, const glm::dvec3& b) {
    const auto lab = [](const glm::dvec3& working) {
        return lab_from_xyz(xyz_from_working() * working, d65_xyz());
    };
    return ciede2000(lab(a), lab(b));
}

// The model's own approximations: ten bands for the observer, and the normal's amplitudes for all
// angles and both polarisations.
TEST(ThinFilm, ColoursAreThoseOfAirysFormula) {
    for (const double degrees : {0.0, 45.0, 75.0}) {
        const double sine = std::sin(degrees * std::numbers::pi / 180.0);
        std::vector<double> errors, colours;
        for (const double base : {1.58, 2.0, 3.5, 12.0}) {
            for (const double film : {1.3, 1.8, 2.3, 2.7}) {
                for (double nm = 0.0; nm <= 2000.0; nm += nm < 800.0 ? 20.0 : 75.0) {
                    const Layers n{1.5, film, base};
                    const glm::dvec3 truth = spectral_colour(n, nm, sine);
                    const glm::dvec3 value =
                        f64::film_reflectance(f64::film_prepare(film_on(n, nm)), hh_of(sine));
                    const glm::dvec3 away = glm::abs(value - truth);
                    errors.push_back(worse_of({away.x, away.y, away.z}));
                    colours.push_back(worst_if_nan(colour_difference(value, truth)));
                }
            }
        }
        std::sort(errors.begin(), errors.end());
        std::sort(colours.begin(), colours.end());
        const auto at = [](const std::vector<double>& v, double share) {
            return v[static_cast<std::size_t>(share * static_cast<double>(v.size() - 1))];
        };
        std::printf(
            "    %2.0f degrees: reflectance median %.4f, 95%% %.4f, worst %.4f; CIEDE2000 "
            "median %.2f, 95%% %.2f, worst %.1f\n",
            degrees,
            at(errors, 0.5),
            at(errors, 0.95),
            errors.back(),
            at(colours, 0.5),
            at(colours, 0.95),
            colours.back());
        EXPECT_LT(errors.back(), degrees < 40.0 ? 0.003 : degrees < 60.0 ? 0.007 : 0.04);
        EXPECT_LT(at(colours, 0.5), degrees < 40.0 ? 0.1 : degrees < 60.0 ? 0.4 : 1.5);
    }
}

TEST(ThinFilm, OfNoThicknessOrOfTheVarnishsIndexIsNone) {
    const auto expect_plain = [](const f64::BsdfParameters& p) {
        for (const double hh : {0.1, 2.0, 4.0}) {
            const glm::dvec3 value = f64::film_reflectance(f64::film_prepare(p), hh);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], p.flake_f0[c], 1e-6);
        }
    };
    f64::BsdfParameters p = plain_parameters();
    p.flake_f0 = {0.02, 0.4, 1.0};
    p.film_eta = 2.4;
    expect_plain(p);
    p.film_nm = 1e-3;
    expect_plain(p);
    p.film_nm = 400.0;
    p.film_eta = (1.0 + std::sqrt(p.coat_f0)) / (1.0 - std::sqrt(p.coat_f0));
    expect_plain(p);
}

TEST(ThinFilm, StaysWithinWhatAWavelengthReflectsAndMovesSmoothly) {
    Random random(31);
    for (int k = 0; k < 3000; ++k) {
        f32::BsdfParameters p = extreme_parameters(random);
        const float hh = 4.0f * random.uniform_float();
        const glm::vec3 most = f32::film_prepare(p).most;
        const glm::vec3 value = f32::film_reflectance(f32::film_prepare(p), hh);
        const glm::dvec3 precise =
            f64::film_reflectance(f64::film_prepare(widened(p)), static_cast<double>(hh));
        for (int c = 0; c < 3; ++c) {
            ASSERT_GE(value[c], 0.0f);
            ASSERT_LE(value[c], most[c]);
            ASSERT_LE(most[c], 1.0f + 1e-6f);
            ASSERT_NEAR(static_cast<double>(value[c]), precise[c], 1e-4) << "case " << k;
        }
        p.film_nm = std::min(p.film_nm, 1999.0f);
        f64::BsdfParameters thicker = widened(p);
        const glm::dvec3 before =
            f64::film_reflectance(f64::film_prepare(thicker), static_cast<double>(hh));
        thicker.film_nm += 0.1;
        const glm::dvec3 after =
            f64::film_reflectance(f64::film_prepare(thicker), static_cast<double>(hh));
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(before[c], after[c], 0.02) << "case " << k;
    }
}

f64::BsdfParameters pearl(double film_nm) {
    f64::BsdfParameters p = plain_parameters();
    p.diffuse = {0.6, 0.3, 0.1};
    p.f0 = glm::dvec3(0.1);
    p.flake_f0 = {0.05, 0.2, 0.6};
    p.film_nm = film_nm;
    p.film_eta = 2.4;
    return p;
}

TEST(ThinFilm, PaintWithItIsTheSameBothWaysAndInFloat) {
    Random random(5);
    for (const double film_nm : {60.0, 350.0, 900.0, 2000.0}) {
        f64::BsdfParameters p = widened(rounded(pearl(film_nm)));
        for (int k = 0; k < 3000; ++k) {
            const glm::vec3 wo(random_direction(random));
            const glm::vec3 wi(random_partner(random, glm::dvec3(wo), 0.15));
            const auto model = ReflectanceModel::car_paint;
            const glm::dvec3 there = evaluate(model, p, glm::dvec3(wi), glm::dvec3(wo));
            const glm::dvec3 back = evaluate(model, p, glm::dvec3(wo), glm::dvec3(wi));
            const glm::vec3 in_float = evaluate(model, rounded(p), wi, wo);
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(there[c], back[c], 1e-12 * there[c]);
                if (there[c] < kLeastComparedValue) continue;
                ASSERT_NEAR(static_cast<double>(in_float[c]) / there[c], 1.0, 5e-4);
            }
        }
    }
}

TEST(ThinFilm, PaintWithItKeepsEnergyAndWeighsTheEnvironment) {
    double most = 0.0, worst = 0.0;
    for (const double film_nm : {60.0, 120.0, 350.0, 900.0}) {
        for (const double mu : {0.05, 0.2, 0.5, 1.0}) {
            for (const double alpha : {0.02, 0.15, 0.4}) {
                f64::BsdfParameters p = pearl(film_nm);
                p.flake_alpha = alpha;
                const glm::dvec3 coloured =
                    directional_albedo(ReflectanceModel::car_paint, p, direction(mu, 0.0), 48);
                if (mu >= 0.2) {
                    const f32::BsdfEnvironment e = environment_weights(
                        ReflectanceModel::car_paint, rounded(p), static_cast<float>(mu));
                    const glm::dvec3 sum(e.diffuse + e.specular + e.coat);
                    const glm::dvec3 away = glm::abs(sum - coloured);
                    worst = worse_of({worst, away.x, away.y, away.z});
                }
                p.diffuse = glm::dvec3(1.0);
                p.f0 = glm::dvec3(0.0);
                p.coat_f0 = 0.0;
                const glm::dvec3 white =
                    directional_albedo(ReflectanceModel::car_paint, p, direction(mu, 0.0), 48);
                most = worse_of({most, white.x, white.y, white.z});
            }
        }
    }
    std::printf("    largest albedo %.4f, environment's weights off by %.4f\n", most, worst);
    EXPECT_LE(most, 1.0 + 1e-4);
    EXPECT_GT(most, 0.9);
    EXPECT_LT(worst, 0.04);
}

}  // namespace
}  // namespace livery
