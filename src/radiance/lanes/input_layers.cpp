#include "radiance/lanes/input_layers.h"

#include <algorithm>
#include <bit>

#include "core/parallel.h"
#include "gl/context.h"
#include "radiance/lanes/lane_shading.h"

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

/// Interleaved channels into blocks; `channels` of the four that come.
template <typename T, typename Convert>
void to_blocks(std::span<const float> rgba,
               std::size_t channels,
               std::vector<T>& blocks,
               const Convert& convert) {
    const std::size_t count = rgba.size() / (4 * kLaneBlock);
    blocks.resize(count * channels * kLaneBlock);
    parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            const float* from = rgba.data() + 4 * kLaneBlock * block;
            T* to = blocks.data() + channels * kLaneBlock * block;
            for (std::size_t c = 0; c < channels; ++c) {
                for (std::size_t k = 0; k < kLaneBlock; ++k) {
                    to[c * kLaneBlock + k] = convert(from[4 * k + c]);
                }
            }
        }
    });
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
    if (device == ShadingDevice::gl) {
        texture_ =
            Texture2D({kPackedWidth, rows, layers},
                      precision == Precision::half ? TexelFormat::rgba16f : TexelFormat::rgba32f);
    } else if (precision == Precision::half) {
        halves_.resize(count);
    } else {
        floats_.resize(count);
    }
    return true;
}

void InputLayers::upload(std::span<const float> rgba, int layer) {
    const auto at = static_cast<std::size_t>(layer);
    if (device_ == ShadingDevice::gl) {
        texture_.upload(rgba, 0, layer);
    } else if (!halves_.empty()) {
        to_blocks(rgba, 3, halves_[at], [](float v) { return half_of(v); });
    } else {
        to_blocks(rgba, 4, floats_[at], [](float v) { return v; });
    }
}

}  // namespace livery
