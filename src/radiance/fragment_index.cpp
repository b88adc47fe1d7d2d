#include "radiance/fragment_index.h"

#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

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

}  // namespace livery
