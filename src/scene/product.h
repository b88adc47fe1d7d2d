// A product: its mesh with parts, its scale and where it stands.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

struct Product {
    std::string name;
    Mesh mesh;                   ///< in the world's frame (the product's frame)
    double product_scale = 1.0;  ///< product millimetres per mock-up millimetre (25 for the car)
    std::filesystem::path file;  ///< where it came from
    std::vector<std::string> notes;  ///< what was dropped, repaired or assumed while loading
};

/// A mesh file, or a product JSON that names one (docs/files.md). The unit comes before the one in
/// the JSON. Throws FileError.
Product load_product(const std::filesystem::path& file,
                     std::optional<LengthUnit> unit = std::nullopt);

/// A product JSON's content, its mesh not yet read.
struct ProductFile {
    std::string name;
    std::filesystem::path mesh;
    std::optional<LengthUnit> unit;
    double product_scale = 1.0;
    std::optional<Rigid3> world_from_mesh;
    std::vector<std::string> parts;  ///< that the mesh must have
};
/// Throws FileError.
ProductFile parse_product_file(const std::string& text, const std::filesystem::path& file);

/// Index of a part; throws std::invalid_argument that lists the names there are.
int part_index(const Product& product, const std::string& name);

}  // namespace livery
