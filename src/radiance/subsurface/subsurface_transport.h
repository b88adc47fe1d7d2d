// Light that enters a translucent part at one place of its surface and leaves it at another: a
// sparse matrix between nodes, weighed by a profile at their distance in space.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "radiance/light/interreflection.h"
#include "radiance/subsurface/subsurface_kernel.h"
#include "tracing/tracer.h"

namespace livery {

/// What a level of Effect::subsurface means here.
struct TransportDetail {
    int neighbours = 600;      ///< of a node, about: sets how far nodes are apart
    bool rejects_air = false;  ///< whether rays say what lies between two nodes
    bool operator==(const TransportDetail&) const = default;
};

/// Which nodes of a part are near one another: of the mesh and a reach alone, so that a change of
/// light or of the paint's colour keeps it.
struct SubsurfaceTransport {
    std::size_t part = 0;
    /// An open part that is a sheet is that thick: behind each of its places the mesh has another
    /// one, which faces the other way. 0: it is as thick as it is modelled.
    float sheet_mm = 0.0f;
    Mesh mesh;                             ///< the part's triangles by themselves
    std::vector<std::uint32_t> place_of;   ///< of each triangle of the product, there; kNoTriangle
    std::vector<std::uint32_t> behind_of;  ///< the same of a sheet's other side; of others empty
    NodeExchange exchange;                 ///< nodes, and what of the sky they do not see
    std::vector<float> area_mm2;           ///< of each node
    /// Mean curvature of the surface around each node, over its reach, nearer places more: 1 over
    /// the radius of a ball, negative in a hollow.
    std::vector<float> curvature_per_mm;
    float reach_mm = 0.0f;
    float near_mm = 0.0f;  ///< what lies within is finer than nodes tell (SubsurfaceKernel)
    /// Others within reach of each node, from `first` on, and how far they are (distance_code).
    std::vector<std::uint32_t> first, other;
    std::vector<std::uint16_t> code;
    /// Where the part is thin and flat: which of the thicknesses each node's place has, or kDeep,
    /// and the nodes on the other side, with their distance along the slab.
    static constexpr std::uint8_t kDeep = 0xff;
    std::vector<float> slabs_mm;
    std::vector<std::uint8_t> slab_of;
    std::vector<std::uint32_t> through_first, through;
    std::vector<std::uint16_t> through_code;
};
/// The next longer reach of a geometric row, of fourths of an octave: colours and depths that are
/// near one another share nodes, so that who drags them has new ones sought once in many steps.
float shared_reach_mm(float reach_mm);
SubsurfaceTransport solve_transport(const Mesh& product,
                                    const Tracer& tracer,
                                    std::size_t part,
                                    float reach_mm,
                                    const TransportDetail& detail,
                                    const Progress& progress = {},
                                    float sheet_mm = 0.0f);

/// At each node, per area: what leaves there of light that entered farther off than near_mm or on
/// the other side, and the share of what enters nearer. Both together give back of even light what
/// a body as bent there does (total_at()), or a slab as thin: of what enters on the same side
/// `even_share`.
struct LeavingLight {
    std::vector<glm::vec3> from_afar, near_share, even_share;
};
LeavingLight leaving_at_nodes(const SubsurfaceTransport& transport,
                              const SubsurfaceKernel& kernel,
                              std::span<const glm::vec3> entering,
                              const Progress& progress = {});

/// What one mesh's nodes have, at the nodes of a part of it; nothing on a sheet's other side, of
/// which the mesh knows nothing.
std::vector<glm::vec3> at_part_nodes(const Mesh& product,
                                     const ExchangeNodes& nodes,
                                     const std::vector<glm::vec3>& at_nodes,
                                     const SubsurfaceTransport& transport);

/// What the nodes of a part have, at nodes of the whole mesh; nothing on its other parts.
std::vector<glm::vec3> from_part_nodes(const SubsurfaceTransport& transport,
                                       const std::vector<glm::vec3>& at_nodes,
                                       const Mesh& product,
                                       const ExchangeNodes& nodes);

/// Solved by whoever asks first, for all who draw the same mesh; the last few are kept.
class SharedTransports {
  public:
    std::shared_ptr<const SubsurfaceTransport> of(const Mesh& product,
                                                  const Tracer& tracer,
                                                  std::size_t part,
                                                  float reach_mm,
                                                  const TransportDetail& detail,
                                                  const Progress& progress,
                                                  float sheet_mm = 0.0f);

  private:
    struct Made {
        TransportDetail detail;
        std::shared_ptr<const SubsurfaceTransport> transport;
    };
    std::mutex mutex_;
    std::map<std::size_t, Made> of_part_;
};

}  // namespace livery
