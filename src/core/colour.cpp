#include "core/colour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/mutation.h"

namespace livery {

namespace {

constexpr glm::dvec2 kD65{0.3127, 0.3290};

glm::dvec3 xyz_from_chromaticity(glm::dvec2 xy) {
    return {xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y};
}

}  // namespace

glm::dvec3 d65_xyz() { return xyz_from_chromaticity(kD65); }

glm::dmat3 xyz_from_rgb_matrix(glm::dvec2 red,
                               glm::dvec2 green,
                               glm::dvec2 blue,
                               glm::dvec2 white) {
    const glm::dmat3 primaries(
        xyz_from_chromaticity(red), xyz_from_chromaticity(green), xyz_from_chromaticity(blue));
    const glm::dvec3 scale = glm::inverse(primaries) * xyz_from_chromaticity(white);
    return {LIVERY_MUTATED(colour_matrix, primaries[0] * scale.x),
            primaries[1] * scale.y,
            primaries[2] * scale.z};
}

const glm::dmat3& xyz_from_rec709() {
    static const glm::dmat3 matrix =
        xyz_from_rgb_matrix({0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, kD65);
    return matrix;
}

const glm::dmat3& rec709_from_xyz() {
    static const glm::dmat3 matrix = glm::inverse(xyz_from_rec709());
    return matrix;
}

const glm::dmat3& xyz_from_working() {
    // Rec.2020.
    static const glm::dmat3 matrix =
        xyz_from_rgb_matrix({0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65);
    return matrix;
}

const glm::dmat3& working_from_xyz() {
    static const glm::dmat3 matrix = glm::inverse(xyz_from_working());
    return matrix;
}

const glm::dmat3& working_from_rec709() {
    static const glm::dmat3 matrix = working_from_xyz() * xyz_from_rec709();
    return matrix;
}

const glm::dmat3& rec709_from_working() {
    static const glm::dmat3 matrix = rec709_from_xyz() * xyz_from_working();
    return matrix;
}

glm::dvec3 lab_from_xyz(glm::dvec3 xyz, glm::dvec3 white_xyz) {
    const auto f = [](double t) {
        constexpr double delta = 6.0 / 29.0;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
    };
    const glm::dvec3 ratio = xyz / white_xyz;
    const double fx = f(ratio.x), fy = f(ratio.y), fz = f(ratio.z);
    return {116.0 * fy - 16.0, LIVERY_MUTATED(lab, 500.0 * (fx - fy)), 200.0 * (fy - fz)};
}

glm::dvec3 xyz_from_lab(glm::dvec3 lab, glm::dvec3 white_xyz) {
    const auto inverse = [](double t) {
        constexpr double delta = 6.0 / 29.0;
        return t > delta ? t * t * t : 3.0 * delta * delta * (t - 4.0 / 29.0);
    };
    const double fy = (lab.x + 16.0) / 116.0;
    return glm::dvec3(inverse(fy + lab.y / 500.0), inverse(fy), inverse(fy - lab.z / 200.0)) *
           white_xyz;
}

glm::dvec3 ciede2000_vector(glm::dvec3 lab_a, glm::dvec3 lab_b) {
    constexpr double degree = std::numbers::pi / 180.0;
    const auto pow7 = [](double v) { return v * v * v * v * v * v * v; };
    const auto hue_deg = [](double a, double b) {
        if (a == 0.0 && b == 0.0) return 0.0;
        const double angle = std::atan2(b, a) / degree;
        return angle < 0.0 ? angle + 360.0 : angle;
    };

    // a' stretched towards the neutral axis.
    const double mean_chroma = 0.5 * (std::hypot(lab_a.y, lab_a.z) + std::hypot(lab_b.y, lab_b.z));
    const double stretch =
        1.5 - 0.5 * std::sqrt(pow7(mean_chroma) / (pow7(mean_chroma) + pow7(25.0)));
    const double a1 = lab_a.y * stretch, a2 = lab_b.y * stretch;
    const double c1 = std::hypot(a1, lab_a.z), c2 = std::hypot(a2, lab_b.z);
    const double h1 = hue_deg(a1, lab_a.z), h2 = hue_deg(a2, lab_b.z);

    // Differences.
    const double dl = lab_b.x - lab_a.x;
    const double dc = c2 - c1;
    double dh_deg = 0.0;
    if (c1 * c2 != 0.0) {
        dh_deg = h2 - h1;
        if (dh_deg > 180.0) dh_deg -= 360.0;
        if (dh_deg < -180.0) dh_deg += 360.0;
    }
    const double dh = 2.0 * std::sqrt(c1 * c2) * std::sin(0.5 * dh_deg * degree);

    // Means.
    const double l = 0.5 * (lab_a.x + lab_b.x);
    const double c = 0.5 * (c1 + c2);
    double h = h1 + h2;
    if (c1 * c2 != 0.0) {
        if (std::abs(h1 - h2) <= 180.0) {
            h *= 0.5;
        } else {
            h = h < 360.0 ? 0.5 * (h + 360.0) : 0.5 * (h - 360.0);
        }
    }

    // Weights and the rotation term.
    const double t = 1.0 - 0.17 * std::cos((h - 30.0) * degree) +
                     0.24 * std::cos(2.0 * h * degree) + 0.32 * std::cos((3.0 * h + 6.0) * degree) -
                     0.20 * std::cos((4.0 * h - 63.0) * degree);
    const double l50 = (l - 50.0) * (l - 50.0);
    const double sl = 1.0 + 0.015 * l50 / std::sqrt(20.0 + l50);
    const double sc = LIVERY_MUTATED(ciede2000_chroma, 1.0 + 0.045 * c);
    const double sh = 1.0 + 0.015 * c * t;
    const double theta = 30.0 * std::exp(-((h - 275.0) / 25.0) * ((h - 275.0) / 25.0));
    const double rc = 2.0 * std::sqrt(pow7(c) / (pow7(c) + pow7(25.0)));
    const double rt = -std::sin(2.0 * theta * degree) * rc;
    const double x = dl / sl, y = dc / sc, z = dh / sh;
    // x^2 + y^2 + z^2 + rt y z, the last two completed to squares; |rt| is at most 2. In this order
    // max keeps what is no number: of such a colour the difference is none either.
    return {x, y + 0.5 * rt * z, z * std::sqrt(std::max(1.0 - 0.25 * rt * rt, 0.0))};
}

double ciede2000(glm::dvec3 lab_a, glm::dvec3 lab_b) {
    return glm::length(ciede2000_vector(lab_a, lab_b));
}

namespace {

// Oklab's matrices as its author publishes them; given row by row.
const glm::dmat3 kLmsFromXyz = glm::transpose(glm::dmat3(0.8189330101,
                                                         0.3618667424,
                                                         -0.1288597137,
                                                         0.0329845436,
                                                         0.9293118715,
                                                         0.0361456387,
                                                         0.0482003018,
                                                         0.2643662691,
                                                         0.6338517070));
const glm::dmat3 kOklabFromRoots = glm::transpose(glm::dmat3(0.2104542553,
                                                             0.7936177850,
                                                             -0.0040720468,
                                                             1.9779984951,
                                                             -2.4285922050,
                                                             0.4505937099,
                                                             0.0259040371,
                                                             0.7827717662,
                                                             -0.8086757660));

}  // namespace

const glm::dmat3& oklab_cones_from_xyz() { return kLmsFromXyz; }
const glm::dmat3& oklab_from_cone_roots() { return kOklabFromRoots; }

glm::dvec3 oklab_from_xyz(glm::dvec3 xyz) {
    const glm::dvec3 lms = kLmsFromXyz * xyz;
    return kOklabFromRoots *
           glm::dvec3(LIVERY_MUTATED(oklab, std::cbrt(lms.x)), std::cbrt(lms.y), std::cbrt(lms.z));
}

glm::dvec3 xyz_from_oklab(glm::dvec3 oklab) {
    static const glm::dmat3 roots_from_oklab = glm::inverse(kOklabFromRoots);
    static const glm::dmat3 xyz_from_lms = glm::inverse(kLmsFromXyz);
    const glm::dvec3 roots = roots_from_oklab * oklab;
    return xyz_from_lms * (roots * roots * roots);
}

double srgb_encode(double linear) {
    const double v = std::abs(linear);
    const double encoded =
        v <= 0.0031308 ? 12.92 * v
                       : LIVERY_MUTATED(srgb_encode, 1.055 * std::pow(v, 1.0 / 2.4)) - 0.055;
    return std::copysign(encoded, linear);
}

double srgb_decode(double encoded) {
    const double v = std::abs(encoded);
    const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    return std::copysign(linear, encoded);
}

}  // namespace livery
