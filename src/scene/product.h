// A product: its mesh with parts, its scale and where it stands.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

/// Shares of a hemisphere, weighted by the cosine (form factors), with nothing in between: at least
/// what is seen; of a two-sided place the side that sees more. A closed convex mesh has none.
struct PartExchange {
    std::size_t parts = 0;
    std::vector<float> share;  ///< parts x parts

    /// Of the places on part `to`, 95% see no more of part `from` than this.
    float of(std::size_t to, std::size_t from) const { return share[to * parts + from]; }
};

/// From points spread over the surface by area; the same mesh gives the same answer.
PartExchange part_exchange(const Mesh& mesh);

struct Product {
    std::string name;
    Mesh mesh;                   ///< in the world's frame (the product's frame)
    double product_scale = 1.0;  ///< product millimetres per mock-up millimetre (25 for the car)
    std::filesystem::path file;  ///< where it came from
    std::vector<std::string> notes;  ///< what was dropped, repaired or assumed while loading
    PartExchange exchange{};         ///< of the mesh; empty: whoever asks works it out
};

/// Of a mock-up's shape: positions and triangles as they are.
std::string shape_hash(const Mesh& mesh);

/// A mesh file, or a product JSON that names one (docs/files.md). The unit comes before the one in
/// the JSON. Throws FileError.
Product load_product(const std::filesystem::path& file,
                     std::optional<LengthUnit> unit = std::nullopt);

/// A product JSON's content, its mesh not yet read.
struct ProductFile {
    std::string name;
    std::filesystem::path mesh;
    std::optional<LengthUnit> unit;
    double mesh_scale = 1.0;  ///< the mock-up is so many times as large as the mesh
    double product_scale = 1.0;
    std::optional<Rigid3> world_from_mesh;          ///< of the mesh in the mock-up's size
    std::map<std::string, std::string> part_names;  ///< what parts are called instead
    std::string front;                              ///< "+x", "-x", "+z", "-z"; empty: not said
    std::vector<std::string> parts;                 ///< that the mesh must have, by their new names
};
/// Throws FileError.
ProductFile parse_product_file(const std::string& text, const std::filesystem::path& file);
/// What parse_product_file() reads as the same, for a file at `file`: a mesh in its folder or below
/// is named from there, any other by its whole path.
std::string text_of(const ProductFile& product, const std::filesystem::path& file);

/// Resizes, moves and renames a mesh as a product JSON says. Throws FileError (as of `file`) for
/// parts that it lacks.
void apply(const ProductFile& said, const std::filesystem::path& file, Mesh& mesh);

/// The direction of a mesh file's axes that is up in the world.
enum class UpAxis { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// Turns `up` to +y by the shortest way, then so many right angles around +y, counter-clockwise
/// seen from above.
glm::dmat3 upright_rotation(UpAxis up, int quarter_turns);

/// With that rotation, where the mesh stands on the ground with its middle over the origin. Of the
/// mesh in the mock-up's size.
Rigid3 standing_pose(const Bounds& mesh_mm, const glm::dmat3& world_from_mesh);

/// Index of a part; throws std::invalid_argument that lists the names there are.
int part_index(const Product& product, const std::string& name);

}  // namespace livery
