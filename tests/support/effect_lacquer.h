// Interference lacquers that are computed wavelength by wavelength: flakes of thin layers in a
// varnish over a pigment. No formula of them is one of the models', so fitting has to come near
// what it cannot reach.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/measured/measured_samples.h"

namespace livery {

/// A flake's layers.
enum class FlakeStack {
    chromium_fluoride,  ///< chromium, magnesium fluoride, aluminium: strong colour shift
    titania_on_mica     ///< titanium dioxide on both sides of mica: pearl
};

struct EffectLacquer {
    const char* name;
    FlakeStack stack = FlakeStack::chromium_fluoride;
    double film_nm = 400.0;         ///< of the layer that makes the colour; flakes vary by 4%
    double narrow_lean = 0.06;      ///< slopes of the flakes: a Gaussian's width,
    double wide_lean = 0.25;        ///< another's,
    double wide_share = 0.4;        ///< and how many flakes are the second's
    double coverage = 0.8;          ///< of the pigment by flakes
    glm::dvec3 pigment{0.02};       ///< albedo at 450, 550 and 650 nm, in the varnish
    double highlight_alpha = 0.05;  ///< of the varnish as a wide aperture sees it
};

/// At these pairs of directions, 400 to 700 nm, each value with noise of that share (seeded) and of
/// 2e-4 per steradian; what becomes negative is 0.
MeasuredSamples samples_of(const EffectLacquer& lacquer,
                           std::span<const DirectionPair> pairs,
                           double noise,
                           unsigned seed);

}  // namespace livery
