#include "scene/product.h"

#include <algorithm>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "scene/pose_io.h"

namespace livery {

namespace {

std::string part_names(const Mesh& mesh) {
    std::string names;
    for (const auto& part : mesh.parts) names += (names.empty() ? "" : ", ") + part.name;
    return names;
}

bool has_part(const Mesh& mesh, const std::string& name) {
    return std::any_of(
        mesh.parts.begin(), mesh.parts.end(), [&](const Part& part) { return part.name == name; });
}

void move(Mesh& mesh, const Rigid3& world_from_mesh) {
    for (auto& position : mesh.positions_mm) {
        position = glm::vec3(world_from_mesh * glm::dvec3(position));
    }
    const glm::mat3 rotation(world_from_mesh.rotation);
    for (auto& normal : mesh.normals) normal = rotation * normal;
    for (auto& tangent : mesh.tangents) {
        tangent = glm::vec4(rotation * glm::vec3(tangent), tangent.w);
    }
}

}  // namespace

Product load_product(const std::filesystem::path& file, std::optional<LengthUnit> unit) {
    Product product;
    product.file = file;
    product.name = file.stem().string();
    if (file.extension() != ".json") {
        product.mesh = load_mesh(file, &product.notes, unit);
        return product;
    }
    const ProductFile said = parse_product_file(read_text_file(file), file);
    product.name = said.name;
    product.product_scale = said.product_scale;
    product.mesh = load_mesh(said.mesh, &product.notes, unit ? unit : said.unit);
    if (said.world_from_mesh) move(product.mesh, *said.world_from_mesh);
    for (std::size_t k = 0; k < said.parts.size(); ++k) {
        if (has_part(product.mesh, said.parts[k])) continue;
        throw FileError(file,
                        "parts[" + std::to_string(k) + "]",
                        "\"" + said.parts[k] + "\"",
                        "a part of the mesh: " + part_names(product.mesh));
    }
    return product;
}

ProductFile parse_product_file(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    ProductFile product;
    root.require_format_version(1);
    root.allow_only(
        {"format_version", "name", "mesh", "unit", "product_scale", "pose", "parts", "front"});
    product.name = root.has("name") ? root["name"].text() : file.stem().string();
    if (root.has("product_scale")) {
        product.product_scale = root["product_scale"].number_between(1e-3, 1e6);
    }
    const auto mesh_name = root["mesh"].text();
    if (mesh_name.empty()) root["mesh"].fail("an empty name", "a mesh file");
    product.mesh = file.parent_path() / mesh_name;
    if (root.has("unit")) {
        product.unit = parse_length_unit(root["unit"].text());
        if (!product.unit) root["unit"].fail(root["unit"].found(), "mm, cm, m or in");
    }
    if (root.has("front")) {
        const std::string front = root["front"].text();
        if (front != "+x" && front != "-x" && front != "+z" && front != "-z") {
            root["front"].fail(root["front"].found(), "+x, -x, +z or -z");
        }
    }
    if (root.has("pose")) {
        root["pose"].allow_only({"rotation", "translation_mm"});
        product.world_from_mesh = read_pose(root["pose"]);
    }
    if (root.has("parts")) {
        for (std::size_t k = 0; k < root["parts"].size(); ++k) {
            product.parts.push_back(root["parts"].at(k).text());
        }
    }
    return product;
}

int part_index(const Product& product, const std::string& name) {
    const auto& parts = product.mesh.parts;
    const auto found = std::find_if(
        parts.begin(), parts.end(), [&](const Part& part) { return part.name == name; });
    check_argument(found != parts.end(),
                   "no part \"" + name + "\"; there are " + part_names(product.mesh));
    return static_cast<int>(found - parts.begin());
}

}  // namespace livery
