#include "compensation/gpu_pass.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compensation/compensate.h"
#include "compensation/drive_table.h"
#include "compensation/gamut.h"
#include "compensation/kernel.h"
#include "core/error.h"
#include "gl/program.h"

namespace livery {
namespace {

constexpr unsigned kGroup = 256;

/// A matrix whose columns are the rows of `m`, as GLSL's constructor `type` of vectors.
std::string rows_text(const glm::dmat3& m, std::string_view type, std::string_view suffix) {
    std::string text;
    for (int row = 0; row < 3; ++row) {
        text += fmt::format("{}{}vec3({:.17e}{}, {:.17e}{}, {:.17e}{})",
                            row == 0 ? "" : ", ",
                            suffix.empty() ? "" : "d",
                            m[0][row],
                            suffix,
                            m[1][row],
                            suffix,
                            m[2][row],
                            suffix);
    }
    return fmt::format("{}({})", type, text);
}

ShaderSource source_for(const CompensationTable& table) {
    std::vector<std::string> defines = {fmt::format("GROUP {}", kGroup),
                                        fmt::format("GAMUT_TOLERANCE {}", kernel::kGamutTolerance)};
    if (table.non_additive.grid > 0) {
        defines.insert(defines.end(),
                       {"NON_ADDITIVE",
                        fmt::format("NEWTON_STEPS {}", kNewtonSteps),
                        fmt::format("SOLVED_N {}", kSolvedN),
                        fmt::format("REACHABLE_N {}", kReachableN)});
    }
    if (!table.gamut.coefficients.empty()) {
        const OklabMatrices m = oklab_matrices();
        defines.insert(defines.end(),
                       {"GAMUT_MAPPING",
                        "OKLAB_CONES " + rows_text(m.cones, "Rows", ""),
                        "OKLAB_LAB " + rows_text(m.lab, "Rows", ""),
                        "OKLAB_ROOTS " + rows_text(m.roots, "Rows", ""),
                        "OKLAB_RGB " + rows_text(m.rgb, "Rows", ""),
                        "EXACT_CONES " + rows_text(m.cones, "dmat3", "LF")});
    }
    return load_shader("compensation/correct.comp", defines);
}

Texture2D grid_texture(int grid, const std::vector<glm::vec3>& values) {
    std::vector<float> texels;
    texels.reserve(values.size() * 4);
    for (const glm::vec3& v : values) texels.insert(texels.end(), {v.x, v.y, v.z, 0.0f});
    Texture2D texture(grid * grid, grid, TexelFormat::rgba32f);
    texture.upload(texels);
    return texture;
}

/// One row a channel; the shader is told how much of each row is filled.
Texture2D curve_texture(const std::array<std::vector<float>, 3>& curves) {
    const std::size_t width = std::max({curves[0].size(), curves[1].size(), curves[2].size()});
    std::vector<float> texels;
    for (const std::vector<float>& curve : curves) {
        texels.insert(texels.end(), curve.begin(), curve.end());
        texels.resize(texels.size() + width - curve.size(), curve.back());
    }
    Texture2D texture(static_cast<int>(width), 3, TexelFormat::r32f);
    texture.upload(texels);
    return texture;
}

const std::array<std::vector<float>, 3>& rho_of(const CompensationTable& table) {
    return table.non_additive.grid > 0 ? table.non_additive.rho : table.drive_from_n;
}

/// What lies beyond a block's end a shader may read as zeros: that must not become a picture.
void check_size(const CompensationTable& table) {
    const std::size_t planes = table.gamut.coefficients.empty() ? 12 : 16;
    const std::size_t needed = planes * sizeof(float) * table.pixels.size();
    const std::size_t largest = largest_storage_block();
    if (needed <= largest) return;
    throw Refused(
        fmt::format("this OpenGL reads {} MB at once, the calibration's {} pixels are {} MB",
                    largest >> 20u,
                    table.pixels.size(),
                    needed >> 20u),
        "Correct on the processor (livery desktop --shading processor).");
}

/// The planes of the table's boundary one after the other, as the shader counts them.
Buffer boundary_buffer(const GamutBoundary& gamut) {
    const std::array planes = {&gamut.coefficients,
                               &gamut.darkest,
                               &gamut.brightest,
                               &gamut.own_darkest,
                               &gamut.own_brightest};
    std::size_t count = 0;
    for (const auto* plane : planes) count += plane->size();
    Buffer buffer(count * sizeof(float));
    std::size_t at = 0;
    for (const auto* plane : planes) {
        buffer.update(std::span<const float>(*plane), at * sizeof(float));
        at += plane->size();
    }
    return buffer;
}

}  // namespace

CompensationCounts::CompensationCounts() : buffer_(4 * sizeof(std::uint32_t)) { buffer_.clear(); }

CompensationStats CompensationCounts::read(std::size_t covered_pixels) const {
    std::array<std::uint32_t, 4> counts{};
    buffer_.read(counts.data(), sizeof(counts));
    return stats_of({counts[0], counts[1], counts[2], counts[3]}, covered_pixels);
}

struct GpuCompensation::State {
    int width = 0, height = 0;
    unsigned pixel_count = 0;
    std::map<std::pair<bool, bool>, Program> programs;  ///< by non-additive and gamut mapping
    Program* program = nullptr;
    Texture2D rho, nodes, start, linear_of;
    Buffer pixels, coefficients, boundary;

    void use(const CompensationTable& table) {
        const bool non_additive = table.non_additive.grid > 0;
        const bool mapped = !table.gamut.coefficients.empty();
        check_size(table);
        width = table.width;
        height = table.height;
        pixel_count = static_cast<unsigned>(table.pixels.size());
        if (pixel_count == 0) return;
        program = &programs[{non_additive, mapped}];
        if (!*program) *program = Program(source_for(table));
        rho = curve_texture(rho_of(table));
        pixels = Buffer(table.pixels);
        coefficients = Buffer(table.coefficients);
        if (mapped) boundary = boundary_buffer(table.gamut);
        if (non_additive) {
            nodes = grid_texture(table.non_additive.grid, table.non_additive.n_from_nodes);
            start = grid_texture(table.non_additive.start_grid, table.non_additive.start);
            linear_of = curve_texture(table.non_additive.linear_of_node);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            program->set(fmt::format("last_of_rho[{}]", k),
                         static_cast<int>(rho_of(table)[k].size()) - 1);
        }
        program->set("pixel_count", pixel_count);
        program->set("dither_per_column", dither::kPerColumn);
        program->set("dither_per_row", dither::kPerRow);
    }
};

GpuCompensation::GpuCompensation() : state_(std::make_unique<State>()) {}

GpuCompensation::GpuCompensation(const CompensationTable& table) : GpuCompensation() { use(table); }

GpuCompensation::~GpuCompensation() = default;

void GpuCompensation::use(const CompensationTable& table) { state_->use(table); }

int GpuCompensation::programs() const { return static_cast<int>(state_->programs.size()); }

void GpuCompensation::run(unsigned radiance_texture, Texture2D& drive, CompensationCounts& counts) {
    const State& s = *state_;
    check_argument(drive.width() == s.width && drive.height() == s.height &&
                       drive.format() == TexelFormat::rgba8,
                   fmt::format("a drive texture of {}x{}, the calibration has {}x{} in RGBA8",
                               drive.width(),
                               drive.height(),
                               s.width,
                               s.height));
    // What the table does not hold is black.
    drive.clear({0.0f, 0.0f, 0.0f, 1.0f});
    counts.buffer_.clear();
    if (s.pixel_count == 0) return;
    bind_texture(0, radiance_texture);
    s.rho.bind(1);
    if (s.nodes) {
        s.nodes.bind(2);
        s.start.bind(3);
        s.linear_of.bind(4);
    }
    drive.bind_image(0);
    s.pixels.bind_storage_block(0);
    s.coefficients.bind_storage_block(1);
    if (s.boundary.bytes() > 0) s.boundary.bind_storage_block(2);
    counts.buffer_.bind_storage_block(3);
    dispatch(*s.program, (s.pixel_count + kGroup - 1) / kGroup, 1);
}

}  // namespace livery
