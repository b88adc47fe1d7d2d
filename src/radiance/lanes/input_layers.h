// What shading reads of all fragments, where the device that shades has it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gl/handles.h"
#include "radiance/packed_fragments.h"

namespace livery {

/// Where fragments are shaded and mixed to pixels. Both read the same source (shade.glsl).
enum class ShadingDevice {
    automatic,  ///< the processor where OpenGL is software, else OpenGL
    gl,
    processor  ///< eight fragments at a time on all threads
};

/// What `asked` means in the current OpenGL context: the one place where a device is chosen.
ShadingDevice chosen_device(ShadingDevice asked);

/// What a renderer keeps in half floats. A picture is drawn with halves; full floats are there to
/// tell what those make of it, and OpenGL's alone.
enum class StoredHalves {
    all,     ///< light that reaches fragments, shaded fragments, the picture
    inputs,  ///< light that reaches fragments
    none
};

/// One input in the packed layout, in one or more layers.
class InputLayers {
  public:
    enum class Precision { half, full };

    /// True when it is new; nothing happens to one that has this size. 0 layers: a texture that is
    /// no array, one layer on the processor.
    bool make(ShadingDevice device, int rows, int layers, Precision precision);
    /// Room for some of so many layers, and for those that had it, with what they hold; places
    /// that nobody uploads to are black. True where there is more than before.
    bool make_room(ShadingDevice device,
                   int rows,
                   const std::vector<bool>& layers,
                   Precision precision);
    /// R, G, B, A of each place of the layout, or of some rows of it; of `half`, the processor
    /// takes colours only, and a negative one as 0.
    void upload(std::span<const float> rgba, int layer, int first_row = 0);
    explicit operator bool() const { return rows_ > 0; }
    bool has(std::size_t layer) const { return places_[layer] >= 0; }
    /// Where each layer is in the texture; -1: nowhere.
    std::span<const int> places() const { return places_; }

    const Texture2D& texture() const { return texture_; }
    /// For the processor, in blocks of kLaneBlock fragments (lane_functions.h).
    const float* floats(std::size_t layer) const { return floats_[layer].data(); }
    const std::uint16_t* halves(std::size_t layer) const { return halves_[layer].data(); }

  private:
    ShadingDevice device_ = ShadingDevice::gl;
    int rows_ = 0, layers_ = 0;
    std::vector<int> places_;
    Texture2D texture_;
    std::vector<std::vector<float>> floats_;
    std::vector<std::vector<std::uint16_t>> halves_;
};

}  // namespace livery
