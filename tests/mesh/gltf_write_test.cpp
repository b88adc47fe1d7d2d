// Products with looks as glTF, and back.
#include "mesh/gltf/gltf_write.h"

#include <cstring>
#include <functional>

#include <gtest/gtest.h>

#include "appearance/material_json.h"
#include "mesh/gltf_builder.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

Material paint(const std::string& name, ReflectanceModel model) {
    Material made;
    made.name = name;
    made.family = "solid";
    made.model = model;
    made.diffuse = {0.6, 0.1, 0.05};
    return made;
}

/// glTF has words for all of it.
Material brushed() {
    Material made = paint("brushed", ReflectanceModel::ggx);
    made.diffuse = glm::dvec3(0.0);
    made.f0 = {0.9, 0.7, 0.4};
    made.alpha = {0.1, 0.4};
    return made;
}
Material coated() {
    Material made = paint("coated", ReflectanceModel::clearcoat);
    made.f0 = glm::dvec3(0.08, 0.06, 0.04);
    made.alpha = {0.25, 0.25};
    made.coat_f0 = 0.03;
    made.coat_alpha = 0.01;
    return made;
}
/// It has none for these.
Material pearl() {
    Material made = paint("pearl", ReflectanceModel::car_paint);
    made.f0 = {0.1, 0.2, 0.3};
    made.flake_f0 = {0.5, 0.5, 0.4};
    made.film_nm = 320.0;
    return made;
}
Material tinted() {
    Material made = coated();
    made.name = "tinted";
    made.coat_transmittance = {0.9, 0.5, 0.5};
    return made;
}

/// Two spheres, one a part.
Mesh two_parts() {
    Mesh mesh = make_sphere({0.0, 0.0, 0.0}, 20.0, 8, "body");
    append(mesh, make_sphere({60.0, 5.0, 0.0}, 10.0, 6, "wheel"), "");
    return mesh;
}

class GltfWrite : public ::testing::Test {
  protected:
    Mesh back(const std::string& bytes) {
        notes_.clear();
        return load_mesh(folder_.write("written.glb", bytes), &notes_);
    }
    /// The file after somebody's change of its JSON.
    Mesh back_changed(const std::string& bytes, const std::function<void(Json&)>& change) {
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, 4);
        Json json = Json::parse(bytes.substr(20, length));
        change(json);
        std::string text = json.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string changed = bytes.substr(0, 12);
        const auto append_u32 = [&changed](std::size_t value) {
            const auto word = static_cast<std::uint32_t>(value);
            changed.append(reinterpret_cast<const char*>(&word), 4);
        };
        append_u32(text.size());
        changed += "JSON" + text + bytes.substr(20 + length);
        const auto whole = static_cast<std::uint32_t>(changed.size());
        std::memcpy(changed.data() + 8, &whole, 4);
        return back(changed);
    }
    TemporaryFolder folder_;
    std::vector<std::string> notes_;
};

void expect_same(const Material& found, const Material& wanted) {
    EXPECT_EQ(found.name, wanted.name);
    ASSERT_EQ(found.model, wanted.model) << wanted.name;
    const Json a = json_of(found)["parameters"], b = json_of(wanted)["parameters"];
    for (const auto& [key, value] : b.items()) {
        const auto near = [&](const Json& x, const Json& y) {
            EXPECT_NEAR(x.get<double>(), y.get<double>(), 1e-6) << wanted.name << " " << key;
        };
        ASSERT_TRUE(a.contains(key)) << wanted.name << " " << key;
        if (value.is_number() && a[key].is_number()) {
            near(a[key], value);
            continue;
        }
        ASSERT_EQ(a[key].size(), value.size()) << wanted.name << " " << key;
        for (std::size_t k = 0; k < value.size(); ++k) near(a[key][k], value[k]);
    }
}

TEST_F(GltfWrite, LooksComeBackAsVariantsWithTheirPaints) {
    const Mesh mesh = two_parts();
    const std::vector<MeshLook> looks{
        {"day", {coated(), brushed()}},
        {"night", {pearl(), brushed()}},
        {"matt", {paint("chalk", ReflectanceModel::lambert), tinted()}}};
    std::vector<std::string> said;
    const Mesh found = back(gltf_bytes(mesh, looks, said));
    EXPECT_TRUE(said.empty());
    EXPECT_TRUE(notes_.empty()) << notes_.front();
    ASSERT_EQ(found.parts.size(), 2u);
    EXPECT_EQ(found.parts[1].name, "wheel");
    expect_same(found.parts[0].paint.value(), coated());
    ASSERT_EQ(found.variants.size(), 3u);
    for (std::size_t k = 0; k < looks.size(); ++k) {
        EXPECT_EQ(found.variants[k].name, looks[k].name);
        for (std::size_t part = 0; part < 2; ++part) {
            expect_same(found.variants[k].parts.at(part).paint.value(),
                        looks[k].part_materials[part]);
        }
    }
}

TEST_F(GltfWrite, TheMeshComesBackAsItWas) {
    const Mesh mesh = two_parts();
    std::vector<std::string> said;
    const std::vector<MeshLook> looks{{"one", {coated(), brushed()}}};
    const Mesh found = back(gltf_bytes(mesh, looks, said));
    ASSERT_EQ(found.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        EXPECT_EQ(found.triangle_part[t], mesh.triangle_part[t]);
        for (int c = 0; c < 3; ++c) {
            const auto a = found.triangles[t][c], b = mesh.triangles[t][c];
            ASSERT_LT(glm::distance(found.positions_mm[a], mesh.positions_mm[b]), 1e-4f);
            ASSERT_LT(glm::distance(found.normals[a], mesh.normals[b]), 1e-5f);
            ASSERT_LT(glm::distance(found.uvs[a], mesh.uvs[b]), 1e-6f);
        }
    }
}

TEST_F(GltfWrite, WordsChangedElsewhereComeBeforeThePaintBesideThem) {
    std::vector<std::string> said;
    const std::vector<MeshLook> looks{{"one", {pearl(), brushed()}}};
    const std::string bytes = gltf_bytes(two_parts(), looks, said);
    const Mesh found = back_changed(bytes, [](Json& json) {
        json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.0, 0.5, 0.0, 1.0};
    });
    ASSERT_EQ(notes_.size(), 1u);
    EXPECT_NE(notes_[0].find("pearl"), std::string::npos);
    EXPECT_EQ(found.parts[0].paint->model, ReflectanceModel::clearcoat);
    EXPECT_EQ(found.parts[0].paint->diffuse, glm::dvec3(0.0, 0.5, 0.0));
}

TEST_F(GltfWrite, ADamagedPaintIsRefusedByName) {
    std::vector<std::string> said;
    const std::vector<MeshLook> looks{{"one", {pearl(), brushed()}}};
    const std::string bytes = gltf_bytes(two_parts(), looks, said);
    const auto with = [&](const Json& text) {
        return [&, text] {
            back_changed(
                bytes, [&](Json& json) { json["materials"][0]["extras"]["livery_paint"] = text; });
        };
    };
    EXPECT_TRUE(fails_with(with(7), {"materials[0].extras.livery_paint", "7"}));
    EXPECT_TRUE(fails_with(with("{}"), {"written.glb", "format_version"}));
    EXPECT_TRUE(fails_with(with("no paint"), {"written.glb"}));
}

TEST_F(GltfWrite, LooksMustDressEveryPart) {
    std::vector<std::string> said;
    EXPECT_THROW(gltf_bytes(two_parts(), {}, said), std::invalid_argument);
    const std::vector<MeshLook> one{{"one", {pearl()}}};
    EXPECT_THROW(gltf_bytes(two_parts(), one, said), std::invalid_argument);
}

}  // namespace
}  // namespace livery
