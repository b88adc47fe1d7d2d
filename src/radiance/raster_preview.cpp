#include "radiance/raster_preview.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "core/error.h"
#include "gl/draw.h"
#include "gl/handles.h"
#include "gl/program.h"
#include "gl/read_back.h"
#include "radiance/glints.h"
#include "radiance/light/environment_filter.h"
#include "radiance/packed_fragments.h"
#include "radiance/shading.h"
#include "scene/artwork_cover.h"
#include "scene/scene.h"

namespace livery {

namespace {

/// Pictures of artwork in OpenGL, of at most 2048 texels a side.
class ArtworkTextures {
  public:
    /// Uniforms and the picture of an artwork, but not its paint; the picture is made when it is
    /// first asked for.
    void set(Program& program, const PartArtwork& artwork);
    /// The same of a part's relief.
    void set_relief(Program& program, const PartArtwork& relief);
    /// Frees the pictures that a scene does not have.
    void keep(const Scene& scene);

  private:
    struct Picture {
        std::shared_ptr<const ArtworkPicture> of;
        PictureUse use = PictureUse::cover;
        bool repeat = false;
        std::vector<float> pigment_response;
        Texture2D layers;
    };
    const Texture2D& layers_of(const PartArtwork& artwork);

    std::vector<Picture> pictures_;
};

constexpr int kMostTexels = 2048;  // a side
/// Above all units that a sample's other inputs take.
constexpr unsigned kPictureUnit = 6, kReliefUnit = 7;

Texture2D texture_of(const FilteredPicture& picture) {
    const ImageF& image = picture.level_within(kMostTexels);
    const auto channels = static_cast<std::size_t>(image.channels);
    const TexelWrap wrap = picture.repeats() ? TexelWrap::repeat : TexelWrap::clamp;
    const auto longer = static_cast<unsigned>(std::max(image.width, image.height));
    Texture2D texture(
        {image.width, image.height, image.channels / 4, static_cast<int>(std::bit_width(longer))},
        TexelFormat::rgba16f,
        TexelFilter::mipmapped,
        wrap,
        wrap);
    std::vector<float> texels(4 * image.pixel_count());
    for (std::size_t layer = 0; layer < channels / 4; ++layer) {
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
            std::copy_n(&image.values[channels * i + 4 * layer], 4, &texels[4 * i]);
        }
        texture.upload(std::span<const float>(texels), 0, static_cast<int>(layer));
    }
    texture.make_mipmaps();
    return texture;
}

void set_place(Program& program, const std::string& name, const PartArtwork& artwork) {
    const ArtworkPlace& place = artwork.artwork.place;
    const ArtworkPlane plane = plane_of(place);
    const PictureFrame picture = artwork.picture ? picture_frame(artwork) : PictureFrame();
    program.set(name + ".centre_mm", glm::vec3(plane.centre_mm));
    program.set(name + ".s", glm::vec3(plane.s_axis));
    program.set(name + ".t", glm::vec3(plane.t_axis));
    program.set(name + ".toward", glm::vec3(plane.toward));
    program.set(name + ".through", place.through ? 1 : 0);
    program.set(name + ".by_uv", place.by_uv ? 1 : 0);
    program.set(name + ".repeat", artwork.artwork.repeat ? 1 : 0);
    program.set(name + ".picture", glm::vec4(picture.scale, picture.offset));
}

const Texture2D& ArtworkTextures::layers_of(const PartArtwork& artwork) {
    const Artwork& how = artwork.artwork;
    for (const Picture& known : pictures_) {
        if (known.of == artwork.picture && known.use == how.use && known.repeat == how.repeat &&
            known.pigment_response == artwork.pigment_response) {
            return known.layers;
        }
    }
    const FilteredPicture filtered(
        picture_layers(*artwork.picture, how.use, artwork.pigment_response), how.repeat);
    pictures_.push_back(
        {artwork.picture, how.use, how.repeat, artwork.pigment_response, texture_of(filtered)});
    return pictures_.back().layers;
}

void ArtworkTextures::set(Program& program, const PartArtwork& artwork) {
    const Artwork& how = artwork.artwork;
    program.set("u_shape", static_cast<int>(how.shape));
    program.set("u_size", glm::vec3(how.size_mm, how.share, how.softness_mm));
    set_place(program, "u_place", artwork);
    program.set("u_artwork", static_cast<int>(kPictureUnit));
    if (artwork.picture) layers_of(artwork).bind(kPictureUnit);
}

void ArtworkTextures::set_relief(Program& program, const PartArtwork& relief) {
    set_place(program, "u_relief_place", relief);
    program.set("u_relief_depth", static_cast<float>(relief.artwork.depth));
    program.set("u_relief", static_cast<int>(kReliefUnit));
    layers_of(relief).bind(kReliefUnit);
}

void ArtworkTextures::keep(const Scene& scene) {
    std::erase_if(pictures_, [&](const Picture& picture) {
        const auto has_it = [&](const PartArtwork& one) { return one.picture == picture.of; };
        return std::none_of(scene.artwork.begin(), scene.artwork.end(), has_it) &&
               std::none_of(scene.relief.begin(), scene.relief.end(), has_it);
    });
}

constexpr std::size_t kMostTriangles = 1u << 24u;  // that floats count exactly
constexpr int kMostRows = 16384;                   // of a texture

/// Depth that stands for a part: exact in every float.
float depth_of_part(std::size_t part) { return static_cast<float>(part) / 65536.0f; }

/// Values as texels of a texture that has kMeshRow in a row.
template <typename T, typename Component>
Texture2D texels_of(const std::vector<T>& values, TexelFormat format) {
    constexpr auto kComponents = sizeof(T) / sizeof(Component);
    const int rows = static_cast<int>(values.size() / kMeshRow) + 1;
    check_argument(rows <= kMostRows,
                   fmt::format("a preview of a mesh of {} values, {} are possible",
                               values.size(),
                               kMostRows * kMeshRow - 1));
    std::vector<Component> padded(kComponents * static_cast<std::size_t>(rows * kMeshRow));
    const auto* from = reinterpret_cast<const Component*>(values.data());
    std::copy(from, from + kComponents * values.size(), padded.begin());
    Texture2D texture(kMeshRow, rows, format);
    texture.upload(std::span<const Component>(padded));
    return texture;
}
Texture2D float_texels(const std::vector<glm::vec4>& values) {
    return texels_of<glm::vec4, float>(values, TexelFormat::rgba32f);
}

/// Four lights a texel, (lights + 3) / 4 texels a vertex; none without lights.
Texture2D visibility_texels(const VertexLight& light) {
    const std::size_t lights = light.lights.size(), texels = (lights + 3) / 4;
    if (lights == 0) return {};
    std::vector<glm::vec4> packed(texels * light.sky.size(), glm::vec4(0.0f));
    for (std::size_t i = 0; i < light.visibility.size(); ++i) {
        const std::size_t vertex = i / lights, k = i % lights;
        packed[vertex * texels + k / 4][static_cast<int>(k % 4)] = light.visibility[i];
    }
    return float_texels(packed);
}

/// Vertices and triangles sorted by part, so that a part is one range of indices.
struct PartRange {
    int first = 0, count = 0;
    Bounds bounds;
    PixelRect covered;  ///< pixels beyond it show nothing of the part
};

Bounds bounds_of(const Mesh& mesh, std::span<const glm::uvec3> triangles) {
    Bounds bounds{glm::dvec3(1e300), glm::dvec3(-1e300)};
    for (const glm::uvec3& triangle : triangles) {
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 position(mesh.positions_mm[triangle[k]]);
            bounds.low = glm::min(bounds.low, position);
            bounds.high = glm::max(bounds.high, position);
        }
    }
    return bounds;
}

/// The pixels in which something inside of bounds may be seen; all of them when in doubt.
PixelRect covered_by(const Bounds& bounds, const View& view) {
    const glm::dvec2 size(view.width, view.height);
    glm::dvec2 low(size), high(0.0);
    for (unsigned k = 0; k < 8; ++k) {
        const glm::dvec3 corner((k & 1u) ? bounds.high.x : bounds.low.x,
                                (k & 2u) ? bounds.high.y : bounds.low.y,
                                (k & 4u) ? bounds.high.z : bounds.low.z);
        const auto pixel = project(view, corner);
        if (!pixel) return {0, 0, view.width, view.height};
        low = glm::min(low, *pixel);
        high = glm::max(high, *pixel);
    }
    // A lens bends the edges between the corners a little outward
    const glm::dvec2 margin = 2.0 + 0.1 * (high - low);
    low = glm::clamp(glm::floor(low - margin), glm::dvec2(0.0), size);
    high = glm::clamp(glm::ceil(high + margin), low, size);
    return {static_cast<int>(low.x),
            static_cast<int>(low.y),
            static_cast<int>(high.x - low.x),
            static_cast<int>(high.y - low.y)};
}

PixelRect scaled(const PixelRect& rect, int factor) {
    return {factor * rect.x, factor * rect.y, factor * rect.width, factor * rect.height};
}

/// What a picture is drawn into: the triangle that each sample shows, its part as a depth, its
/// radiance; and pixels that are the mean of their samples.
struct Targets {
    int factor = 0;
    Texture2D triangles, depth, part_depth, samples, pixels, coverage_samples, coverage;
    Framebuffer to_triangles, to_part_depth, to_samples, to_pixels, to_coverage_samples,
        to_coverage;

    void resize(int width, int height, int samples_a_side) {
        if (pixels && pixels.width() == width && pixels.height() == height &&
            factor == samples_a_side) {
            return;
        }
        factor = samples_a_side;
        const int across = factor * width, down = factor * height;
        triangles = Texture2D(across, down, TexelFormat::r32f);
        depth = Texture2D(across, down, TexelFormat::depth32f);
        part_depth = Texture2D(across, down, TexelFormat::depth32f);
        samples = Texture2D(across, down, TexelFormat::rgba16f);
        pixels = Texture2D(width, height, TexelFormat::rgba16f);
        to_triangles = Framebuffer({&triangles}, &depth);
        to_part_depth = Framebuffer({}, &part_depth);
        to_samples = Framebuffer({&samples}, &part_depth);
        to_pixels = Framebuffer({&pixels});
        coverage = Texture2D();  // made when asked for
    }
    void make_coverage() {
        if (coverage) return;
        coverage_samples = Texture2D(triangles.width(), triangles.height(), TexelFormat::rgba8);
        coverage = Texture2D(pixels.width(), pixels.height(), TexelFormat::rgba8);
        to_coverage_samples = Framebuffer({&coverage_samples});
        to_coverage = Framebuffer({&coverage});
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
    Buffer position_buffer, index_buffer;
    Texture2D vertices, corners, sky, visibility;  ///< as inputs_raster.glsl has them
    std::size_t first_back = 0;  ///< of a vertex's back less that vertex; 0: none is lit
    VertexArray vertex_array;
    std::vector<PartRange> parts;
    std::shared_ptr<const FilteredEnvironment> uploaded;  ///< that `layers` holds
    Texture2D layers;
    float layers_unit = 1.0f;  ///< radiance of a value of 1, before the environment's scale
    std::map<ShadingKey, Program> programs;
    std::map<int, Program> downsamples;  ///< by factor
    Program find_triangles, find_parts, find_coverage;
    ScreenPass screen;
    Targets target;
    View view;  ///< of the last picture
    std::optional<View> glint_view;
    bool samples_found = false;  ///< `target` has its triangles
    Bounds bounds;
    PixelRect covered;  ///< pixels beyond it show nothing of the product

    State(std::shared_ptr<const Product> its_product, int supersampling);
    void upload_layers(const FilteredEnvironment& filtered);
    void find_samples(const View& new_view);
    void shade_part(const Scene& scene, std::size_t part);
    Program& ready(const Scene& scene, const Material& paint, std::size_t part, bool over);
    void shade_artwork(const Scene& scene, const PartArtwork& artwork);
    void downsample(const Texture2D& from, const Framebuffer& to);
    void set_view(Program& program) const;
    Program& shading_program(const ShadingKey& key);
    MeasuredTextures measured;
    ArtworkTextures textures;
};

RasterPreview::State::State(std::shared_ptr<const Product> its_product, int supersampling)
    : product(std::move(its_product)), factor(supersampling) {
    const Mesh& mesh = product->mesh;
    position_buffer = Buffer(mesh.positions_mm);
    vertex_array.floats(0, position_buffer, 3, sizeof(glm::vec3));
    std::vector<glm::vec4> attributes;
    for (std::size_t i = 0; i < mesh.positions_mm.size(); ++i) {
        attributes.emplace_back(mesh.positions_mm[i], mesh.uvs[i].x);
        attributes.emplace_back(mesh.normals[i], mesh.uvs[i].y);
        attributes.push_back(mesh.tangents[i]);
    }
    vertices = float_texels(attributes);

    bounds = livery::bounds_of(mesh);
    parts.resize(mesh.parts.size());
    std::vector<glm::uvec3> sorted;
    std::vector<glm::uvec4> corners_and_part;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        parts[p].first = static_cast<int>(3 * sorted.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (mesh.triangle_part[t] != p) continue;
            sorted.push_back(mesh.triangles[t]);
            corners_and_part.emplace_back(mesh.triangles[t], p);
        }
        parts[p].count = static_cast<int>(3 * sorted.size()) - parts[p].first;
        parts[p].bounds = bounds_of(
            mesh, std::span(sorted).subspan(static_cast<std::size_t>(parts[p].first / 3)));
    }
    check_argument(
        sorted.size() < kMostTriangles,
        fmt::format(
            "a preview of {} triangles, {} are possible", sorted.size(), kMostTriangles - 1));
    index_buffer = Buffer(sorted);
    corners = texels_of<glm::uvec4, std::uint32_t>(corners_and_part, TexelFormat::rgba32ui);
    vertex_array.indices(index_buffer);
    find_triangles = Program(load_shader("radiance/raster.vert", {}),
                             load_shader("radiance/raster_triangle.frag", {}));
    find_parts = Program::screen_pass(
        load_shader("radiance/raster_part.frag", {fmt::format("MESH_ROW {}", kMeshRow)}));
    find_coverage = Program::screen_pass(load_shader("radiance/raster_coverage.frag", {}));
}

void RasterPreview::State::upload_layers(const FilteredEnvironment& filtered) {
    const ImageF& sharpest = filtered.mirrored.front();
    const float largest = *std::max_element(sharpest.values.begin(), sharpest.values.end());
    const float unit = std::max(1.0f, largest / kLargestHalf);
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

/// Which triangle and which part each sample shows: nothing is shaded that is not seen, and no
/// sample twice.
void RasterPreview::State::find_samples(const View& new_view) {
    if (samples_found && target.factor == factor && view == new_view) return;
    samples_found = false;
    view = new_view;
    target.resize(view.width, view.height, factor);
    covered = covered_by(bounds, view);
    for (PartRange& part : parts) part.covered = covered_by(part.bounds, view);
    target.to_triangles.clear_colour(0, 0.0f, 0.0f, 0.0f, 0.0f);
    target.to_triangles.clear_depth();
    set_view(find_triangles);
    DrawState state;
    state.depth_test = true;
    const int indices = parts.empty() ? 0 : parts.back().first + parts.back().count;
    if (indices > 0) {
        draw_indexed(find_triangles,
                     vertex_array,
                     target.to_triangles,
                     Primitive::triangles,
                     0,
                     indices,
                     state);
    }
    target.to_part_depth.clear_depth();
    find_parts.set("u_triangles", 0);
    target.triangles.bind(0);
    find_parts.set("u_corners", 1);
    corners.bind(1);
    state.scissor = scaled(covered, factor);
    screen.run(find_parts, target.to_part_depth, state);
    samples_found = true;
}

/// The program for a part in a paint, with everything but an artwork bound.
Program& RasterPreview::State::ready(const Scene& scene,
                                     const Material& paint,
                                     std::size_t part,
                                     bool over) {
    // Vertices are too far apart for light that spreads
    const Material material = albedo_paint(paint);
    const std::vector<DirectionalLight>& lights =
        is_solved_for(*light, scene.lights, light->environment.get()) ? scene.lights
                                                                      : light->lights;
    const auto count = static_cast<int>(lights.size());
    const PartArtwork* relief = relief_of(scene, part);
    const bool glints = count > 0 && has_glints(material);
    Program& program = shading_program(
        {.model = material.model,
         .lights = count,
         .surroundings = light->environment ? Surroundings::mirrored : Surroundings::none,
         .over = over,
         .relief = relief != nullptr,
         .glints = glints});
    set_paint(program, material, scene.exposure_ev, MirrorMixing::cubic, measured);
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
        program.set("u_visibility", 5);
        visibility.bind(5);
    }
    if (glints) {
        const PixelSize pixels = pixel_size_of(glint_view.value_or(view));
        program.set("u_pixels_from_mm", glm::vec3(pixels.from_mm));
        program.set("u_pixels_axis", glm::vec3(pixels.axis));
        program.set("u_pixels_size", static_cast<float>(pixels.at_one_mm));
        program.set("u_glint_density",
                    static_cast<float>(glint_density_on_mock_up(material, product->product_scale)));
    }
    if (light->environment) {
        program.set("u_layers", 1);
        program.set("u_layers_unit", layers_unit * static_cast<float>(light->environment->scale));
        program.set("u_rotation", static_cast<float>(light->environment->rotation_rad));
        layers.bind(1);
    }
    program.set("u_part_depth", depth_of_part(part));
    program.set("u_samples_a_pixel", static_cast<float>(factor));
    program.set("u_triangles", 0);
    target.triangles.bind(0);
    program.set("u_vertices", 2);
    vertices.bind(2);
    program.set("u_corners", 3);
    corners.bind(3);
    program.set("u_first_back", static_cast<int>(first_back));
    program.set("u_sky", 4);
    sky.bind(4);
    if (relief) textures.set_relief(program, *relief);
    return program;
}

void RasterPreview::State::shade_part(const Scene& scene, std::size_t part) {
    if (parts[part].count == 0) return;
    DrawState state;
    state.depth_equal = true;
    state.scissor = scaled(parts[part].covered, factor);
    screen.run(ready(scene, scene.part_materials[part], part, false), target.to_samples, state);
}

void RasterPreview::State::shade_artwork(const Scene& scene, const PartArtwork& artwork) {
    if (parts[artwork.part].count == 0) return;
    DrawState state;
    state.depth_equal = true;
    state.scissor = scaled(parts[artwork.part].covered, factor);
    state.blend = Blend::over;
    for (const ArtworkCoat& coat : coats_of(artwork)) {
        Program& program = ready(scene, coat.material, artwork.part, true);
        set_coat(program, coat);
        textures.set(program, artwork);
        screen.run(program, target.to_samples, state);
    }
}

void RasterPreview::State::downsample(const Texture2D& from, const Framebuffer& to) {
    auto found = downsamples.find(factor);
    if (found == downsamples.end()) {
        found = downsamples
                    .emplace(factor,
                             Program::screen_pass(load_shader("radiance/downsample.frag",
                                                              {fmt::format("FACTOR {}", factor)})))
                    .first;
    }
    found->second.set("u_samples", 0);
    from.bind(0);
    to.clear_colour(0, 0.0f, 0.0f, 0.0f, 0.0f);
    DrawState state;
    state.scissor = covered;
    screen.run(found->second, to, state);
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

void RasterPreview::set_glint_view(const std::optional<View>& projector) {
    state_->glint_view = projector;
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
    const std::size_t sides = lit_sides(s.product->mesh);
    check_argument(light->sky.size() == sides,
                   fmt::format("light at {} sides of vertices for {}", light->sky.size(), sides));
    s.first_back = sides - s.product->mesh.positions_mm.size();
    if (light == s.light) return;
    s.light = std::move(light);
    s.sky = float_texels(s.light->sky);
    s.visibility = visibility_texels(*s.light);
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
    s.find_samples(view);
    s.target.to_samples.clear_colour(0, 0.0f, 0.0f, 0.0f, 0.0f);
    for (std::size_t p = 0; p < s.parts.size(); ++p) s.shade_part(scene, p);
    for (const PartArtwork& artwork : scene.artwork) s.shade_artwork(scene, artwork);
    s.textures.keep(scene);
    s.downsample(s.target.samples, s.target.to_pixels);
}

unsigned RasterPreview::draw_part_coverage(std::size_t part) {
    State& s = *state_;
    check_argument(part < s.parts.size(),
                   fmt::format("part {} of {}, counted from 0", part, s.parts.size()));
    check_argument(s.view.width > 0, "a part's coverage is of a picture, and there is none yet");
    const PartRange& range = s.parts[part];
    s.target.make_coverage();
    s.find_coverage.set("u_triangles", 0);
    s.find_coverage.set("u_first_last",
                        glm::vec2(range.first / 3 + 1, (range.first + range.count) / 3));
    s.target.triangles.bind(0);
    DrawState state;
    state.scissor = scaled(s.covered, s.factor);
    s.screen.run(s.find_coverage, s.target.to_coverage_samples, state);
    s.downsample(s.target.coverage_samples, s.target.to_coverage);
    return s.target.coverage.name();
}

ImageF RasterPreview::read_back() const { return read_floats(state_->target.pixels); }

unsigned RasterPreview::texture() const { return state_->target.pixels.name(); }

}  // namespace livery
