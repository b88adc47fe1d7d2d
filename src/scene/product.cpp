#include "scene/product.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/hash.h"
#include "core/json.h"
#include "core/paths.h"
#include "core/random.h"
#include "core/statistics.h"
#include "scene/pose_io.h"

namespace livery {

namespace {

constexpr std::size_t kSenders = 2048, kReceiversAPart = 48;
constexpr double kLeast = 1e-6;

struct SurfacePlace {
    glm::dvec3 position_mm{0.0}, normal{0.0};
    double area_mm2 = 0.0;  ///< that it stands for
    std::size_t part = 0;
    bool two_sided = false;
};

glm::dvec3 corner(const Mesh& mesh, std::size_t triangle, int k) {
    return glm::dvec3(mesh.positions_mm[mesh.triangles[triangle][k]]);
}

/// Twice its area, along its outward normal.
glm::dvec3 area_vector(const Mesh& mesh, std::size_t triangle) {
    const glm::dvec3 a = corner(mesh, triangle, 0);
    return glm::cross(corner(mesh, triangle, 1) - a, corner(mesh, triangle, 2) - a);
}

/// `count` places over these triangles, each of them as likely as its area is large.
std::vector<SurfacePlace> places_on(const Mesh& mesh,
                                    const std::vector<double>& areas_mm2,
                                    const std::vector<std::uint32_t>& triangles,
                                    std::size_t count,
                                    Random& random) {
    std::vector<double> up_to;
    up_to.reserve(triangles.size());
    double area = 0.0;
    for (const std::uint32_t t : triangles) up_to.push_back(area += areas_mm2[t]);
    std::vector<SurfacePlace> places;
    if (!(area > 0.0)) return places;
    for (std::size_t k = 0; k < count; ++k) {
        const double at = (static_cast<double>(k) + random.uniform()) / static_cast<double>(count);
        const auto found = std::upper_bound(up_to.begin(), up_to.end(), at * area);
        const auto index =
            std::min(static_cast<std::size_t>(found - up_to.begin()), triangles.size() - 1);
        const std::uint32_t t = triangles[index];
        const glm::dvec3 outward = area_vector(mesh, t);
        if (!(glm::length(outward) > 0.0)) continue;
        const double u = std::sqrt(random.uniform()), v = random.uniform();
        SurfacePlace& place = places.emplace_back();
        place.position_mm = (1.0 - u) * corner(mesh, t, 0) + u * (1.0 - v) * corner(mesh, t, 1) +
                            u * v * corner(mesh, t, 2);
        place.normal = glm::normalize(outward);
        place.area_mm2 = area / static_cast<double>(count);
        place.part = mesh.triangle_part[t];
        place.two_sided = has_two_sides(mesh, t);
    }
    return places;
}

/// Of a disc of that area (its form factor at a point under it, bounded where both are near);
/// negative on the point's back.
double form_factor(const SurfacePlace& to, const SurfacePlace& from) {
    const glm::dvec3 way = from.position_mm - to.position_mm;
    const double distance2 = glm::dot(way, way);
    const double rises = glm::dot(to.normal, way), falls = -glm::dot(from.normal, way);
    if (rises == 0.0 || falls == 0.0) return 0.0;
    if ((rises < 0.0 && !to.two_sided) || (falls < 0.0 && !from.two_sided)) return 0.0;
    return rises / distance2 * std::abs(falls) * from.area_mm2 /
           (std::numbers::pi * distance2 + from.area_mm2);
}

}  // namespace

PartExchange part_exchange(const Mesh& mesh) {
    PartExchange exchange;
    exchange.parts = mesh.parts.size();
    exchange.share.assign(exchange.parts * exchange.parts, 0.0f);
    Random random(1);
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::vector<std::vector<std::uint32_t>> of_part(exchange.parts);
    std::vector<double> areas_mm2(mesh.triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) {
        all[t] = t;
        areas_mm2[t] = 0.5 * glm::length(area_vector(mesh, t));
        of_part[mesh.triangle_part[t]].push_back(t);
    }
    const std::vector<SurfacePlace> senders = places_on(mesh, areas_mm2, all, kSenders, random);
    for (std::size_t to = 0; to < exchange.parts; ++to) {
        std::vector<std::vector<double>> seen(exchange.parts);
        for (const SurfacePlace& receiver :
             places_on(mesh, areas_mm2, of_part[to], kReceiversAPart, random)) {
            std::vector<double> front(exchange.parts, 0.0), back(exchange.parts, 0.0);
            for (const SurfacePlace& sender : senders) {
                const double share = form_factor(receiver, sender);
                (share < 0.0 ? back : front)[sender.part] += std::abs(share);
            }
            for (std::size_t from = 0; from < exchange.parts; ++from) {
                seen[from].push_back(std::min(std::max(front[from], back[from]), 1.0));
            }
        }
        for (std::size_t from = 0; from < exchange.parts; ++from) {
            // Facets of what is convex face one another by rounding
            const double share = quantile(seen[from], 0.95);
            exchange.share[to * exchange.parts + from] =
                share < kLeast ? 0.0f : static_cast<float>(share);
        }
    }
    return exchange;
}

namespace {

std::string known_parts_text(const Mesh& mesh) {
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

void rename_parts(const ProductFile& said, const std::filesystem::path& file, Mesh& mesh) {
    const std::string known = known_parts_text(mesh);
    for (const auto& [name, new_name] : said.part_names) {
        if (has_part(mesh, name)) continue;
        throw FileError(file, "part_names", "\"" + name + "\"", "a part of the mesh: " + known);
    }
    const auto rename = [&](Part& part) {
        const auto named = said.part_names.find(part.name);
        if (named != said.part_names.end()) part.name = named->second;
    };
    for (Part& part : mesh.parts) rename(part);
    for (MeshVariant& variant : mesh.variants) {
        for (auto& [index, part] : variant.parts) rename(part);
    }
    std::set<std::string> names;
    for (const Part& part : mesh.parts) {
        if (names.insert(part.name).second) continue;
        throw FileError(file,
                        "part_names",
                        "two parts called \"" + part.name + "\"",
                        "a name of its own for each of " + known);
    }
}

}  // namespace

std::string shape_hash(const Mesh& mesh) {
    Hasher hasher;
    const std::size_t counts[] = {mesh.positions_mm.size(), mesh.triangles.size()};
    hasher.add(std::span<const std::size_t>(counts));
    hasher.add(std::span<const glm::vec3>(mesh.positions_mm));
    hasher.add(std::span<const glm::uvec3>(mesh.triangles));
    return hasher.hex();
}

Product load_product(const std::filesystem::path& file, std::optional<LengthUnit> unit) {
    Product product;
    product.file = file;
    product.name = file.stem().string();
    if (file.extension() != ".json") {
        product.mesh = load_mesh(file, &product.notes, unit);
        product.exchange = part_exchange(product.mesh);
        return product;
    }
    const ProductFile said = parse_product_file(read_text_file(file), file);
    product.name = said.name;
    product.product_scale = said.product_scale;
    product.mesh = load_mesh(said.mesh, &product.notes, unit ? unit : said.unit);
    apply(said, file, product.mesh);
    product.exchange = part_exchange(product.mesh);
    return product;
}

void apply(const ProductFile& said, const std::filesystem::path& file, Mesh& mesh) {
    if (said.mesh_scale != 1.0) {
        for (auto& position : mesh.positions_mm) {
            position = glm::vec3(said.mesh_scale * glm::dvec3(position));
        }
    }
    if (said.world_from_mesh) move(mesh, *said.world_from_mesh);
    rename_parts(said, file, mesh);
    for (std::size_t k = 0; k < said.parts.size(); ++k) {
        if (has_part(mesh, said.parts[k])) continue;
        throw FileError(file,
                        "parts[" + std::to_string(k) + "]",
                        "\"" + said.parts[k] + "\"",
                        "a part of the mesh: " + known_parts_text(mesh));
    }
}

ProductFile parse_product_file(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    ProductFile product;
    root.require_format_version(1);
    root.allow_only({"format_version",
                     "name",
                     "mesh",
                     "unit",
                     "mesh_scale",
                     "product_scale",
                     "pose",
                     "part_names",
                     "parts",
                     "front"});
    product.name = root.has("name") ? root["name"].text() : file.stem().string();
    if (root.has("mesh_scale")) {
        product.mesh_scale = root["mesh_scale"].number_between(1e-6, 1e6);
    }
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
        product.front = root["front"].text();
        const std::set<std::string> sides{"+x", "-x", "+z", "-z"};
        if (!sides.contains(product.front)) {
            root["front"].fail(root["front"].found(), "+x, -x, +z or -z");
        }
    }
    if (root.has("pose")) {
        root["pose"].allow_only({"rotation", "translation_mm"});
        product.world_from_mesh = read_pose(root["pose"]);
    }
    if (root.has("part_names")) {
        const JsonReader names = root["part_names"];
        for (const std::string& name : names.keys()) {
            product.part_names[name] = names[name].text();
            if (product.part_names[name].empty()) names[name].fail("an empty name", "a name");
        }
    }
    if (root.has("parts")) {
        for (std::size_t k = 0; k < root["parts"].size(); ++k) {
            product.parts.push_back(root["parts"].at(k).text());
        }
    }
    return product;
}

std::string text_of(const ProductFile& product, const std::filesystem::path& file) {
    const auto folder = std::filesystem::absolute(file).lexically_normal().parent_path();
    const auto mesh = std::filesystem::absolute(product.mesh).lexically_normal();
    const auto beside = mesh.lexically_relative(folder);
    const bool below = !beside.empty() && *beside.begin() != "..";
    Json json = {{"format_version", 1},
                 {"name", product.name},
                 {"mesh", (below ? beside : mesh).string()},
                 {"mesh_scale", product.mesh_scale},
                 {"product_scale", product.product_scale}};
    if (product.unit) json["unit"] = to_string(*product.unit);
    if (product.world_from_mesh) json["pose"] = json_of(*product.world_from_mesh);
    if (!product.part_names.empty()) json["part_names"] = product.part_names;
    if (!product.parts.empty()) json["parts"] = product.parts;
    if (!product.front.empty()) json["front"] = product.front;
    return json.dump(4) + "\n";
}

glm::dmat3 upright_rotation(UpAxis up, int quarter_turns) {
    const int axis = static_cast<int>(up) / 2;
    const double sign = static_cast<int>(up) % 2 == 0 ? 1.0 : -1.0;
    // Rows: what becomes x, y and z.
    glm::dmat3 rows(1.0);
    if (axis == 0) rows = {{0.0, -sign, 0.0}, {sign, 0.0, 0.0}, {0.0, 0.0, 1.0}};
    if (axis == 1) rows = {{1.0, 0.0, 0.0}, {0.0, sign, 0.0}, {0.0, 0.0, sign}};
    if (axis == 2) rows = {{1.0, 0.0, 0.0}, {0.0, 0.0, sign}, {0.0, -sign, 0.0}};
    const glm::dmat3 quarter =
        glm::transpose(glm::dmat3{{0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}});
    glm::dmat3 rotation = glm::transpose(rows);
    for (int k = 0; k < (quarter_turns % 4 + 4) % 4; ++k) rotation = quarter * rotation;
    return rotation;
}

Rigid3 standing_pose(const Bounds& mesh_mm, const glm::dmat3& world_from_mesh) {
    const glm::dvec3 a = world_from_mesh * mesh_mm.low, b = world_from_mesh * mesh_mm.high;
    const glm::dvec3 low = glm::min(a, b), middle = 0.5 * (a + b);
    return {world_from_mesh, {-middle.x, -low.y, -middle.z}};
}

int part_index(const Product& product, const std::string& name) {
    const auto& parts = product.mesh.parts;
    const auto found = std::find_if(
        parts.begin(), parts.end(), [&](const Part& part) { return part.name == name; });
    check_argument(found != parts.end(),
                   "no part \"" + name + "\"; there are " + known_parts_text(product.mesh));
    return static_cast<int>(found - parts.begin());
}

}  // namespace livery
