#include "compensation/gpu_pass.h"

#include <algorithm>
#include <string>

#include "compensation/dither.h"
#include "compensation/drive_table.h"
#include "core/error.h"
#include "gl/draw.h"
#include "gl/read_back.h"

namespace livery {
namespace {

ShaderSource fragment_source(bool non_additive) {
    std::vector<std::string> defines;
    if (non_additive) {
        defines = {"NON_ADDITIVE", "NEWTON_STEPS " + std::to_string(kNewtonSteps), "SOLVED_N 1e-6"};
        static_assert(kSolvedN == 1e-6f);
    }
    return load_shader("compensation.frag", defines);
}

/// Tiles of 32 pixels that hold a valid one: what lies outside costs nothing.
ShaderSource tile_source() {
    return {"compensation tiles", R"(#version 450 core
layout(location = 0) in vec2 corner_px;
uniform vec2 size_px;
uniform float tile_px;
void main() {
    vec2 at = min(corner_px + tile_px * vec2(gl_VertexID & 1, gl_VertexID >> 1), size_px);
    gl_Position = vec4(2.0 * at / size_px - 1.0, 0.0, 1.0);
}
)"};
}

constexpr int kTile = 32;

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

}  // namespace

struct GpuCompensation::State {
    Program program;
    std::array<Texture2D, 3> rows;
    Texture2D rho, nodes, start, linear_of, drive;
    Framebuffer target;
    Buffer corners;
    VertexArray tiles;
    int tile_count = 0;

    explicit State(const CompensationTable& table)
        : program(tile_source(), fragment_source(table.non_additive.grid > 0)),
          rho(curve_texture(rho_of(table))),
          drive(table.width, table.height, TexelFormat::rgba8),
          target({&drive}) {
        upload_rows(table);
        find_tiles(table);
        if (table.non_additive.grid > 0) {
            nodes = grid_texture(table.non_additive.grid, table.non_additive.n_from_nodes);
            start = grid_texture(table.non_additive.start_grid, table.non_additive.start);
            linear_of = curve_texture(table.non_additive.linear_of_node);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            program.set("last_of_rho[" + std::to_string(k) + "]",
                        static_cast<int>(rho_of(table)[k].size()) - 1);
        }
        program.set("dither_per_column", dither::kPerColumn);
        program.set("dither_per_row", dither::kPerRow);
        program.set("tile_px", static_cast<float>(kTile));
        program.set("size_px",
                    glm::vec2(static_cast<float>(table.width), static_cast<float>(table.height)));
        target.clear_colour(0, 0.0f, 0.0f, 0.0f, 1.0f);
    }

    void upload_rows(const CompensationTable& table) {
        const std::size_t count = table.pixels.size();
        std::vector<float> texels(4 * static_cast<std::size_t>(table.width) *
                                  static_cast<std::size_t>(table.height));
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t i = 0; i < count; ++i) {
                float* texel = &texels[4 * static_cast<std::size_t>(table.pixels[i])];
                for (std::size_t column = 0; column < 3; ++column) {
                    texel[column] = table.coefficients[(3 * row + column) * count + i];
                }
                texel[3] = table.coefficients[(9 + row) * count + i];
            }
            rows[row] = Texture2D(table.width, table.height, TexelFormat::rgba32f);
            rows[row].upload(texels);
        }
    }

    void find_tiles(const CompensationTable& table) {
        const int across = (table.width + kTile - 1) / kTile;
        const int down = (table.height + kTile - 1) / kTile;
        std::vector<bool> used(static_cast<std::size_t>(across * down), false);
        for (const std::uint32_t pixel : table.pixels) {
            const int x = static_cast<int>(pixel) % table.width;
            const int y = static_cast<int>(pixel) / table.width;
            used[static_cast<std::size_t>(y / kTile * across + x / kTile)] = true;
        }
        std::vector<float> list;
        for (int tile = 0; tile < across * down; ++tile) {
            if (!used[static_cast<std::size_t>(tile)]) continue;
            list.push_back(static_cast<float>(tile % across * kTile));
            list.push_back(static_cast<float>(tile / across * kTile));
            ++tile_count;
        }
        if (tile_count == 0) return;
        corners = Buffer(list);
        tiles.floats(0, corners, 2, 8, 0, 1);
    }
};

GpuCompensation::GpuCompensation(const CompensationTable& table)
    : state_(std::make_unique<State>(table)) {
    check_argument(table.gamut.coefficients.empty(),
                   "the OpenGL pass got a table with a gamut mapping, which it does not have");
}

GpuCompensation::~GpuCompensation() = default;

void GpuCompensation::run(unsigned radiance_texture) {
    State& s = *state_;
    if (s.tile_count == 0) return;
    bind_texture(0, radiance_texture);
    for (unsigned row = 0; row < 3; ++row) s.rows[row].bind(row + 1);
    s.rho.bind(4);
    if (s.nodes) {
        s.nodes.bind(5);
        s.start.bind(6);
        s.linear_of.bind(7);
    }
    draw(s.program, s.tiles, s.target, Primitive::triangle_strip, 0, 4, {}, s.tile_count);
}

unsigned GpuCompensation::texture() const { return state_->drive.name(); }

Image8 GpuCompensation::read_back() const { return read_bytes(state_->drive, 3); }

}  // namespace livery
