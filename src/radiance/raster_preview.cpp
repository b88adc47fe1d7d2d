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
#include "gl/draw.h"
#include "gl/read_back.h"
#include "radiance/environment_filter.h"
#include "radiance/shading.h"

namespace livery {
namespace {

constexpr float kHalfLargest = 65000.0f;

constexpr const char* kFlatFragment = R"(#version 450 core
uniform float u_value;
layout(location = 0) out vec4 value;
void main() { value = vec4(u_value, 0.0, 0.0, 1.0); }
)";

struct Vertex {
    glm::vec3 position_mm, normal;
    glm::vec4 tangent;
};

/// Vertices and triangles sorted by part, so that a part is one range of indices.
struct PartRange {
    int first = 0, count = 0;
};

/// What a picture is drawn into: samples, and pixels that are their mean.
struct Target {
    Texture2D samples, depth, pixels;
    Framebuffer samples_framebuffer, pixels_framebuffer;

    void resize(int width, int height, int factor, TexelFormat format) {
        if (pixels && pixels.width() == width && pixels.height() == height &&
            samples.width() == factor * width) {
            return;
        }
        samples = Texture2D(factor * width, factor * height, format);
        depth = Texture2D(factor * width, factor * height, TexelFormat::depth32f);
        pixels = Texture2D(width, height, format);
        samples_framebuffer = Framebuffer({&samples}, &depth);
        pixels_framebuffer = Framebuffer({&pixels});
    }
    void clear() const {
        samples_framebuffer.clear_colour(0, 0.0f, 0.0f, 0.0f, 0.0f);
        samples_framebuffer.clear_depth();
    }
};

void check_supersampling(int supersampling) {
    check_argument(supersampling >= 1 && supersampling <= 4,
                   fmt::format("supersampling is {}, 1 to 4 are possible", supersampling));
}

}  // namespace

struct RasterPreview::State {
    std::shared_ptr<const Product> product;
    int factor;
    std::unique_ptr<VertexLightSolver> solver;  ///< made when light is first solved here

    std::shared_ptr<const VertexLight> light;
    Buffer vertex_buffer, sky_buffer, index_buffer, visibility;
    VertexArray vertex_array;
    std::vector<PartRange> parts;
    std::shared_ptr<const FilteredEnvironment> uploaded;  ///< that `layers` holds
    Texture2D layers;
    float layers_unit = 1.0f;  ///< radiance of a value of 1, before the environment's scale
    std::map<ShadingKey, Program> programs;
    std::map<int, Program> downsamples;  ///< by factor
    Program flat;
    ScreenPass screen;
    Target target, coverage;
    View view;  ///< of the last picture

    State(std::shared_ptr<const Product> its_product, int supersampling);
    void upload_layers(const FilteredEnvironment& filtered);
    void draw_part(const Scene& scene, std::size_t part);
    void draw_range(const Program& program, const Target& into, std::size_t part);
    void downsample(const Target& from);
    void set_view(Program& program) const;
    Program& shading_program(const ShadingKey& key);
};

RasterPreview::State::State(std::shared_ptr<const Product> its_product, int supersampling)
    : product(std::move(its_product)), factor(supersampling) {
    const Mesh& mesh = product->mesh;
    std::vector<Vertex> vertices;
    for (std::size_t i = 0; i < mesh.positions_mm.size(); ++i) {
        vertices.push_back({mesh.positions_mm[i], mesh.normals[i], mesh.tangents[i]});
    }
    vertex_buffer = Buffer(vertices);
    sky_buffer = Buffer(vertices.size() * sizeof(glm::vec4));
    const int stride = sizeof(Vertex);
    vertex_array.floats(0, vertex_buffer, 3, stride, offsetof(Vertex, position_mm));
    vertex_array.floats(1, vertex_buffer, 3, stride, offsetof(Vertex, normal));
    vertex_array.floats(2, vertex_buffer, 4, stride, offsetof(Vertex, tangent));
    vertex_array.floats(3, sky_buffer, 4, sizeof(glm::vec4));

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
}

void RasterPreview::State::upload_layers(const FilteredEnvironment& filtered) {
    const ImageF& sharpest = filtered.mirrored.front();
    const float largest = *std::max_element(sharpest.values.begin(), sharpest.values.end());
    const float unit = std::max(1.0f, largest / kHalfLargest);
    layers_unit = unit;
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

void RasterPreview::State::set_view(Program& program) const {
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

Program& RasterPreview::State::shading_program(const ShadingKey& key) {
    auto found = programs.find(key);
    if (found == programs.end()) {
        found = programs.emplace(key, make_shading_program(key, ShadingSource::raster)).first;
    }
    return found->second;
}

void RasterPreview::State::draw_range(const Program& program,
                                      const Target& into,
                                      std::size_t part) {
    DrawState state;
    state.depth_test = true;
    draw_indexed(program,
                 vertex_array,
                 into.samples_framebuffer,
                 Primitive::triangles,
                 parts[part].first,
                 parts[part].count,
                 state);
}

void RasterPreview::State::draw_part(const Scene& scene, std::size_t part) {
    if (parts[part].count == 0) return;
    const Material& material = scene.part_materials[part];
    const std::vector<DirectionalLight>& lights =
        is_solved_for(*light, scene.lights, light->environment.get()) ? scene.lights
                                                                      : light->lights;
    const auto count = static_cast<int>(lights.size());
    Program& program = shading_program({material.model, count, light->environment != nullptr});
    set_paint(program, material, scene.exposure_ev);
    set_view(program);
    program.set("u_eye_mm", glm::vec3(scene.eye_in_world_mm));
    if (count > 0) {
        std::vector<glm::vec3> directions, irradiance;
        std::vector<float> radius2;
        for (const DirectionalLight& one : lights) {
            directions.emplace_back(glm::normalize(one.direction));
            irradiance.push_back(std::numbers::pi_v<float> *
                                 glm::vec3(working_from_rec709() * one.radiance_rec709));
            radius2.push_back(static_cast<float>(0.25 * one.angle_rad * one.angle_rad));
        }
        program.set("u_light_direction", std::span<const glm::vec3>(directions));
        program.set("u_light_radiance", std::span<const glm::vec3>(irradiance));
        program.set("u_light_radius2", std::span<const float>(radius2));
        visibility.bind_storage_block(0);
    }
    if (light->environment) {
        program.set("u_layers", 0);
        program.set("u_layers_unit", layers_unit * static_cast<float>(light->environment->scale));
        program.set("u_rotation", static_cast<float>(light->environment->rotation_rad));
        layers.bind(0);
    }
    draw_range(program, target, part);
}

void RasterPreview::State::downsample(const Target& from) {
    auto found = downsamples.find(factor);
    if (found == downsamples.end()) {
        found = downsamples
                    .emplace(factor,
                             Program::screen_pass(load_shader("radiance/downsample.frag",
                                                              {fmt::format("FACTOR {}", factor)})))
                    .first;
    }
    found->second.set("u_samples", 0);
    from.samples.bind(0);
    screen.run(found->second, from.pixels_framebuffer);
}

RasterPreview::RasterPreview(std::shared_ptr<const Product> product, int supersampling) {
    check_argument(product != nullptr, "a preview needs a product");
    check_supersampling(supersampling);
    state_ = std::make_unique<State>(std::move(product), supersampling);
}

RasterPreview::~RasterPreview() = default;

void RasterPreview::set_supersampling(int supersampling) {
    check_supersampling(supersampling);
    state_->factor = supersampling;
}

void RasterPreview::render(const Scene& scene, const View& view, const Progress& progress) {
    State& s = *state_;
    check_argument(scene.product == s.product, "the scene shows another product");
    if (!s.solver) s.solver = std::make_unique<VertexLightSolver>(s.product);
    take(s.solver->solve(scene.lights, scene.environment, progress));
    draw(scene, view);
}

void RasterPreview::take(std::shared_ptr<const VertexLight> light) {
    State& s = *state_;
    check_argument(light != nullptr, "a preview was given no light");
    const std::size_t vertices = s.product->mesh.positions_mm.size();
    check_argument(light->sky.size() == vertices,
                   fmt::format("light at {} vertices for {}", light->sky.size(), vertices));
    if (light == s.light) return;
    s.light = std::move(light);
    s.sky_buffer.update(std::span<const glm::vec4>(s.light->sky));
    s.visibility = s.light->lights.empty() ? Buffer() : Buffer(s.light->visibility);
    if (s.light->filtered && s.light->filtered != s.uploaded) s.upload_layers(*s.light->filtered);
    s.uploaded = s.light->filtered;
    if (!s.uploaded) s.layers = Texture2D();
}

void RasterPreview::draw(const Scene& scene, const View& view) {
    State& s = *state_;
    check_argument(scene.product == s.product, "the scene shows another product");
    check_argument(
        scene.part_materials.size() == s.parts.size(),
        fmt::format("{} materials for {} parts", scene.part_materials.size(), s.parts.size()));
    check_argument(s.light != nullptr, "a preview is drawn without light");
    s.view = view;
    s.target.resize(view.width, view.height, s.factor, TexelFormat::rgba16f);
    s.target.clear();
    for (std::size_t p = 0; p < s.parts.size(); ++p) s.draw_part(scene, p);
    s.downsample(s.target);
}

unsigned RasterPreview::draw_part_coverage(std::size_t part) {
    State& s = *state_;
    check_argument(part < s.parts.size(),
                   fmt::format("part {} of {}, counted from 0", part, s.parts.size()));
    check_argument(s.view.width > 0, "a part's coverage is of a picture, and there is none yet");
    if (!s.flat)
        s.flat = Program(load_shader("radiance/raster.vert", {"LIGHTS 0"}),
                         ShaderSource{"part coverage", kFlatFragment});
    s.coverage.resize(s.view.width, s.view.height, s.factor, TexelFormat::rgba8);
    s.coverage.clear();
    s.set_view(s.flat);
    for (std::size_t p = 0; p < s.parts.size(); ++p) {
        if (s.parts[p].count == 0) continue;
        s.flat.set("u_value", p == part ? 1.0f : 0.0f);
        s.draw_range(s.flat, s.coverage, p);
    }
    s.downsample(s.coverage);
    return s.coverage.pixels.name();
}

ImageF RasterPreview::read_back() const { return read_floats(state_->target.pixels); }

unsigned RasterPreview::texture() const { return state_->target.pixels.name(); }

}  // namespace livery
