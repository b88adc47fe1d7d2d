// What fragments mirror of an environment, for the parts and the lobes that paints read: solved on
// the CPU, kept until the eye or the environment changes, and added to when other paints are worn.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/interreflection.h"
#include "radiance/light/mirror_lobes.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/light/mirror_visibility.h"
#include "radiance/light/mirrored_environment.h"
#include "radiance/light/sky_visibility.h"
#include "radiance/packed_fragments.h"
#include "radiance/shading.h"
#include "radiance/smooth_runs.h"
#include "tracing/tracer.h"

namespace livery {

class MirrorInputs {
  public:
    MirrorInputs(const Mesh& mesh,
                 const Tracer& tracer,
                 const SurfaceMap& map,
                 const PackedLayout& layout);

    /// What is mirrored, and how finely.
    struct Light {
        std::shared_ptr<const Environment> environment;
        glm::dvec3 eye_mm{0.0};
        int nodes = 0;  ///< a ring (mirror_rings); 0 or kNoNodes: nothing is hidden
        bool operator==(const Light&) const = default;
        MirrorMixing mixing() const {
            return nodes == kNoNodes ? MirrorMixing::linear : MirrorMixing::cubic;
        }
    };
    using LayersOfParts = std::vector<MirrorLayers>;

    /// What each node of the product sends, where it hides the environment; null: it is black. Of
    /// another `version` than before, what was solved is missing() for who wants it, and stands for
    /// who does not ask.
    void hide_behind(std::shared_ptr<const NodeExchange> nodes, const NodeLight& sent, int version);

    /// Another map of the same fragments: nothing that was solved stands.
    void use(const SurfaceMap& map);
    /// The scene has no environment.
    void clear();

    /// The light that is solved; with no environment: none.
    const Light& light() const { return light_; }
    /// Of those that are wanted, what is not solved in that light; with `and_old`, nor behind what
    /// the product sends now.
    LayersOfParts missing(const Light& light,
                          const LayersOfParts& wanted,
                          bool and_old = true) const;
    /// Whether rays to find out what hides those layers' light are yet to be traced.
    bool lacks_visibility(const Light& light, const LayersOfParts& layers) const;
    void trace(const Light& light,
               const LayersOfParts& layers,
               const SmoothRuns& runs,
               const Progress& progress);
    /// `layers` are missing(). Without nodes, fragments that share their pixel are darkened as
    /// `joints` says, if there.
    void solve(const Light& light,
               const LayersOfParts& layers,
               const FilteredEnvironment& filtered,
               const SmoothRuns& runs,
               const SkyVisibility* joints,
               const Progress& progress);

    /// The same for kNoNodes.
    void look_up(const Light& light,
                 const LayersOfParts& layers,
                 const MirrorLookUp& environment,
                 const SmoothRuns& runs,
                 const SkyVisibility* joints,
                 const Progress& progress);

    bool has_uploads() const { return other_light_ || !solved_texels_.empty(); }
    struct Uploaded {
        bool other_light = false;  ///< what was shaded in the last one does not stand
        bool more_room = false;
    };
    /// Hands what was solved to the device that shades.
    Uploaded upload(ShadingDevice device, InputLayers::Precision precision, ShadingInputs& shading);

  private:
    /// Whether what was traced is of another eye or quality.
    bool other_rays(const Light& light) const {
        return !visibility_ || visibility_->quadrature.nodes() != light.nodes ||
               visibility_eye_mm_ != light.eye_mm;
    }

    /// A layer of a part, in rows of the packed layout, four floats a texel.
    struct Texels {
        std::size_t part = 0, layer = 0;
        std::vector<float> values;
        bool even = false;  ///< ones, where light is taken to graze as even light does
    };
    /// Of a part's fragments, what they mirror of the environment beside the product.
    struct KeptSums {
        MirrorLayers layers;
        std::vector<float> values;
        std::vector<std::uint8_t> known;  ///< of each fragment: others lay between two
    };
    /// Rows for the layers asked for, of parts in the picture, with what others left in them.
    /// A look-up's need none for what is even already.
    std::vector<Texels> texels_for(const LayersOfParts& layers);
    /// How a part's texels are worked out.
    struct PartSolve {
        std::size_t part = 0;
        const SmoothRuns& runs;
        /// Between two ends of a run that differ by more than this share of what they mirror,
        /// fragments are asked for their own.
        float tolerance = 0.0f;
        const SkyVisibility* joints = nullptr;  ///< guesses what is hidden; null: it is known
        float unit = 1.0f;
    };
    /// `mirrored_by()` makes what finds the light of some fragments, kNodeBlock at most: by their
    /// indices, into as many places.
    template <typename MirroredBy>
    void solve_part(const PartSolve& how,
                    std::span<Texels> texels,
                    const MirroredBy& mirrored_by,
                    const Progress& progress) const;
    void take(const Light& light,
              const LayersOfParts& layers,
              float unit,
              std::vector<Texels> solved);

    const Mesh& mesh_;
    const Tracer& tracer_;
    const SurfaceMap* map_;
    const PackedLayout& layout_;

    std::optional<MirrorVisibility> visibility_;
    glm::dvec3 visibility_eye_mm_{0.0};
    Light light_;
    LayersOfParts solved_;  ///< of each part, in that light
    LayersOfParts newest_;  ///< of these, behind what the product sends now
    std::shared_ptr<const NodeExchange> product_nodes_;
    const NodeLight* product_sent_ = nullptr;
    int product_version_ = 0;
    std::optional<MirrorHits> hits_;  ///< of what visibility_ has traced; none: not asked for yet
    float unit_ = 1.0f;
    std::vector<Texels> solved_texels_;  ///< not yet uploaded
    std::vector<Texels> spare_texels_;   ///< uploaded look-ups: rows for the next of the same size
    LayersOfParts even_;                 ///< of each part, layers of ones that were uploaded
    /// While light between parts is solved, so that other paints change no more than that; by part.
    std::vector<KeptSums> kept_;
    bool other_light_ = false;  ///< since the last upload
};

}  // namespace livery
