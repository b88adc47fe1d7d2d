// The scene's triangles in Embree: nearest hits and shadow rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "mesh/mesh.h"

namespace livery {

inline constexpr float kEndless_mm = 1e30f;

struct TraceRay {
    glm::vec3 origin{0.0f};
    float t_min = 0.0f;
    glm::vec3 direction{0.0f, 0.0f, 1.0f};
    float t_max = kEndless_mm;
};

struct Hit {
    std::uint32_t triangle = kNone;
    float t = 0.0f;
    glm::vec2 barycentric{0.0f};  ///< weights of the triangle's second and third vertex
    static constexpr std::uint32_t kNone = 0xffffffffu;
    bool valid() const { return triangle != kNone; }
};

/// A point of the surface with interpolated attributes. Normals are unit and on the outside.
struct SurfacePoint {
    glm::vec3 position_mm{0.0f};
    glm::vec3 geometric_normal{0.0f};
    glm::vec3 normal{0.0f};
    glm::vec4 tangent{0.0f};
    glm::vec2 uv{0.0f};
    std::uint16_t part = 0;
};

/// How rays that follow one another go: told for speed, answers are the same.
enum class RayOrder {
    neighbours,  ///< the same way
    scattered    ///< from near places into all directions
};

/// Owns Embree's device and scene; keeps a copy of nothing else. Safe to use from many threads.
class Tracer {
  public:
    explicit Tracer(const Mesh& mesh);
    ~Tracer();
    Tracer(Tracer&&) noexcept;
    Tracer& operator=(Tracer&&) noexcept;

    Hit closest(const TraceRay& ray) const;
    bool occluded(const TraceRay& ray) const;
    /// Eight at a time inside. Sizes must agree.
    void closest(std::span<const TraceRay> rays, std::span<Hit> hits) const;
    void occluded(std::span<const TraceRay> rays,
                  std::span<std::uint8_t> blocked,
                  RayOrder order = RayOrder::neighbours) const;
    /// Neighbouring rays from one point, as of a picture; directions of any length, in which t is
    /// counted; those of no length hit nothing.
    void closest_from(const glm::vec3& origin,
                      std::span<const glm::vec3> directions,
                      std::span<Hit> hits) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

SurfacePoint surface_point(const Mesh& mesh, const Hit& hit);
/// Its normal alone.
glm::vec3 shading_normal(const Mesh& mesh, const Hit& hit);

/// Whether a ray meets the back of the triangle, or its edge.
bool sees_back(const Mesh& mesh, const Hit& hit, const glm::vec3& direction);

/// An origin for a ray that leaves the surface without hitting it again: a few float steps of the
/// largest coordinate along the geometric normal, at least 2 micrometres.
glm::vec3 offset_origin(const glm::vec3& position, const glm::vec3& geometric_normal);

/// For each point the fraction of cosine-weighted sky that is open, `ray_count` rays a point,
/// rotated by a hash of the point's index.
std::vector<float> ambient_openness(const Tracer& tracer,
                                    std::span<const glm::vec3> positions_mm,
                                    std::span<const glm::vec3> normals,
                                    int ray_count,
                                    float max_distance_mm);

}  // namespace livery
