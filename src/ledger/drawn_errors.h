// What rounding makes of what is drawn: shade.glsl in OpenGL and in the lanes of the processor
// against the same lines in double, at the inputs where they lose most digits.
#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "core/random.h"
#include "ledger/level.h"
#include "radiance/lanes/lane_functions.h"
#include "radiance/lanes/shading_in_double.h"

namespace livery {

/// By the lanes of the processor, as a frame runs them.
std::vector<glm::vec3> shaded_in_lanes(const Material& material,
                                       const LooseFragments& fragments,
                                       double exposure_ev,
                                       const LaneFunctions& functions = best_lanes());

/// By the shader, in the current OpenGL context, into 32-bit floats.
std::vector<glm::vec3> shaded_in_gl(const Material& material,
                                    const LooseFragments& fragments,
                                    double exposure_ev);

/// What a fragment is lit by and covers, one kind of it at a time.
enum class DrawnLight {
    even,         ///< the light on a white diffuser, which is all that plain diffuse paints read
    point,        ///< a light without a size on a smooth surface
    disc,         ///< a light of up to 10 degrees
    relief,       ///< no size, normals that vary by a mean squared slope of 1e-8 to 0.1
    disc_relief,  ///< both
    environment,  ///< the sky and what is mirrored of it
    film,         ///< a disc, flakes under a film of 0 to 2000 nm
    glints        ///< a disc on single flakes
};
inline constexpr DrawnLight kDrawnLights[] = {DrawnLight::even,
                                              DrawnLight::point,
                                              DrawnLight::disc,
                                              DrawnLight::relief,
                                              DrawnLight::disc_relief,
                                              DrawnLight::environment,
                                              DrawnLight::film,
                                              DrawnLight::glints};
std::string to_string(DrawnLight light);

/// The largest errors of one paint in one light, as shares of the right value of that channel, but
/// under a film of the brightest channel (one is where the film's waves cancel), and of glints of
/// what is right and what the flakes show on the mean (few show nothing). Infinite for what is no
/// number.
struct DrawnError {
    std::string paint;  ///< the model's name
    DrawnLight light = DrawnLight::point;
    double alpha = 0.0;
    double allowed = 0.0;     ///< max(1e-4, 4e-7 / alpha)
    std::size_t values = 0;   ///< compared
    std::size_t invalid = 0;  ///< infinite, negative or no number, of all three
    double in_lanes = 0.0, in_gl = 0.0;
    double ms = 0.0;  ///< that measuring it took
};

/// Lights that tell something of the model.
std::vector<DrawnLight> drawn_lights(ReflectanceModel model);

/// Most of the pairs lie within a few alpha of the mirror direction, half close to grazing, down to
/// 89.99 degrees; a tenth are mirrored exactly (H is N), a tenth opposite and grazing (L near -V).
LooseFragments drawn_fragments(DrawnLight light, double alpha, std::size_t count, Random& random);

/// A row for each light and slope parameter, over anisotropies of 1, 10 and 100 where the model
/// takes two. Needs a current OpenGL context. Plain `quick` leaves most slope parameters out.
std::vector<DrawnError> drawn_errors(ReflectanceModel model,
                                     bool quick,
                                     std::uint64_t seed,
                                     const Progress& progress = {});

/// An effect for each paint in each light.
std::vector<LedgerEffect> effects_of(const std::vector<DrawnError>& rows);
/// Tables by paint and by slope parameter.
std::string markdown_of(const std::vector<DrawnError>& rows);

}  // namespace livery
