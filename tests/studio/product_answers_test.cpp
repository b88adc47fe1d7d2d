// What is suggested for a mesh, what the answers come to, and the session made of them.
#include <algorithm>
#include <bit>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "mesh/scan_writer.h"
#include "scene/library.h"
#include "studio/product/mesh_picture.h"
#include "studio/product/new_session.h"
#include "studio/product/open_session.h"
#include "studio/window/shell.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// A box of these sides about `middle`, in a file's numbers.
Mesh box(const glm::vec3& sides, const glm::vec3& middle = {}) {
    ScanWriter scan = box_scan(0.5f * sides);
    for (glm::vec3& position : scan.positions) position += middle;
    return read_mesh(
        scan.binary_ply(std::endian::little), "/no folder/box.ply", nullptr, LengthUnit::mm);
}

TEST(SuggestedAnswers, AScanOfACarInMetresWithZUpIsSeenThrough) {
    const MeshFacts facts = facts_of(box({4.6f, 1.9f, 1.45f}, {12, -3, 0.7f}), "car.ply");
    const auto [answers, unit_why, up_why, scale_why] = suggested_answers(facts);
    EXPECT_EQ(answers.unit, LengthUnit::m);
    EXPECT_NE(unit_why.find("4.6"), std::string::npos) << unit_why;
    EXPECT_EQ(answers.up, UpAxis::plus_z);
    EXPECT_TRUE(answers.mesh_is_product);
    EXPECT_EQ(answers.product_scale, 25.0);
    EXPECT_EQ(size_text(product_size_mm(facts, answers)), "4,600 x 1,450 x 1,900 mm");
    EXPECT_EQ(size_text(mock_up_size_mm(facts, answers)), "184 x 58 x 76 mm");
    EXPECT_FALSE(up_why.empty() || scale_why.empty());
}

TEST(SuggestedAnswers, WhatIsSmallIsTheModelItself) {
    const MeshFacts facts = facts_of(box({180, 60, 75}), "car.obj");
    const ProductAnswers answers = suggested_answers(facts).answers;
    EXPECT_EQ(answers.unit, LengthUnit::mm);
    EXPECT_EQ(answers.up, UpAxis::plus_y);
    EXPECT_FALSE(answers.mesh_is_product);
    EXPECT_EQ(answers.product_scale, 1.0);
    EXPECT_EQ(mock_up_size_mm(facts, answers), glm::dvec3(180, 60, 75));
    ProductAnswers model = answers;
    model.product_scale = 25.0;
    EXPECT_EQ(mock_up_size_mm(facts, model), glm::dvec3(180, 60, 75));
    EXPECT_EQ(product_size_mm(facts, model), glm::dvec3(4500, 1500, 1875));
}

TEST(SuggestedAnswers, GltfSaysItsUnitAndWhatIsUp) {
    const MeshFacts facts = facts_of(box({30, 1, 0.5f}), "bus.GLB");
    EXPECT_EQ(suggested_answers(facts).answers.unit, LengthUnit::m);
    EXPECT_EQ(suggested_answers(facts).answers.up, UpAxis::plus_y);
}

TEST(ProductAnswers, ScalesHaveWords) {
    EXPECT_EQ(scale_text(1.0), "real size");
    EXPECT_EQ(scale_text(25.0), "1:25 model");
    EXPECT_EQ(scale_text(0.1), "10:1 model");
}

TEST(ProductAnswers, NamesAndScalesThatCannotBeAreRefusedInWords) {
    ProductAnswers answers;
    answers.part_names = {"body", "glass"};
    EXPECT_EQ(problem_of(answers), "");
    answers.part_names = {"body", "body"};
    EXPECT_NE(problem_of(answers).find("\"body\""), std::string::npos);
    answers.part_names = {"body", "  "};
    EXPECT_EQ(problem_of(answers), "Each part needs a name.");
    answers.part_names = {"body"};
    for (const double scale : {0.0, -1.0, 1e7, std::nan("")}) {
        answers.product_scale = scale;
        EXPECT_NE(problem_of(answers), "") << scale;
    }
}

/// The mean place, from 0 to 1, of what is seen of the mesh, and the share of the picture that
/// anything fills.
struct Seen {
    double filled = 0.0;
    int brightest = 0;
};
Seen seen_in(const Image8& picture) {
    Seen seen;
    for (std::size_t k = 0; k < picture.pixel_count(); ++k) {
        seen.filled += picture.values[4 * k + 3] > 127 ? 1.0 : 0.0;
        seen.brightest = std::max<int>(seen.brightest, picture.values[4 * k]);
    }
    seen.filled /= static_cast<double>(picture.pixel_count());
    return seen;
}

TEST(MeshPicture, ShowsTheProductAsItWouldStand) {
    const Mesh mesh = box({4.6f, 1.9f, 1.45f}, {12, -3, 0.7f});
    const glm::ivec2 size{220, 150};
    const Image8 lying = mesh_picture(mesh, upright_rotation(UpAxis::plus_z, 0), size);
    EXPECT_EQ(glm::ivec2(lying.width, lying.height), size);
    const Seen seen = seen_in(lying);
    EXPECT_GT(seen.filled, 0.2);
    EXPECT_LT(seen.filled, 0.9);
    EXPECT_GT(seen.brightest, 120);
    // On its end it is narrow, and the corners of the picture stay empty.
    const Seen upright = seen_in(mesh_picture(mesh, upright_rotation(UpAxis::plus_x, 0), size));
    EXPECT_LT(upright.filled, seen.filled);
    EXPECT_GT(upright.filled, 0.05);
    EXPECT_THROW(mesh_picture(mesh, glm::dmat3(1.0), {0, 10}), std::invalid_argument);
}

}  // namespace
}  // namespace livery
