#include "radiance/lanes/input_layers.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "gl/context.h"
#include "radiance/lanes/lane_functions.h"

namespace livery {
namespace {

/// Nearest half float, ties to even; negative as 0, NaN as NaN. Without a branch, for whole rows.
std::uint16_t half_of(float value) {
    const float v = value > 0.0f ? std::min(value, 65504.0f) : 0.0f;
    const auto bits = std::bit_cast<std::uint32_t>(v);
    const std::uint32_t normal = (bits + 0xfffu + ((bits >> 13u) & 1u) - (112u << 23u)) >> 13u;
    // Under 2^-14 a half float counts in units of 2^-24, as a float next to 0.5 does
    const std::uint32_t small = std::bit_cast<std::uint32_t>(v + 0.5f) - 0x3f000000u;
    const std::uint32_t number = v < 0x1p-14f ? small : normal;
    return static_cast<std::uint16_t>(value == value ? number : 0x7e00u);
}

/// Interleaved channels into blocks from the first on; `channels` of the four that come.
template <typename T, typename Convert>
void to_blocks(std::span<const float> rgba,
               std::size_t channels,
               T* blocks,
               const Convert& convert) {
    const std::size_t count = rgba.size() / (4 * kLaneBlock);
    parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            const float* from = rgba.data() + 4 * kLaneBlock * block;
            T* to = blocks + channels * kLaneBlock * block;
            for (std::size_t c = 0; c < channels; ++c) {
                for (std::size_t k = 0; k < kLaneBlock; ++k) {
                    to[c * kLaneBlock + k] = convert(from[4 * k + c]);
                }
            }
        }
    });
}

TexelFormat texel_format(InputLayers::Precision precision) {
    return precision == InputLayers::Precision::half ? TexelFormat::rgba16f : TexelFormat::rgba32f;
}

}  // namespace

ShadingDevice chosen_device(ShadingDevice asked) {
    if (asked != ShadingDevice::automatic) return asked;
    return current_context_is_software() ? ShadingDevice::processor : ShadingDevice::gl;
}

bool InputLayers::make(ShadingDevice device, int rows, int layers, Precision precision) {
    if (device_ == device && rows_ == rows && layers_ == layers) return false;
    *this = InputLayers();
    device_ = device;
    rows_ = rows;
    layers_ = layers;
    const auto count = static_cast<std::size_t>(std::max(layers, 1));
    places_.resize(count);
    std::iota(places_.begin(), places_.end(), 0);
    if (device == ShadingDevice::gl) {
        texture_ = Texture2D({kPackedWidth, rows, layers}, texel_format(precision));
    } else if (precision == Precision::half) {
        halves_.resize(count);
    } else {
        floats_.resize(count);
    }
    return true;
}

bool InputLayers::make_room(ShadingDevice device,
                            int rows,
                            const std::vector<bool>& layers,
                            Precision precision) {
    const int count = static_cast<int>(layers.size());
    if (device_ != device || rows_ != rows || layers_ != count) {
        *this = InputLayers();
        device_ = device;
        rows_ = rows;
        layers_ = count;
        places_.assign(layers.size(), -1);
        if (device == ShadingDevice::processor) {
            (precision == Precision::half ? halves_.resize(layers.size())
                                          : floats_.resize(layers.size()));
        }
    }
    const int before = *std::max_element(places_.begin(), places_.end()) + 1;
    int after = before;
    for (std::size_t k = 0; k < layers.size(); ++k) {
        if (layers[k] && places_[k] < 0) places_[k] = after++;
    }
    if (after == before) return false;
    if (device == ShadingDevice::gl) {
        Texture2D more({kPackedWidth, rows, after}, texel_format(precision));
        more.clear();
        if (before > 0) copy_layers(texture_, more);
        texture_ = std::move(more);
    }
    return true;
}

void InputLayers::upload(std::span<const float> rgba, int layer, int first_row) {
    const auto at = static_cast<std::size_t>(layer);
    if (device_ == ShadingDevice::gl) {
        const int rows = static_cast<int>(rgba.size() / (4 * kPackedWidth));
        texture_.upload(rgba, PixelRect{0, first_row, kPackedWidth, rows}, places_[at]);
        return;
    }
    const std::size_t first = static_cast<std::size_t>(first_row) * kPackedWidth;
    const std::size_t all = static_cast<std::size_t>(rows_) * kPackedWidth;
    if (!halves_.empty()) {
        halves_[at].resize(3 * all);
        to_blocks(rgba, 3, halves_[at].data() + 3 * first, [](float v) { return half_of(v); });
    } else {
        floats_[at].resize(4 * all);
        to_blocks(rgba, 4, floats_[at].data() + 4 * first, [](float v) { return v; });
    }
}

}  // namespace livery
