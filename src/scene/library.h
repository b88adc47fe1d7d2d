// Names that people type -> products and looks, shipped or their own.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/look.h"
#include "scene/product.h"

namespace livery {

/// The simulated bench that a shipped product stands on ("car", "player", "sphere"); none for
/// another name.
std::optional<std::string> bench_of_shipped_product(const std::string& name);

/// A file, or the name of a shipped product. The unit is what a file's numbers
/// are in, where that is known better than the file does. Throws FileError with the names there
/// are.
std::shared_ptr<const Product> find_product(const std::string& name_or_file,
                                            std::optional<LengthUnit> unit = std::nullopt);

std::vector<std::string> part_names(const Mesh& mesh);

/// Names of a product's parts, as find_product() read it last, in any thread; it is read where it
/// was not yet. Throws FileError.
std::vector<std::string> part_names(const std::string& product_name_or_file);

/// Where the front of a product points as it stands, "+x", "-x", "+z" or "-z", as its product
/// file says; empty where none does. Read once a run. Throws FileError.
std::string front_of_product(const std::string& name_or_file);

/// A file, or the name of a shipped look. Throws FileError with the names there are.
Look find_look(const std::string& name_or_file);

/// The same for a product with these parts. A shipped look says what the car wears: parts that
/// another product lacks are left out, and without a body all of it wears the body's paint.
Look find_look_for(const std::string& name_or_file, const std::vector<std::string>& parts);

/// What a product's file has itself, in the light of the first shipped look: where it has pictures
/// or variants, "as it comes", and a look for each variant, named as that is.
std::vector<Look> own_looks(const Mesh& mesh);

/// find_look_for() of a file, a shipped look or one of own_looks(), in this order.
Look find_look_for(const std::string& name_or_file, const Mesh& mesh);

/// Names of the shipped looks, sorted.
std::vector<std::string> shipped_looks();

/// Where the shipped look of that name lies; throws FileError with the names there are.
std::filesystem::path shipped_look_file(const std::string& name);

}  // namespace livery
