// The shading programs, one for each combination that a scene uses, and what they read; the grids
// of measured paints as textures.
#pragma once

#include <array>
#include <compare>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
#include "appearance/paint_bsdf.h"
#include "gl/draw.h"
#include "gl/handles.h"
#include "gl/program.h"
#include "radiance/lanes/input_layers.h"
#include "radiance/lanes/lane_functions.h"
#include "radiance/light/mirror_lobes.h"
#include "scene/artwork_coats.h"
#include "scene/look.h"

namespace livery {

/// Needs a current context from the first use to its end.
class MeasuredTextures {
  public:
    void bind(const std::shared_ptr<const MeasuredPaint>& paint, unsigned unit);

  private:
    std::vector<std::pair<std::weak_ptr<const MeasuredPaint>, Texture2D>> textures_;
};

/// A layer for each theta_d (shaders/bsdf/measured.glsl).
Texture2D texture_of(const MeasuredGrid& grid);

/// In the packed layout; those that no paint of the scene reads stay empty.
struct ShadingInputs {
    InputLayers lit;     ///< light on a white diffuser, for plain diffuse parts
    InputLayers eye;     ///< direction to the eye; mean squared slope
    InputLayers lights;  ///< one layer a light: direction, visibility
    InputLayers sky;     ///< environment on a white diffuser
    InputLayers
        mirror;  ///< kMirrorLayers: environment over the mirror lobes, how much of it grazes
    InputLayers places;        ///< for glints: position, side of a pixel's square there, in mm
    float mirror_unit = 1.0f;  ///< radiance of a value of 1 in `mirror`
    MirrorMixing mirror_mixing = MirrorMixing::cubic;  ///< that `mirror` has the lobes for
    std::vector<glm::vec3> light_irradiance;           ///< one a layer of `lights`, facing it
    std::vector<float> light_radius2;                  ///< half of the disc's angle, squared
    double product_scale = 1.0;                        ///< Product's
};

/// Where a shading program finds its fragments' inputs.
enum class ShadingSource {
    packed,  ///< the surface map's textures
    raster   ///< the triangle that was rasterised there
};
/// Light from all around: on diffusers alone, or mirrored as well.
enum class Surroundings { none, diffuse, mirrored };
/// What a program is made for.
struct ShadingKey {
    ReflectanceModel model = ReflectanceModel::lambert;
    int lights = 0;
    Surroundings surroundings = Surroundings::none;
    bool over = false;    ///< over another paint: an artwork's
    bool relief = false;  ///< the part has one; ShadingSource::raster
    bool glints = false;
    auto operator<=>(const ShadingKey&) const = default;
};

/// Texels in a row of the textures that hold a mesh's arrays for ShadingSource::raster.
inline constexpr int kMeshRow = 2048;

Program make_shading_program(const ShadingKey& key, ShadingSource source);

/// Whether what shades takes from the model's parameters once what depends on no fragment; it does
/// so eight fragments at a time as well.
bool has_own_shading(ReflectanceModel model);

/// Uniforms that depend on the paint and the exposure only, of a model with its own shading.
struct PaintUniforms {
    float exposure = 1.0f;  ///< 2^EV
    PreparedPaint paint;
    std::array<glm::vec4, kMostLobes> lobe_layers{};  ///< u_lobe_layers
};
PaintUniforms uniforms_of(const Material& material, double exposure_ev, MirrorMixing mixing);
/// 2^EV. No number if one of what a paint was prepared to is none: all that it covers must end
/// black and counted, whatever the formulas' clamps would make of it.
float exposure_of(double exposure_ev, std::span<const float> numbers);

/// The same of any model: what ANY_MODEL of shade.glsl reads.
inline constexpr int kEnvironmentWeights = 33;
struct AnyModelUniforms {
    float exposure = 1.0f;
    BsdfParameters paint{};
    std::shared_ptr<const MeasuredPaint> measured{};
    std::array<glm::vec3, kEnvironmentWeights> sky_weight{}, mirror_weight{};
    glm::vec4 base_layers{};
    float lobe_alpha = 1.0f;
};
AnyModelUniforms any_model_uniforms_of(const Material& material,
                                       double exposure_ev,
                                       MirrorMixing mixing);
/// Its weights of light from all around, with nothing rounded but the paint's own numbers.
struct EnvironmentWeights {
    std::array<glm::dvec3, kEnvironmentWeights> sky{}, mirror{};
};
EnvironmentWeights environment_weights_in_double(const Material& material);

/// The coefficients of an artwork's paint.
void set_coat(Program& program, const ArtworkCoat& coat);

/// `measured` has the grids of measured paints; the one that is drawn is left bound.
void set_paint(Program& program,
               const Material& material,
               double exposure_ev,
               MirrorMixing mixing,
               MeasuredTextures& measured);

/// Compiles on first use.
class ShadingPrograms {
  public:
    /// Shades a rectangle of the packed fragments.
    void shade(const Material& material,
               const ShadingInputs& inputs,
               double exposure_ev,
               const PixelRect& rectangle,
               const Framebuffer& target);
    /// Adds one paint of an artwork over what the rectangle was shaded with; `means` are its
    /// layers'.
    void shade(const ArtworkCoat& coat,
               const InputLayers& means,
               const ShadingInputs& inputs,
               double exposure_ev,
               const PixelRect& rectangle,
               const Framebuffer& target);
    /// The program that the paint would be shaded with, down to the machine's code: drivers put
    /// that off until the first draw, so one pixel is drawn, nowhere.
    void compile(const Material& material, const ShadingInputs& inputs, bool over = false);

  private:
    static ShadingKey key_of(const Material& material, const ShadingInputs& inputs, bool over);
    Program& ready(const Material& material,
                   const ShadingInputs& inputs,
                   double exposure_ev,
                   bool over);
    Program& program_for(const ShadingKey& key);

    std::map<ShadingKey, Program> programs_;
    std::set<ShadingKey> drawn_;
    MeasuredTextures measured_;
    ScreenPass screen_;
    Texture2D nowhere_;
    Framebuffer nowhere_framebuffer_;
};

}  // namespace livery
