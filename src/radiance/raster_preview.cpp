#include "radiance/raster_preview.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "gl/draw.h"
#include "gl/read_back.h"
#include "radiance/environment_filter.h"
#include "radiance/light_visibility.h"
#include "radiance/shading.h"
#include "tracing/tracer.h"

namespace livery {
namespace {

constexpr int kRaysALight = 8;
constexpr int kSkyRays = 32;
constexpr float kHalfLargest = 65000.0f;

struct Vertex {
    glm::vec3 position_mm, normal;
    glm::vec4 tangent, sky;
};

/// Vertices and triangles sorted by part, so that a part is one range of indices.
struct PartRange {
    int first = 0, count = 0;
};

}  // namespace

struct RasterPreview::State {
    std::shared_ptr<const Product> product;
    int factor;
    Tracer tracer;
    std::vector<float> openness;  ///< of each vertex; solved with the first environment

    std::vector<DirectionalLight> lights;  ///< that `visibility` was solved for
    std::shared_ptr<const Environment> environment;
    std::vector<Vertex> vertices;
    Buffer vertex_buffer, index_buffer, visibility;
    VertexArray vertex_array;
    std::vector<PartRange> parts;
    Texture2D layers;
    float layers_unit = 1.0f;
    std::map<ShadingKey, Program> programs;
    Program downsample;
    ScreenPass screen;
    Texture2D samples, depth, target;
    Framebuffer samples_framebuffer, target_framebuffer;

    State(std::shared_ptr<const Product> its_product, int supersampling);
    void resize(const View& view);
    void solve_lights(const Scene& scene, const Progress& progress);
    void solve_environment(const Scene& scene, const Progress& progress);
    void upload_layers(const Environment& scene_environment, const FilteredEnvironment& filtered);
    void draw_part(const Scene& scene, const View& view, std::size_t part);
    void set_view(Program& program, const View& view) const;
};

RasterPreview::State::State(std::shared_ptr<const Product> its_product, int supersampling)
    : product(std::move(its_product)), factor(supersampling), tracer(product->mesh) {
    const Mesh& mesh = product->mesh;
    for (std::size_t i = 0; i < mesh.positions_mm.size(); ++i) {
        vertices.push_back(
            {mesh.positions_mm[i], mesh.normals[i], mesh.tangents[i], glm::vec4(0.0f)});
    }
    vertex_buffer = Buffer(vertices);
    const int stride = sizeof(Vertex);
    vertex_array.floats(0, vertex_buffer, 3, stride, offsetof(Vertex, position_mm));
    vertex_array.floats(1, vertex_buffer, 3, stride, offsetof(Vertex, normal));
    vertex_array.floats(2, vertex_buffer, 4, stride, offsetof(Vertex, tangent));
    vertex_array.floats(3, vertex_buffer, 4, stride, offsetof(Vertex, sky));

    parts.resize(mesh.parts.size());
    std::vector<glm::uvec3> sorted;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        parts[p].first = static_cast<int>(3 * sorted.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (mesh.triangle_part[t] == p) sorted.push_back(mesh.triangles[t]);
        }
        parts[p].count = static_cast<int>(3 * sorted.size()) - parts[p].first;
    }
    index_buffer = Buffer(sorted);
    vertex_array.indices(index_buffer);
    downsample = Program::screen_pass(
        load_shader("radiance/downsample.frag", {fmt::format("FACTOR {}", factor)}));
}

void RasterPreview::State::resize(const View& view) {
    if (target && target.width() == view.width && target.height() == view.height) return;
    samples = Texture2D(factor * view.width, factor * view.height, TexelFormat::rgba16f);
    depth = Texture2D(factor * view.width, factor * view.height, TexelFormat::depth32f);
    target = Texture2D(view.width, view.height, TexelFormat::rgba16f);
    samples_framebuffer = Framebuffer({&samples}, &depth);
    target_framebuffer = Framebuffer({&target});
}

void RasterPreview::State::solve_lights(const Scene& scene, const Progress& progress) {
    const auto same = [](const DirectionalLight& a, const DirectionalLight& b) {
        return a.direction == b.direction && a.angle_rad == b.angle_rad;
    };
    if (std::equal(lights.begin(), lights.end(), scene.lights.begin(), scene.lights.end(), same)) {
        return;
    }
    progress.update(0.0, "shadows");
    const std::size_t count = scene.lights.size();
    std::vector<float> open(vertices.size() * count);
    parallel_for(vertices.size(), 1024, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t k = 0; k < count; ++k) {
                open[i * count + k] = disc_openness(tracer,
                                                    vertices[i].position_mm,
                                                    vertices[i].normal,
                                                    scene.lights[k],
                                                    kRaysALight,
                                                    i);
            }
        }
    });
    visibility = count > 0 ? Buffer(open) : Buffer();
    lights = scene.lights;
}

void RasterPreview::State::solve_environment(const Scene& scene, const Progress& progress) {
    if (environment == scene.environment) return;
    environment = scene.environment;
    if (!environment) {
        for (Vertex& vertex : vertices) vertex.sky = glm::vec4(0.0f);
        layers = Texture2D();
    } else {
        if (openness.empty()) {
            progress.update(0.2, "openness");
            openness = ambient_openness(
                tracer, product->mesh.positions_mm, product->mesh.normals, kSkyRays, 1e30f);
        }
        const FilteredEnvironment filtered =
            filter_environment(*environment, {true, true, false}, progress);
        parallel_for(vertices.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const glm::vec3 light =
                    sample_sphere(filtered.diffuse,
                                  uv_from_direction(*environment, glm::dvec3(vertices[i].normal)));
                vertices[i].sky = glm::vec4(
                    static_cast<float>(environment->scale) * openness[i] * light, openness[i]);
            }
        });
        upload_layers(*environment, filtered);
    }
    vertex_buffer.update(std::span<const Vertex>(vertices));
}

void RasterPreview::State::upload_layers(const Environment& scene_environment,
                                         const FilteredEnvironment& filtered) {
    const ImageF& sharpest = filtered.mirrored.front();
    const float largest = *std::max_element(sharpest.values.begin(), sharpest.values.end());
    const float unit = std::max(1.0f, largest / kHalfLargest);
    layers_unit = unit * static_cast<float>(scene_environment.scale);
    layers =
        Texture2D({sharpest.width, sharpest.height, static_cast<int>(filtered.mirrored.size())},
                  TexelFormat::rgba16f,
                  TexelFilter::linear,
                  TexelWrap::repeat,
                  TexelWrap::clamp);
    std::vector<float> texels(sharpest.pixel_count() * 4, 1.0f);
    for (std::size_t k = 0; k < filtered.mirrored.size(); ++k) {
        for (int y = 0; y < sharpest.height; ++y) {
            for (int x = 0; x < sharpest.width; ++x) {
                const glm::dvec2 uv((x + 0.5) / sharpest.width, (y + 0.5) / sharpest.height);
                const glm::vec3 radiance = sample_sphere(filtered.mirrored[k], uv) / unit;
                for (int c = 0; c < 3; ++c) {
                    texels[4 * (sharpest.index(x, y) / 3) + static_cast<std::size_t>(c)] =
                        radiance[c];
                }
            }
        }
        layers.upload(std::span<const float>(texels), 0, static_cast<int>(k));
    }
}

void RasterPreview::State::set_view(Program& program, const View& view) const {
    program.set("u_view_from_world", glm::mat3(view.view_from_world.rotation));
    program.set("u_translation_mm", glm::vec3(view.view_from_world.translation));
    program.set("u_lens", glm::vec4(view.focal_px, view.principal_px));
    std::array<float, 5> distortion{};
    for (std::size_t i = 0; i < 5; ++i) distortion[i] = static_cast<float>(view.distortion[i]);
    program.set("u_distortion", std::span<const float>(distortion));
    program.set("u_size_px", glm::vec2(view.width, view.height));
    const glm::dvec3 centre = centre_in_world(view);
    program.set("u_view_centre_mm", glm::vec3(centre));
    // Depths of the mesh's bounding sphere
    const Bounds bounds = bounds_of(product->mesh);
    const double middle = (view.view_from_world * (0.5 * (bounds.low + bounds.high))).z;
    const double radius = 0.5 * glm::distance(bounds.low, bounds.high) + 1.0;
    const double nearest = std::max(middle - radius, 1e-3 * (middle + radius));
    program.set("u_depth_mm", glm::vec2(nearest, middle + radius));
}

void RasterPreview::State::draw_part(const Scene& scene, const View& view, std::size_t part) {
    if (parts[part].count == 0) return;
    const Material& material = scene.part_materials[part];
    const auto count = static_cast<int>(scene.lights.size());
    const ShadingKey key{material.model, count, environment != nullptr};
    auto found = programs.find(key);
    if (found == programs.end()) {
        found = programs.emplace(key, make_shading_program(key, ShadingSource::raster)).first;
    }
    Program& program = found->second;
    set_paint(program, material, scene.exposure_ev);
    set_view(program, view);
    program.set("u_eye_mm", glm::vec3(scene.eye_in_world_mm));
    if (count > 0) {
        std::vector<glm::vec3> directions, irradiance;
        std::vector<float> radius2;
        for (const DirectionalLight& light : scene.lights) {
            directions.emplace_back(glm::normalize(light.direction));
            irradiance.push_back(std::numbers::pi_v<float> *
                                 glm::vec3(working_from_rec709() * light.radiance_rec709));
            radius2.push_back(static_cast<float>(0.25 * light.angle_rad * light.angle_rad));
        }
        program.set("u_light_direction", std::span<const glm::vec3>(directions));
        program.set("u_light_radiance", std::span<const glm::vec3>(irradiance));
        program.set("u_light_radius2", std::span<const float>(radius2));
        visibility.bind_storage_block(0);
    }
    if (environment) {
        program.set("u_layers", 0);
        program.set("u_layers_unit", layers_unit);
        program.set("u_rotation", static_cast<float>(environment->rotation_rad));
        layers.bind(0);
    }
    DrawState state;
    state.depth_test = true;
    draw_indexed(program,
                 vertex_array,
                 samples_framebuffer,
                 Primitive::triangles,
                 parts[part].first,
                 parts[part].count,
                 state);
}

RasterPreview::RasterPreview(std::shared_ptr<const Product> product, int supersampling) {
    check_argument(product != nullptr, "a preview needs a product");
    check_argument(supersampling >= 1 && supersampling <= 4,
                   fmt::format("supersampling is {}, 1 to 4 are possible", supersampling));
    state_ = std::make_unique<State>(std::move(product), supersampling);
}

RasterPreview::~RasterPreview() = default;

void RasterPreview::render(const Scene& scene, const View& view, const Progress& progress) {
    State& s = *state_;
    check_argument(scene.product == s.product, "the scene shows another product");
    check_argument(
        scene.part_materials.size() == s.parts.size(),
        fmt::format("{} materials for {} parts", scene.part_materials.size(), s.parts.size()));
    s.resize(view);
    s.solve_lights(scene, progress);
    s.solve_environment(scene, progress);
    s.samples_framebuffer.clear_colour(0, 0.0f, 0.0f, 0.0f, 0.0f);
    s.samples_framebuffer.clear_depth();
    for (std::size_t p = 0; p < s.parts.size(); ++p) s.draw_part(scene, view, p);
    s.downsample.set("u_samples", 0);
    s.samples.bind(0);
    s.screen.run(s.downsample, s.target_framebuffer);
}

ImageF RasterPreview::read_back() const { return read_floats(state_->target); }

unsigned RasterPreview::texture() const { return state_->target.name(); }

}  // namespace livery
