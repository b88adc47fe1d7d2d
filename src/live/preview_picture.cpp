#include "live/preview_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "appearance/parameter_table.h"
#include "appearance/subsurface/exact_totals.h"
#include "appearance/subsurface/translucent_material.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "gl/handles.h"
#include "gl/read_back.h"
#include "radiance/raster_preview.h"
#include "scene/library.h"

namespace livery {

namespace {

constexpr int kLongSide = 160;
constexpr int kRays = 64;

/// Twice a box of three: what is left of the rays' noise.
void smooth(std::vector<float>& values, int width, int height) {
    for (int pass = 0; pass < 2; ++pass) {
        const std::vector<float> from = values;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                float sum = 0.0f;
                for (int v = y - 1; v <= y + 1; ++v) {
                    for (int u = x - 1; u <= x + 1; ++u) {
                        const int row = std::clamp(v, 0, height - 1);
                        const int column = std::clamp(u, 0, width - 1);
                        sum += from[static_cast<std::size_t>(row * width + column)];
                    }
                }
                values[static_cast<std::size_t>(y * width + x)] = sum / 9.0f;
            }
        }
    }
}

}  // namespace

GroundShadow ground_shadow(const Product& product, const Tracer& tracer) {
    const Bounds bounds = bounds_of(product.mesh);
    const glm::dvec3 extent = bounds.high - bounds.low;
    const double margin = 0.35 * std::max({extent.x, extent.y, extent.z, 1e-3});
    GroundShadow shadow;
    shadow.height_mm = bounds.low.y;
    shadow.corner_mm = {bounds.low.x - margin, bounds.low.z - margin};
    shadow.size_mm = glm::dvec2(extent.x, extent.z) + 2.0 * margin;
    const double texel_mm = std::max(shadow.size_mm.x, shadow.size_mm.y) / kLongSide;
    const int width = std::max(1, static_cast<int>(std::lround(shadow.size_mm.x / texel_mm)));
    const int height = std::max(1, static_cast<int>(std::lround(shadow.size_mm.y / texel_mm)));

    std::vector<glm::vec3> places, up;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            // A touch below the product, so that what stands on the ground hides it
            places.emplace_back(shadow.corner_mm.x + (x + 0.5) * shadow.size_mm.x / width,
                                shadow.height_mm - 1e-3 * margin,
                                shadow.corner_mm.y + (y + 0.5) * shadow.size_mm.y / height);
            up.emplace_back(0.0f, 1.0f, 0.0f);
        }
    }
    std::vector<float> open = ambient_openness(tracer, places, up, kRays, 1e30f);
    smooth(open, width, height);

    shadow.hidden = Image8(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            // The picture's border shows no edge
            const double u = std::abs(2.0 * (x + 0.5) / width - 1.0);
            const double v = std::abs(2.0 * (y + 0.5) / height - 1.0);
            const double far = std::clamp((std::max(u, v) - 0.75) / 0.25, 0.0, 1.0);
            const double fade = 1.0 - far * far * (3.0 - 2.0 * far);
            const double hidden = fade * (1.0 - open[static_cast<std::size_t>(y * width + x)]);
            shadow.hidden.at(x, y) = static_cast<std::uint8_t>(std::lround(255.0 * hidden));
        }
    }
    return shadow;
}

void PreviewEncoder::set_ground(const GroundShadow* ground) {
    ground_.reset();
    shadow_ = Texture2D();
    if (!ground) return;
    ground_ = *ground;
    const Image8& hidden = ground->hidden;
    shadow_ = Texture2D({hidden.width, hidden.height}, TexelFormat::r8, TexelFilter::linear);
    shadow_.upload(std::span<const std::uint8_t>(hidden.values));
}

Program& PreviewEncoder::program_for(bool ground, bool highlight) {
    const auto found = programs_.find({ground, highlight});
    if (found != programs_.end()) return found->second;
    const ShaderSource source = load_shader(
        "preview.frag",
        {fmt::format("GROUND {}", ground ? 1 : 0), fmt::format("HIGHLIGHT {}", highlight ? 1 : 0)});
    return programs_.emplace(std::pair(ground, highlight), Program::screen_pass(source))
        .first->second;
}

void PreviewEncoder::encode(RasterPreview& preview,
                            const View& view,
                            std::optional<int> highlighted_part,
                            bool with_ground,
                            const Framebuffer& into,
                            const std::optional<PixelRect>& only) {
    const bool ground = with_ground && ground_;
    Program& program = program_for(ground, highlighted_part.has_value());
    program.set("u_radiance", 0);
    program.set("u_rec709_from_working", glm::mat3(rec709_from_working()));
    if (ground) {
        const glm::dmat3 direction_from_pixel(1.0 / view.focal_px.x,
                                              0.0,
                                              0.0,
                                              0.0,
                                              1.0 / view.focal_px.y,
                                              0.0,
                                              -view.principal_px.x / view.focal_px.x,
                                              -view.principal_px.y / view.focal_px.y,
                                              1.0);
        program.set(
            "u_world_from_pixel",
            glm::mat3(glm::transpose(view.view_from_world.rotation) * direction_from_pixel));
        program.set("u_centre_mm", glm::vec3(centre_in_world(view)));
        program.set("u_ground_mm", static_cast<float>(ground_->height_mm));
        program.set("u_shadow_area", glm::vec4(ground_->corner_mm, 1.0 / ground_->size_mm));
        program.set("u_shadow", 1);
        shadow_.bind(1);
    }
    if (highlighted_part) {
        const unsigned part =
            preview.draw_part_coverage(static_cast<std::size_t>(*highlighted_part));
        program.set("u_part", 2);
        bind_texture(2, part);
    }
    bind_texture(0, preview.texture());
    DrawState state;
    state.scissor = only;
    screen_.run(program, into, state);
}

namespace {

/// Grows whenever swatches come to look different.
constexpr int kSwatchVersion = 4;
constexpr double kFov_rad = 0.2;

View swatch_view(const Bounds& bounds, int size_px) {
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    const double radius = 0.5 * (bounds.high.y - bounds.low.y);
    // The sphere's outline fills 96% of the square
    const double distance = radius / std::sin(std::atan(0.96 * std::tan(0.5 * kFov_rad)));
    const glm::dvec3 from = middle + distance * glm::normalize(glm::dvec3(0.0, 0.28, 1.0));
    return look_at(from, middle, kFov_rad, size_px, size_px);
}

}  // namespace

SwatchStudio make_swatch_studio(const Progress& progress) {
    // The light of the shipped looks, so that a swatch promises what the mock-up then shows
    const Look look = find_look(shipped_looks().front());
    SwatchStudio studio;
    studio.product = find_product("sphere");
    studio.lights = look.lights;
    studio.exposure_ev = look.exposure_ev;
    const auto environment = std::make_shared<const Environment>(
        load_environment(look.environment, look.file.parent_path()));
    VertexLightSolver solver(studio.product);
    studio.light = solver.solve(studio.lights, environment, progress);
    return studio;
}

struct SwatchPainter::State {
    SwatchStudio studio;
    RasterPreview preview;
    PreviewEncoder encoder;

    explicit State(const SwatchStudio& its_studio)
        : studio(its_studio), preview(studio.product, 4) {
        preview.take(studio.light);
    }
};

SwatchPainter::SwatchPainter(const SwatchStudio& studio)
    : state_(std::make_unique<State>(studio)) {}

SwatchPainter::~SwatchPainter() = default;

Image8 SwatchPainter::paint(const Material& material, int size_px) {
    check_argument(size_px >= kSmallestSwatch_px && size_px <= kLargestSwatch_px,
                   fmt::format("a swatch of {} px, {} to {} are possible",
                               size_px,
                               kSmallestSwatch_px,
                               kLargestSwatch_px));
    if (material.model == ReflectanceModel::translucent && material.medium) {
        return translucent_swatch(material, size_px);
    }
    State& s = *state_;
    const View view = swatch_view(bounds_of(s.studio.product->mesh), size_px);
    Scene scene;
    scene.product = s.studio.product;
    scene.environment = s.studio.light->environment;
    scene.lights = s.studio.lights;
    scene.exposure_ev = s.studio.exposure_ev;
    scene.eye_in_world_mm = centre_in_world(view);
    scene.part_materials.assign(s.studio.product->mesh.parts.size(), material);
    s.preview.draw(scene, view);
    const Texture2D texture(size_px, size_px, TexelFormat::rgba8);
    const Framebuffer framebuffer({&texture});
    s.encoder.encode(s.preview, view, std::nullopt, false, framebuffer);
    return read_bytes(texture, 4);
}

std::filesystem::path swatch_file(const Material& material, int size_px) {
    Hasher hasher;
    const std::array integers{kSwatchVersion, size_px};
    hasher.add(std::span<const int>(integers));
    hasher.add(std::span<const double>(reflectance_numbers(material)));
    return user_folder() / "swatches" / (hasher.hex() + ".png");
}

// The files have no alpha: colour stands above, coverage below.

std::optional<Image8> kept_swatch(const Material& material, int size_px) {
    const std::filesystem::path file = swatch_file(material, size_px);
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
    ImageF stored;
    try {
        stored = read_image(file, 2u * kLargestSwatch_px * kLargestSwatch_px).image;
    } catch (const FileError&) {
        return std::nullopt;  // drawn anew, which replaces it
    }
    if (stored.width != size_px || stored.height != 2 * size_px || stored.channels != 3) {
        return std::nullopt;
    }
    Image8 swatch(size_px, size_px, 4);
    for (int y = 0; y < size_px; ++y) {
        for (int x = 0; x < size_px; ++x) {
            std::uint8_t* out = swatch.pixel(x, y);
            for (int c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(stored.at(x, y, c));
            out[3] = static_cast<std::uint8_t>(stored.at(x, y + size_px, 0));
        }
    }
    return swatch;
}

bool keep_swatch(const Material& material, const Image8& swatch) {
    Image8 stored(swatch.width, 2 * swatch.height, 3);
    for (int y = 0; y < swatch.height; ++y) {
        for (int x = 0; x < swatch.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                stored.at(x, y, c) = swatch.at(x, y, c);
                stored.at(x, y + swatch.height, c) = swatch.at(x, y, 3);
            }
        }
    }
    const std::filesystem::path file = swatch_file(material, swatch.width);
    try {
        make_output_folder(file.parent_path());
        write_png(file, stored);
    } catch (const FileError&) {
        return false;
    }
    return true;
}

namespace {

/// What absorbs nothing sends T + R = 1 of them: neither end of its wedge may burn out.
constexpr double kBehind = 0.75, kInFront = 0.25;
constexpr std::size_t kThicknesses = 13;
constexpr double kSphereShare = 0.96;  ///< of the square, as the spheres of other paints

/// Linear Rec.709 at thicknesses in equal ratios.
std::array<glm::dvec3, kThicknesses> wedge_of(const TranslucentMaterial& material) {
    std::array<glm::dvec3, kThicknesses> wedge{};
    for (std::size_t k = 0; k < kThicknesses; ++k) {
        const double share = static_cast<double>(k) / (kThicknesses - 1.0);
        for (int c = 0; c < 3; ++c) {
            ScatteringMedium medium = medium_of(material, c);
            medium.thickness_mm =
                kThinnestWedge_mm * std::pow(kThickestWedge_mm / kThinnestWedge_mm, share);
            const DiffuseTotals totals = exact_totals(medium);
            const UnscatteredLight straight = unscattered_light(medium);
            wedge[k][c] = kBehind * (totals.transmittance + straight.transmitted) +
                          kInFront * (totals.reflectance + straight.reflected);
        }
    }
    return wedge;
}

}  // namespace

Image8 translucent_swatch(const Material& translucent, int size_px) {
    check_argument(translucent.model == ReflectanceModel::translucent && translucent.medium,
                   fmt::format("paint '{}' is not translucent", translucent.name));
    const auto wedge = wedge_of(*translucent.medium);
    Image8 swatch(size_px, size_px, 4);
    const double middle = 0.5 * size_px, radius = kSphereShare * middle;
    for (int y = 0; y < size_px; ++y) {
        for (int x = 0; x < size_px; ++x) {
            const double across = x + 0.5 - middle, down = y + 0.5 - middle;
            const double inside = radius - std::hypot(across, down) + 0.5;
            const double place = std::clamp(0.5 + 0.5 * across / radius, 0.0, 1.0) *
                                 static_cast<double>(kThicknesses - 1);
            const auto below = std::min(static_cast<std::size_t>(place), kThicknesses - 2);
            const glm::dvec3 colour =
                glm::mix(wedge[below], wedge[below + 1], place - static_cast<double>(below));
            std::uint8_t* pixel = swatch.pixel(x, y);
            for (int c = 0; c < 3; ++c) {
                pixel[c] = static_cast<std::uint8_t>(
                    std::lround(255.0 * srgb_encode(std::clamp(colour[c], 0.0, 1.0))));
            }
            pixel[3] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(inside, 0.0, 1.0)));
        }
    }
    return swatch;
}

}  // namespace livery
