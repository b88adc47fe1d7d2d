// Light that parts of a product send to one another: radiosity between points of its surface
// (Goral, Torrance, Greenberg, Battaile 1984), gathered by rays.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/exchange_nodes.h"
#include "radiance/light/node_reflectance.h"
#include "radiance/surface_map.h"
#include "scene/scene.h"
#include "tracing/tracer.h"

namespace livery {

/// What each node sees of others along cosine-weighted directions: of the mesh alone, whatever it
/// is painted and lit with.
struct NodeExchange {
    ExchangeNodes nodes;
    NodeDirections directions;           ///< of a node's rays
    std::vector<glm::vec3> x_axes;       ///< of each node's frame; z is its normal
    std::vector<std::uint64_t> blocked;  ///< bit k: direction k meets the product
    /// What each node sees of others from their outside, from `first` on: by which of its rays, and
    /// which of theirs comes along it.
    std::vector<std::uint32_t> first;
    std::vector<std::uint8_t> by;
    std::vector<std::uint32_t> seen;
    /// kLampRays of each node, from all over what it stands for; empty: they start at its place.
    std::vector<glm::vec3> lamp_origins_mm;

    std::size_t rays() const { return directions.count(); }
    /// In the world, as many as rays.
    void directions_of(std::size_t node, std::span<glm::vec3> turned) const;
    /// Which of its rays a node sends along `toward`, from a place where the normal is another:
    /// that which shows in a mirror what that place does.
    std::uint32_t ray_toward(std::uint32_t node,
                             const glm::vec3& toward,
                             const glm::vec3& normal) const;
};
/// Rays of a node toward each lamp.
inline constexpr std::size_t kLampRays = 8;
NodeExchange solve_node_exchange(const Mesh& mesh,
                                 const Tracer& tracer,
                                 const Progress& progress = {});

/// Solved by whoever asks first, for all who draw the same mesh.
class SharedExchange {
  public:
    /// A stop leaves it to the next one.
    std::shared_ptr<const NodeExchange> of(const Mesh& mesh,
                                           const Tracer& tracer,
                                           const Progress& progress);

  private:
    std::mutex mutex_;
    std::shared_ptr<const NodeExchange> made_;
};

/// Which of that many cosine-weighted directions of each node meet the product.
NodeExchange blocked_directions(const Mesh& mesh,
                                const Tracer& tracer,
                                ExchangeNodes nodes,
                                int rays,
                                const Progress& progress = {});

/// A medium that light enters: a beam that comes in aslant spreads from a mean free path along its
/// refracted way, and so from beside where it entered. On a bent surface that thins light where it
/// falls steeply and gathers it toward the edge of what is lit: with e(t) the cosine t times what
/// Fresnel lets in,
///   e(t) (1 - 2 k t l/eta) + (1 - t^2) k l/eta,  k the curvature, l the mean free path,
/// which is the divergence of the displaced light to first order, and nothing for even light.
struct EnteredMedium {
    double eta = 1.0;
    glm::vec3 path_mm{0.0f};                  ///< linear Rec.709
    std::span<const float> curvature_per_mm;  ///< of each place
};
/// That, in linear Rec.709 channels; not below 0.
glm::vec3 entering_of_lamp(const EnteredMedium& medium, float cosine, float curvature_per_mm);

/// What a white diffuser at each node sends under the lights and the environment (null: none), as
/// far as the product does not hide them. Working space, exposure not included. With a `medium`
/// what enters it there instead. `along`, if there is any, takes what comes along each node's rays
/// where it has room for that: lamps as wide as rays are apart.
std::vector<glm::vec3> direct_at_nodes(const Mesh& mesh,
                                       const Tracer& tracer,
                                       const NodeExchange& exchange,
                                       const std::vector<DirectionalLight>& lights,
                                       const Environment* environment,
                                       const FilteredEnvironment& filtered,
                                       const Progress& progress = {},
                                       const EnteredMedium* medium = nullptr,
                                       NodeLight* along = nullptr);

/// The share of even light from all around that enters a medium of index `eta`.
float entering_share(double eta);

/// What comes to nodes from outside of the product.
struct DirectLight {
    std::vector<glm::vec3> on_diffuser;
    NodeLight along;  ///< by rays of nodes of parts with lobes
};

/// `lobes` names those parts.
DirectLight direct_light_at_nodes(const Mesh& mesh,
                                  const Tracer& tracer,
                                  const NodeExchange& exchange,
                                  const std::vector<DirectionalLight>& lights,
                                  const Environment* environment,
                                  const FilteredEnvironment& filtered,
                                  const std::vector<bool>& lobes,
                                  const Progress& progress = {});

/// Light that came by other nodes.
struct ExchangedLight {
    std::vector<glm::vec3> on_diffuser;  ///< what a white diffuser sends of it
    NodeLight sent;                      ///< by the node itself, of all light
};
/// At each node, after so many bounces: 1, or as many as still add to it.
ExchangedLight exchanged_at_nodes(const NodeExchange& exchange,
                                  const DirectLight& direct,
                                  const NodeReflectance& reflectance,
                                  int bounces);

/// On a white diffuser at each node, what it sends of the light that nodes send.
std::vector<glm::vec3> gathered_at_nodes(const NodeExchange& exchange,
                                         std::span<const glm::vec3> sent);

/// A value of each node at the fragments, of the side that is seen. Where the nodes' mesh is a part
/// of the fragments', `place_of` says which of its triangles each of theirs is, and kNoTriangle of
/// the rest, where the value is 0; `behind_of` the same of a copy that faces the other way.
inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;
std::vector<glm::vec3> at_fragments(const Mesh& mesh,
                                    const SurfaceMap& map,
                                    const ExchangeNodes& nodes,
                                    const std::vector<glm::vec3>& at_nodes,
                                    std::span<const std::uint32_t> place_of = {},
                                    std::span<const std::uint32_t> behind_of = {});

}  // namespace livery
