// A session's product with its looks, for other programs.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "session/document.h"

namespace livery {

/// Writes the product as binary glTF that wears the looks as KHR_materials_variants, the chosen one
/// first (mesh/gltf/gltf_write.h). Returns what the file does not hold: artwork, lights,
/// measurements. Throws std::invalid_argument (no such look), FileError.
std::vector<std::string> export_product(const Document& document,
                                        const std::shared_ptr<const Product>& product,
                                        int look_id,
                                        const std::filesystem::path& file);

}  // namespace livery
