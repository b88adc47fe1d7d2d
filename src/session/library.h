// Names that people type -> products and looks, shipped or their own.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scene/look.h"
#include "scene/product.h"

namespace livery {

/// A file, or the name of a shipped product ("car", "sphere"). Throws FileError with the names
/// there are.
std::shared_ptr<const Product> find_product(const std::string& name_or_file);

/// Names of a product's parts; the product is read once a run. Throws FileError.
std::vector<std::string> part_names(const std::string& product_name_or_file);

/// A file, or the name of a shipped look. Throws FileError with the names there are.
Look find_look(const std::string& name_or_file);

/// Names of the shipped looks, sorted.
std::vector<std::string> shipped_looks();

/// Where the shipped look of that name lies; throws FileError with the names there are.
std::filesystem::path shipped_look_file(const std::string& name);

}  // namespace livery
