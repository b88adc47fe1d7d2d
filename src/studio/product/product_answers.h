// What a person says of a mesh before it becomes a product, and how much of it a projector's
// picture reaches.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/product.h"

namespace livery {

/// A mesh as its file has it, its numbers not yet lengths.
struct MeshFacts {
    std::filesystem::path file;  ///< the mesh's
    bool states_metres = false;  ///< glTF
    Bounds bounds;               ///< of the file's numbers
    std::vector<std::string> parts;
    std::size_t triangles = 0;
};
/// Of a mesh that was read in millimetres, so that its positions are the file's numbers.
MeshFacts facts_of(const Mesh& mesh_in_mm, const std::filesystem::path& file);

struct ProductAnswers {
    LengthUnit unit = LengthUnit::mm;
    UpAxis up = UpAxis::plus_y;
    int quarter_turns = 0;                ///< around up
    std::string front;                    ///< as it stands, in ProductFile's words
    bool mesh_is_product = true;          ///< else the mesh is the model on the bench
    double product_scale = 1.0;           ///< 25: the bench has a 1:25 model
    std::vector<std::string> part_names;  ///< one a part of the mesh
};

/// What is most likely, and why, each reason a sentence.
struct SuggestedAnswers {
    ProductAnswers answers;
    std::string unit_why, up_why, scale_why;
};
/// The unit is glTF's or guess_unit()'s; up is glTF's y, else the shorter of y and z; a mesh of
/// half a metre or more is the product, and the model the largest usual one below 200 mm. A unit
/// that was said stands.
SuggestedAnswers suggested_answers(const MeshFacts& facts, std::optional<LengthUnit> said = {});

/// Turned by another right angle, its front with it.
void turn(ProductAnswers& answers);
/// Where another axis is up, it is not known where the front then points.
void set_up(ProductAnswers& answers, UpAxis up);

/// Width, height and depth as it stands, millimetres.
glm::dvec3 mock_up_size_mm(const MeshFacts& facts, const ProductAnswers& answers);
glm::dvec3 product_size_mm(const MeshFacts& facts, const ProductAnswers& answers);
/// "184 x 60 x 75 mm".
std::string size_text(const glm::dvec3& size_mm);
/// "1:25 model"; "real size" for 1.
std::string scale_text(double product_scale);

inline constexpr double kLeastScale = 1e-3, kMostScale = 1e6;  ///< as product files have it

/// Why there can be no product yet; empty: there can.
std::string problem_of(const ProductAnswers& answers);

/// As a product file has it: it stands on the ground, its middle over the origin.
ProductFile product_file_of(const MeshFacts& facts,
                            const ProductAnswers& answers,
                            const std::string& name);

/// A place on a mesh; all of a mesh's stand for the same area.
struct MeshSample {
    glm::vec3 position, normal;  ///< the normal on either side, unit
};
/// So many, spread evenly over the mesh's area, in the mesh's own numbers; the same every time.
/// None of a mesh without area.
std::vector<MeshSample> mesh_samples(const Mesh& mesh, std::size_t count = 4000);

/// The share of what the projector has before it of the product, by solid angle, that lies in its
/// picture, 0 to 1. `product` says where the mesh stands and how large; nothing hides anything.
/// None without samples.
std::optional<double> lit_share(const std::vector<MeshSample>& samples,
                                const ProductFile& product,
                                const View& projector);

/// What a person reads of it: a sentence.
std::string lit_share_text(double share);

}  // namespace livery
