#include "tracing/tracer.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <glm/geometric.hpp>

#include "core/error.h"
#include "tracing/ray_counters.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace livery {

namespace {

/// Embree is slow and less robust with denormals. They are flushed only while it runs, so that
/// nobody else's arithmetic depends on whether a ray was traced on the same thread.
class FlushDenormals {
  public:
#if defined(__SSE2__)
    FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
    ~FlushDenormals() { _mm_setcsr(saved_); }

  private:
    unsigned saved_;
#else
    FlushDenormals() {}
    ~FlushDenormals() {}
#endif
  public:
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;
};

constexpr std::size_t kPacket = 8;

#if RTC_VERSION_MAJOR >= 4  // takes arguments after the rays

void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray); }

void intersect_neighbours(RTCScene scene, const int* valid, RTCRayHit8& rays) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &rays, &arguments);
}

void occlude(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }

void occlude(RTCScene scene, const int* valid, RTCRay8& rays, RayOrder order) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    if (order == RayOrder::neighbours) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &rays, &arguments);
}

#else  // takes a context before them

RTCIntersectContext context_of(RayOrder order) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (order == RayOrder::neighbours) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

void intersect(RTCScene scene, RTCRayHit& ray) {
    RTCIntersectContext context = context_of(RayOrder::scattered);
    rtcIntersect1(scene, &context, &ray);
}

void intersect_neighbours(RTCScene scene, const int* valid, RTCRayHit8& rays) {
    RTCIntersectContext context = context_of(RayOrder::neighbours);
    rtcIntersect8(valid, scene, &context, &rays);
}

void occlude(RTCScene scene, RTCRay& ray) {
    RTCIntersectContext context = context_of(RayOrder::scattered);
    rtcOccluded1(scene, &context, &ray);
}

void occlude(RTCScene scene, const int* valid, RTCRay8& rays, RayOrder order) {
    RTCIntersectContext context = context_of(order);
    rtcOccluded8(valid, scene, &context, &rays);
}

#endif

RTCRay embree_ray(const TraceRay& ray) {
    RTCRay out{};
    out.org_x = ray.origin.x;
    out.org_y = ray.origin.y;
    out.org_z = ray.origin.z;
    out.tnear = ray.t_min;
    out.dir_x = ray.direction.x;
    out.dir_y = ray.direction.y;
    out.dir_z = ray.direction.z;
    out.tfar = ray.t_max;
    out.mask = static_cast<unsigned>(-1);
    return out;
}

void set_lane(RTCRay8& packet, std::size_t lane, const TraceRay& ray) {
    packet.org_x[lane] = ray.origin.x;
    packet.org_y[lane] = ray.origin.y;
    packet.org_z[lane] = ray.origin.z;
    packet.tnear[lane] = ray.t_min;
    packet.dir_x[lane] = ray.direction.x;
    packet.dir_y[lane] = ray.direction.y;
    packet.dir_z[lane] = ray.direction.z;
    packet.tfar[lane] = ray.t_max;
    packet.time[lane] = 0.0f;
    packet.mask[lane] = static_cast<unsigned>(-1);
    packet.id[lane] = static_cast<unsigned>(lane);
    packet.flags[lane] = 0;
}

void forget_hit(RTCRayHit8& packet, std::size_t lane) {
    packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
}

/// Of the packet's first lanes, one a hit.
void read_hits(const RTCRayHit8& packet, std::span<Hit> hits) {
    for (std::size_t lane = 0; lane < hits.size(); ++lane) {
        hits[lane] = {};
        if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
        hits[lane] = {packet.hit.primID[lane],
                      packet.ray.tfar[lane],
                      {packet.hit.u[lane], packet.hit.v[lane]}};
    }
}

/// Runs work(first, count, valid) over packets of up to eight.
template <typename Work>
void for_each_packet(std::size_t count, const Work& work) {
    const FlushDenormals flush;
    for (std::size_t first = 0; first < count; first += kPacket) {
        const std::size_t in_packet = std::min(kPacket, count - first);
        alignas(32) std::array<int, kPacket> valid{};
        std::fill_n(valid.begin(), in_packet, -1);
        work(first, in_packet, valid.data());
    }
}

void fill_geometry(RTCGeometry geometry, const Mesh& mesh) {
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry,
                                                                 RTC_BUFFER_TYPE_VERTEX,
                                                                 0,
                                                                 RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float),
                                                                 mesh.positions_mm.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry,
                                                                   RTC_BUFFER_TYPE_INDEX,
                                                                   0,
                                                                   RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned),
                                                                   mesh.triangles.size()));
    if (!vertices || !indices) throw std::bad_alloc();
    for (const auto& position : mesh.positions_mm) {
        vertices = std::copy_n(&position.x, 3, vertices);
    }
    for (const auto& triangle : mesh.triangles) indices = std::copy_n(&triangle.x, 3, indices);
}

}  // namespace

struct Tracer::State {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    void check(const char* step) const {
        const RTCError error = rtcGetDeviceError(device);
        if (error == RTC_ERROR_NONE) return;
        throw std::runtime_error("Embree cannot " + std::string(step) + ": error " +
                                 std::to_string(static_cast<int>(error)));
    }
};

Tracer::Tracer(const Mesh& mesh) : state_(std::make_unique<State>()) {
    for (const auto& triangle : mesh.triangles) {
        check_argument(std::max({triangle.x, triangle.y, triangle.z}) < mesh.positions_mm.size(),
                       "Tracer: a triangle names a vertex that the mesh does not have");
    }
    state_->device = rtcNewDevice(nullptr);
    if (!state_->device) state_->check("start");
    state_->scene = rtcNewScene(state_->device);
    // Robust: no ray slips through the edge that two triangles share.
    rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_MEDIUM);
    if (!mesh.triangles.empty()) {
        RTCGeometry geometry = rtcNewGeometry(state_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        fill_geometry(geometry, mesh);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(state_->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(state_->scene);
    state_->check("build the scene");
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

Hit Tracer::closest(const TraceRay& ray) const {
    tracing_detail::count_closest(1);
    const FlushDenormals flush;
    RTCRayHit query{};
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(state_->scene, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.hit.primID, query.ray.tfar, {query.hit.u, query.hit.v}};
}

bool Tracer::occluded(const TraceRay& ray) const {
    tracing_detail::count_occluded(1);
    const FlushDenormals flush;
    RTCRay query = embree_ray(ray);
    occlude(state_->scene, query);
    return query.tfar < 0.0f;  // Embree writes minus infinity
}

void Tracer::closest(std::span<const TraceRay> rays, std::span<Hit> hits) const {
    check_argument(rays.size() == hits.size(), "closest: as many hits as rays are needed");
    tracing_detail::count_closest(rays.size());
    for_each_packet(rays.size(), [&](std::size_t first, std::size_t count, const int* valid) {
        RTCRayHit8 packet;
        for (std::size_t lane = 0; lane < kPacket; ++lane) {
            set_lane(packet.ray, lane, rays[first + std::min(lane, count - 1)]);
            forget_hit(packet, lane);
        }
        intersect_neighbours(state_->scene, valid, packet);
        read_hits(packet, hits.subspan(first, count));
    });
}

void Tracer::closest_from(const glm::vec3& origin,
                          std::span<const glm::vec3> directions,
                          std::span<Hit> hits) const {
    check_argument(directions.size() == hits.size(),
                   "closest_from: as many hits as directions are needed");
    tracing_detail::count_closest(directions.size());
    RTCRayHit8 packet{};
    for (std::size_t lane = 0; lane < kPacket; ++lane) {
        TraceRay ray;
        ray.origin = origin;
        set_lane(packet.ray, lane, ray);
    }
    for_each_packet(directions.size(), [&](std::size_t first, std::size_t count, int* valid) {
        for (std::size_t lane = 0; lane < kPacket; ++lane) {
            const glm::vec3 direction = directions[first + std::min(lane, count - 1)];
            if (direction == glm::vec3(0.0f)) valid[lane] = 0;
            packet.ray.dir_x[lane] = direction.x;
            packet.ray.dir_y[lane] = direction.y;
            packet.ray.dir_z[lane] = direction.z;
            packet.ray.tfar[lane] = TraceRay{}.t_max;
            forget_hit(packet, lane);
        }
        intersect_neighbours(state_->scene, valid, packet);
        read_hits(packet, hits.subspan(first, count));
    });
}

void Tracer::occluded(std::span<const TraceRay> rays,
                      std::span<std::uint8_t> blocked,
                      RayOrder order) const {
    check_argument(rays.size() == blocked.size(), "occluded: as many answers as rays are needed");
    tracing_detail::count_occluded(rays.size());
    for_each_packet(rays.size(), [&](std::size_t first, std::size_t count, const int* valid) {
        RTCRay8 packet;
        for (std::size_t lane = 0; lane < kPacket; ++lane) {
            set_lane(packet, lane, rays[first + std::min(lane, count - 1)]);
        }
        occlude(state_->scene, valid, packet, order);
        for (std::size_t lane = 0; lane < count; ++lane) {
            blocked[first + lane] = packet.tfar[lane] < 0.0f ? 1 : 0;
        }
    });
}

namespace {

/// None of a triangle without area.
glm::vec3 geometric_normal(const Mesh& mesh, std::uint32_t triangle) {
    const glm::uvec3 corner = mesh.triangles[triangle];
    const glm::vec3 a = mesh.positions_mm[corner.x];
    const glm::vec3 ab = mesh.positions_mm[corner.y] - a, ac = mesh.positions_mm[corner.z] - a;
    const glm::dvec3 across = glm::cross(glm::dvec3(ab), glm::dvec3(ac));
    const double twice_area = glm::length(across);
    return twice_area > 0.0 ? glm::vec3(across / twice_area) : glm::vec3(0.0f);
}

}  // namespace

glm::vec3 shading_normal(const Mesh& mesh, const Hit& hit) {
    const glm::uvec3 corner = mesh.triangles[hit.triangle];
    const float v = hit.barycentric.x, w = hit.barycentric.y, u = 1.0f - v - w;
    const glm::vec3 normal =
        u * mesh.normals[corner.x] + v * mesh.normals[corner.y] + w * mesh.normals[corner.z];
    const float length = glm::length(normal);
    // Opposite vertex normals cancel halfway: the triangle's own normal is the answer there.
    return length > 1e-6f ? normal / length : geometric_normal(mesh, hit.triangle);
}

SurfacePoint surface_point(const Mesh& mesh, const Hit& hit) {
    check_argument(hit.valid() && hit.triangle < mesh.triangles.size(),
                   "surface_point: the hit is not on this mesh");
    const glm::uvec3 corner = mesh.triangles[hit.triangle];
    const float v = hit.barycentric.x, w = hit.barycentric.y, u = 1.0f - v - w;
    const auto blend = [&](const auto& values) {
        return u * values[corner.x] + v * values[corner.y] + w * values[corner.z];
    };
    const glm::vec3 a = mesh.positions_mm[corner.x];
    const glm::vec3 ab = mesh.positions_mm[corner.y] - a, ac = mesh.positions_mm[corner.z] - a;

    SurfacePoint point;
    // From a corner and two edges: exact on the plane of a far-away triangle to its own size.
    point.position_mm = a + v * ab + w * ac;
    point.geometric_normal = geometric_normal(mesh, hit.triangle);

    point.normal = shading_normal(mesh, hit);

    // The tangent is made orthogonal to the interpolated normal again.
    const glm::vec4 tangent = blend(mesh.tangents);
    const glm::vec3 along(tangent);
    glm::vec3 flat = along - point.normal * glm::dot(point.normal, along);
    if (glm::length(flat) < 1e-6f) flat = ab - point.normal * glm::dot(point.normal, ab);
    point.tangent = glm::vec4(glm::normalize(flat), tangent.w < 0.0f ? -1.0f : 1.0f);

    if (!mesh.uvs.empty()) point.uv = blend(mesh.uvs);
    point.part = mesh.triangle_part[hit.triangle];
    return point;
}

bool sees_back(const Mesh& mesh, const Hit& hit, const glm::vec3& direction) {
    const glm::uvec3 corner = mesh.triangles[hit.triangle];
    const glm::dvec3 a(mesh.positions_mm[corner.x]);
    const glm::dvec3 outward = glm::cross(glm::dvec3(mesh.positions_mm[corner.y]) - a,
                                          glm::dvec3(mesh.positions_mm[corner.z]) - a);
    return glm::dot(outward, glm::dvec3(direction)) >= 0.0;
}

glm::vec3 offset_origin(const glm::vec3& position, const glm::vec3& geometric_normal) {
    // As in Waechter and Binder, "A fast and robust method for avoiding self-intersection" (2019),
    // a number of representable steps along the normal. Steps are those of the largest coordinate,
    // not of each: a point of a leaning plane errs with all of them. Sixteen steps still failed in
    // a sweep over sizes and places. Near the origin the triangle's own size decides, which is not
    // known here: triangles of a metre need the two micrometres that the smallest scale gives.
    constexpr float step = 0x1p-23f, steps = 64.0f, smallest_scale_mm = 256.0f;
    const glm::vec3 size = glm::abs(position);
    const float scale_mm = std::max({size.x, size.y, size.z, smallest_scale_mm});
    return position + steps * step * scale_mm * geometric_normal;
}

}  // namespace livery
