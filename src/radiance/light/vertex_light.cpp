#include "radiance/light/vertex_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "radiance/light/light_visibility.h"
#include "tracing/tracer.h"

namespace livery {
namespace {

constexpr int kRaysALight = 8;
constexpr int kSkyRays = 32;

glm::vec3 normal_of_side(const Mesh& mesh, std::size_t side) {
    const std::size_t vertices = mesh.normals.size();
    return side < vertices ? mesh.normals[side] : -mesh.normals[side - vertices];
}

const glm::vec3& position_of_side(const Mesh& mesh, std::size_t side) {
    const std::size_t vertices = mesh.positions_mm.size();
    return mesh.positions_mm[side < vertices ? side : side - vertices];
}

bool same_discs(const std::vector<DirectionalLight>& a, const std::vector<DirectionalLight>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_disc);
}

bool same_map(const Environment& a, const Environment& b) {
    return a.radiance_working.width == b.radiance_working.width &&
           a.radiance_working.values == b.radiance_working.values;
}

constexpr int kGuessWidth = 32, kGuessHeight = 16;

/// Means over blocks of a latitude-longitude map.
ImageF blurred(const ImageF& map) {
    ImageF small(kGuessWidth, kGuessHeight, 3);
    for (int y = 0; y < kGuessHeight; ++y) {
        for (int x = 0; x < kGuessWidth; ++x) {
            const int left = x * map.width / kGuessWidth, top = y * map.height / kGuessHeight;
            const int right = std::max(left + 1, (x + 1) * map.width / kGuessWidth);
            const int bottom = std::max(top + 1, (y + 1) * map.height / kGuessHeight);
            glm::dvec3 sum(0.0);
            for (int v = top; v < bottom; ++v) {
                for (int u = left; u < right; ++u) {
                    for (int c = 0; c < 3; ++c) {
                        sum[c] += static_cast<double>(map.at(u, v, map.channels == 1 ? 0 : c));
                    }
                }
            }
            sum /= static_cast<double>((right - left) * (bottom - top));
            for (int c = 0; c < 3; ++c) small.at(x, y, c) = static_cast<float>(sum[c]);
        }
    }
    return small;
}

/// What a white diffuser facing each direction sends, by the sum over a small map's texels.
ImageF diffuse_of(const ImageF& map, const Environment& frame) {
    std::vector<glm::dvec3> directions;
    std::vector<double> solid_angles;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const glm::dvec2 uv((x + 0.5) / map.width, (y + 0.5) / map.height);
            directions.push_back(direction_from_uv(frame, uv));
            solid_angles.push_back(std::sin(std::numbers::pi * uv.y) * 2.0 * std::numbers::pi *
                                   std::numbers::pi / static_cast<double>(map.pixel_count()));
        }
    }
    ImageF diffuse(map.width, map.height, 3);
    for (std::size_t to = 0; to < directions.size(); ++to) {
        glm::dvec3 sum(0.0);
        for (std::size_t from = 0; from < directions.size(); ++from) {
            const double cosine = glm::dot(directions[to], directions[from]);
            if (cosine <= 0.0) continue;
            const float* rgb = map.values.data() + 3 * from;
            sum += cosine * solid_angles[from] * glm::dvec3(rgb[0], rgb[1], rgb[2]);
        }
        sum /= std::numbers::pi;
        for (int c = 0; c < 3; ++c) {
            diffuse.values[3 * to + static_cast<std::size_t>(c)] = static_cast<float>(sum[c]);
        }
    }
    return diffuse;
}

}  // namespace

std::size_t lit_sides(const Mesh& mesh) {
    const auto& sides = mesh.two_sided;
    const bool any = std::find(sides.begin(), sides.end(), true) != sides.end();
    return (any ? 2 : 1) * mesh.positions_mm.size();
}

std::shared_ptr<const VertexLight> guessed_light(const Product& product,
                                                 const std::vector<DirectionalLight>& lights,
                                                 const Environment* environment) {
    const std::size_t sides = lit_sides(product.mesh);
    auto guess = std::make_shared<VertexLight>();
    guess->guessed = true;
    guess->lights = lights;
    guess->visibility.assign(lights.size() * sides, 1.0f);
    guess->sky.assign(sides, glm::vec4(0.0f));
    if (!environment || environment->radiance_working.empty()) return guess;
    auto small = std::make_shared<Environment>();
    small->rotation_rad = environment->rotation_rad;
    small->scale = environment->scale;
    small->radiance_working = blurred(environment->radiance_working);
    auto filtered = std::make_shared<FilteredEnvironment>();
    filtered->mirrored.assign(kLayerAlphas.size(), small->radiance_working);
    Environment unturned;  // layers are in the map's own frame
    filtered->diffuse = diffuse_of(small->radiance_working, unturned);
    const auto scale = static_cast<float>(environment->scale);
    for (std::size_t i = 0; i < sides; ++i) {
        const glm::dvec2 uv =
            uv_from_direction(*small, glm::dvec3(normal_of_side(product.mesh, i)));
        guess->sky[i] = glm::vec4(scale * sample_sphere(filtered->diffuse, uv), 1.0f);
    }
    guess->filtered = std::move(filtered);
    guess->environment = std::move(small);
    return guess;
}

bool is_solved_for(const VertexLight& light,
                   const std::vector<DirectionalLight>& lights,
                   const Environment* environment) {
    return !light.guessed && light.environment.get() == environment &&
           same_discs(light.lights, lights);
}

struct VertexLightSolver::State {
    std::shared_ptr<const Product> product;
    Tracer tracer;
    std::vector<float> openness;  ///< of each vertex; solved with the first environment
    std::shared_ptr<const VertexLight> last = std::make_shared<VertexLight>();

    explicit State(std::shared_ptr<const Product> its_product)
        : product(std::move(its_product)), tracer(product->mesh) {}

    std::vector<float> solve_openness() const;
    std::vector<float> shadows(const std::vector<DirectionalLight>& lights,
                               const Progress& progress) const;
    std::vector<glm::vec4> sky(const Environment& environment, const ImageF& diffuse) const;
};

std::vector<float> VertexLightSolver::State::solve_openness() const {
    const Mesh& mesh = product->mesh;
    const std::size_t sides = lit_sides(mesh);
    if (sides == mesh.normals.size()) {
        return ambient_openness(tracer, mesh.positions_mm, mesh.normals, kSkyRays, 1e30f);
    }
    std::vector<glm::vec3> positions_mm, normals;
    for (std::size_t i = 0; i < sides; ++i) {
        positions_mm.push_back(position_of_side(mesh, i));
        normals.push_back(normal_of_side(mesh, i));
    }
    return ambient_openness(tracer, positions_mm, normals, kSkyRays, 1e30f);
}

std::vector<float> VertexLightSolver::State::shadows(const std::vector<DirectionalLight>& lights,
                                                     const Progress& progress) const {
    const Mesh& mesh = product->mesh;
    const std::size_t count = lights.size(), old_count = last->lights.size();
    std::vector<std::size_t> known(count);  // which of the last lights it is; old_count: none
    for (std::size_t k = 0; k < count; ++k) {
        const auto found =
            std::find_if(last->lights.begin(), last->lights.end(), [&](const auto& light) {
                return same_disc(light, lights[k]);
            });
        known[k] = static_cast<std::size_t>(found - last->lights.begin());
    }
    const std::size_t sides = lit_sides(mesh);
    std::vector<float> open(sides * count);
    parallel_for(sides, 1024, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t k = 0; k < count; ++k) {
                open[i * count + k] = known[k] < old_count
                                          ? last->visibility[i * old_count + known[k]]
                                          : disc_openness(tracer,
                                                          position_of_side(mesh, i),
                                                          normal_of_side(mesh, i),
                                                          lights[k],
                                                          kRaysALight,
                                                          i);
            }
        }
    });
    return open;
}

std::vector<glm::vec4> VertexLightSolver::State::sky(const Environment& environment,
                                                     const ImageF& diffuse) const {
    std::vector<glm::vec4> sky(openness.size());
    const auto scale = static_cast<float>(environment.scale);
    parallel_for(sky.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 light = sample_sphere(
                diffuse,
                uv_from_direction(environment, glm::dvec3(normal_of_side(product->mesh, i))));
            sky[i] = glm::vec4(scale * openness[i] * light, openness[i]);
        }
    });
    return sky;
}

VertexLightSolver::VertexLightSolver(std::shared_ptr<const Product> product) {
    check_argument(product != nullptr, "light at the vertices needs a product");
    state_ = std::make_unique<State>(std::move(product));
}

VertexLightSolver::~VertexLightSolver() = default;

std::shared_ptr<const VertexLight> VertexLightSolver::solve(
    const std::vector<DirectionalLight>& lights,
    std::shared_ptr<const Environment> environment,
    const Progress& progress) {
    State& s = *state_;
    const VertexLight& last = *s.last;
    if (!last.sky.empty() && is_solved_for(last, lights, environment.get())) return s.last;
    auto next = std::make_shared<VertexLight>();
    progress.update(0.0, "shadows");
    next->visibility = s.shadows(lights, progress);
    next->lights = lights;
    if (!environment) {
        next->sky.assign(lit_sides(s.product->mesh), glm::vec4(0.0f));
    } else {
        if (s.openness.empty()) {
            progress.update(0.2, "openness");
            s.openness = s.solve_openness();
        }
        const bool known = last.environment && same_map(*last.environment, *environment);
        next->filtered = known ? last.filtered
                               : std::make_shared<const FilteredEnvironment>(filter_environment(
                                     *environment, {true, true, false, false}, progress));
        next->sky = s.sky(*environment, next->filtered->diffuse);
    }
    next->environment = std::move(environment);
    s.last = std::move(next);
    return s.last;
}

}  // namespace livery
