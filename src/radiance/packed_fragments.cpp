#include "radiance/packed_fragments.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "radiance/ray_grid.h"

namespace livery {

PixelRect PackedLayout::rectangle(std::size_t part) const {
    return {0, row_begin[part], kPackedWidth, row_begin[part + 1] - row_begin[part]};
}

PackedLayout layout_of(const SurfaceMap& map) {
    PackedLayout layout;
    layout.part_begin = map.part_begin;
    layout.row_begin.push_back(0);
    for (std::size_t p = 0; p + 1 < map.part_begin.size(); ++p) {
        const std::size_t rows = (layout.fragments(p) + kPackedWidth - 1) / kPackedWidth;
        layout.row_begin.push_back(layout.row_begin.back() + static_cast<int>(rows));
    }
    layout.rows = std::max(layout.row_begin.back(), 1);
    return layout;
}

FragmentIndex index_fragments(const SurfaceMap& map, const PackedLayout& layout) {
    FragmentIndex index;
    index.samples_per_pixel = map.samples_per_pixel;
    index.address_bits =
        31u - static_cast<unsigned>(std::bit_width(static_cast<unsigned>(map.samples_per_pixel)));
    check_argument(static_cast<std::size_t>(layout.rows) * kPackedWidth <
                       (std::size_t{1} << index.address_bits),
                   fmt::format("{} fragments are more than the resolve pass can address",
                               map.fragments.size()));
    const auto word = [&](bool more, std::uint32_t samples, std::size_t address) {
        return (more ? 0x80000000u : 0u) | (samples << index.address_bits) |
               static_cast<std::uint32_t>(address);
    };

    // Fragments of each pixel, in order
    const std::size_t pixel_count = map.coverage.pixel_count();
    std::vector<std::uint32_t> count(pixel_count + 1, 0);
    for (const Fragment& f : map.fragments) ++count[f.pixel + 1];
    for (std::size_t p = 0; p < pixel_count; ++p) count[p + 1] += count[p];
    std::vector<std::uint32_t> sorted(map.fragments.size());
    std::vector<std::uint32_t> filled(count.begin(), count.end() - 1);
    for (std::uint32_t i = 0; i < map.fragments.size(); ++i) {
        sorted[filled[map.fragments[i].pixel]++] = i;
    }

    for (std::size_t p = 0; p < pixel_count; ++p) {
        const std::uint32_t begin = count[p], end = count[p + 1];
        if (begin == end) continue;
        const bool several = end - begin > 1;
        index.pixels.push_back(static_cast<std::uint32_t>(p));
        if (several) index.words.push_back(word(true, 0, index.lists.size()));
        for (std::uint32_t i = begin; i < end; ++i) {
            const Fragment& f = map.fragments[sorted[i]];
            const auto samples = static_cast<std::uint32_t>(
                std::lround(f.coverage * static_cast<float>(map.samples_per_pixel)));
            (several ? index.lists : index.words)
                .push_back(
                    word(several && i + 1 < end, samples, layout.address(sorted[i], f.part)));
        }
    }
    return index;
}

namespace {

/// Corners of rectangles that cover every tile with coverage, neighbours in a row merged.
std::vector<float> covered_rectangles(const ImageF& coverage, std::size_t& pixels) {
    std::vector<float> corners;
    const auto add = [&](int x0, int y0, int x1, int y1) {
        const auto l = static_cast<float>(x0), t = static_cast<float>(y0);
        const auto r = static_cast<float>(x1), b = static_cast<float>(y1);
        corners.insert(corners.end(), {l, t, r, t, r, b, l, t, r, b, l, b});
        pixels += static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0);
    };
    for (int y = 0; y < coverage.height; y += kTile_px) {
        const int bottom = std::min(y + kTile_px, coverage.height);
        int begin = -1;
        for (int x = 0; x < coverage.width + kTile_px; x += kTile_px) {
            bool covered = false;
            for (int v = y; v < bottom; ++v) {
                for (int u = x; u < std::min(x + kTile_px, coverage.width); ++u) {
                    covered = covered || coverage.at(u, v) > 0.0f;
                }
            }
            if (covered && begin < 0) begin = x;
            if (!covered && begin >= 0) {
                add(begin, y, std::min(x, coverage.width), bottom);
                begin = -1;
            }
        }
    }
    return corners;
}

}  // namespace

ResolvePass::ResolvePass(const SurfaceMap& map, const PackedLayout& layout) {
    FragmentIndex index = index_fragments(map, layout);
    std::vector<std::uint32_t> first(map.coverage.pixel_count(), 0);
    for (std::size_t i = 0; i < index.pixels.size(); ++i) first[index.pixels[i]] = index.words[i];
    std::vector<std::uint32_t>& lists = index.lists;
    lists.resize((std::max<std::size_t>(lists.size(), 1) + kPackedWidth - 1) / kPackedWidth *
                 kPackedWidth);

    first_ = Texture2D(map.width, map.height, TexelFormat::r32ui);
    first_.upload(std::span<const std::uint32_t>(first));
    lists_ =
        Texture2D(kPackedWidth, static_cast<int>(lists.size() / kPackedWidth), TexelFormat::r32ui);
    lists_.upload(std::span<const std::uint32_t>(lists));

    const std::vector<float> corners = covered_rectangles(map.coverage, pixels_);
    vertex_count_ = static_cast<int>(corners.size() / 2);
    if (vertex_count_ > 0) {
        corners_ = Buffer(corners);
        vertices_.floats(0, corners_, 2, 2 * sizeof(float));
    }
    program_ = Program(load_shader("radiance/resolve.vert"),
                       load_shader("radiance/resolve.frag",
                                   {fmt::format("ADDRESS_BITS {}", index.address_bits),
                                    fmt::format("SAMPLES {}", map.samples_per_pixel)}));
}

void ResolvePass::run(const Texture2D& shaded_fragments, const Framebuffer& target) {
    if (vertex_count_ == 0) return;
    program_.set("u_size_px", glm::vec2(target.width(), target.height()));
    program_.set("u_fragments", 0);
    program_.set("u_first", 1);
    program_.set("u_lists", 2);
    shaded_fragments.bind(0);
    first_.bind(1);
    lists_.bind(2);
    draw(program_, vertices_, target, Primitive::triangles, 0, vertex_count_);
}

}  // namespace livery
