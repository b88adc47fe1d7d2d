#include "radiance/measured_textures.h"

#include <algorithm>
#include <span>

namespace livery {

void MeasuredTextures::bind(const std::shared_ptr<const MeasuredPaint>& paint, unsigned unit) {
    std::erase_if(textures_, [](const auto& known) { return known.first.expired(); });
    auto found = std::find_if(textures_.begin(), textures_.end(), [&](const auto& known) {
        return known.first.lock() == paint;
    });
    if (found == textures_.end()) {
        textures_.emplace_back(paint, texture_of(paint->grid));
        found = textures_.end() - 1;
    }
    found->second.bind(unit);
}

Texture2D texture_of(const MeasuredGrid& grid) {
    const auto [rows, layers, columns] = grid.size;
    Texture2D texture({columns, rows, layers, 1}, TexelFormat::rgba32f);
    const std::size_t of_layer = grid.texels.size() / static_cast<std::size_t>(layers);
    for (int layer = 0; layer < layers; ++layer) {
        texture.upload(
            std::span(grid.texels).subspan(static_cast<std::size_t>(layer) * of_layer, of_layer),
            0,
            layer);
    }
    return texture;
}

}  // namespace livery
