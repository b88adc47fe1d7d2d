// What leaves the translucent parts of a scene at each fragment: solved when a light, a medium or
// the level changes; which nodes lie near one another is kept.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/subsurface/translucent_material.h"
#include "radiance/glints.h"
#include "radiance/subsurface/subsurface_transport.h"
#include "radiance/surface_map.h"
#include "scene/look.h"

namespace livery {

class SubsurfaceInputs {
  public:
    SubsurfaceInputs(const Mesh& mesh,
                     const Tracer& tracer,
                     std::shared_ptr<SharedTransports> transports)
        : mesh_(mesh), tracer_(tracer), transports_(std::move(transports)) {}

    /// What a solution depends on.
    struct Wanted {
        std::vector<std::optional<TranslucentMaterial>> media;  ///< of each part, on the mock-up
        std::vector<DirectionalLight> lights;
        std::shared_ptr<const Environment> environment;
        int exchange_version = 0;  ///< of light between parts
        int arriving_version = 0;  ///< of what arrives at fragments
        TransportDetail detail;
    };
    bool stands(const Wanted& wanted) const;
    /// What of all light enters a medium at a fragment where the surface is that bent; of even
    /// light that share does.
    using EnteringAt = std::function<glm::vec3(
        std::size_t fragment, const EnteredMedium& medium, float share, float curvature_per_mm)>;
    /// `between`: light between parts on a white diffuser at nodes of the whole mesh, if there is
    /// any. A stop leaves what stood before.
    void solve(const Wanted& wanted,
               const SurfaceMap& map,
               const PixelSize& pixels,
               const EnteringAt& entering_at,
               const FilteredEnvironment& filtered,
               const std::shared_ptr<const NodeExchange>& exchange,
               const std::vector<glm::vec3>& between,
               const Progress& progress);
    /// Without solving: a part whose medium and light are as solved keeps its solution; of the
    /// others light leaves where it enters.
    void use_what_stands(const Wanted& wanted);
    void clear();                             ///< forgets all
    int version() const { return version_; }  ///< grows with each other solution

    struct Part {
        TranslucentMaterial medium;
        glm::vec3 total{0.0f};                ///< of what enters
        bool spread = false;                  ///< otherwise light leaves where it enters
        std::vector<glm::vec3> at_fragments;  ///< of the whole map; over pi it is radiance
    };
    bool empty() const { return parts_.empty(); }
    /// Null for parts that are not translucent.
    const Part* part(std::size_t part) const {
        return part < parts_.size() && parts_[part] ? &*parts_[part] : nullptr;
    }

  private:
    struct KernelOf {
        TranslucentMaterial medium;
        float reach_mm = 0.0f;
        float sheet_mm = 0.0f;  ///< SubsurfaceTransport's
        SubsurfaceKernel kernel;
    };
    const Mesh& mesh_;
    const Tracer& tracer_;
    const std::shared_ptr<SharedTransports> transports_;
    std::optional<Wanted> solved_;
    std::vector<std::optional<KernelOf>> kernels_;
    std::vector<std::optional<Part>> parts_;
    int version_ = 0;
};

}  // namespace livery
