#include "studio/product/product_answers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/library.h"
#include "studio/kit/folders.h"
#include "studio/kit/widgets.h"

namespace livery {

namespace {

/// What stands on a bench in front of a projector is smaller than this.
constexpr double kLargestMockUp_mm = 500.0;
/// A model is chosen that one projector lights as a whole.
constexpr double kLargestModel_mm = 200.0;
constexpr std::array kUsualScales{4.0, 10.0, 25.0, 50.0, 100.0, 1000.0};

double longest(const glm::dvec3& size) { return std::max({size.x, size.y, size.z}); }

glm::dvec3 size_in_numbers(const MeshFacts& facts) { return facts.bounds.high - facts.bounds.low; }

double mesh_scale(const ProductAnswers& answers) {
    return answers.mesh_is_product ? 1.0 / answers.product_scale : 1.0;
}

}  // namespace

MeshFacts facts_of(const Mesh& mesh_in_mm, const std::filesystem::path& file) {
    MeshFacts facts;
    facts.file = file;
    facts.states_metres = has_suffix_of(file, {".glb", ".gltf"});
    facts.bounds = bounds_of(mesh_in_mm);
    facts.parts = part_names(mesh_in_mm);
    facts.triangles = mesh_in_mm.triangles.size();
    return facts;
}

SuggestedAnswers suggested_answers(const MeshFacts& facts, std::optional<LengthUnit> said) {
    SuggestedAnswers suggested;
    ProductAnswers& answers = suggested.answers;
    answers.part_names = facts.parts;
    const glm::dvec3 size = size_in_numbers(facts);
    const std::string longest_side = readable_number(longest(size));
    if (facts.states_metres) {
        answers.unit = LengthUnit::m;
        suggested.unit_why = "glTF files are in metres.";
        suggested.up_why = "In glTF files y is up.";
    } else {
        answers.unit = guess_unit(longest(size)).unit;
        suggested.unit_why =
            fmt::format("The file states no unit. Its longest side is {}: most likely {}.",
                        longest_side,
                        to_string(answers.unit));
        const bool z_up = size.z < size.y;
        answers.up = z_up ? UpAxis::plus_z : UpAxis::plus_y;
        suggested.up_why = fmt::format("The file does not say. It is lower along {} than along {}.",
                                       z_up ? "z" : "y",
                                       z_up ? "y" : "z");
    }
    if (said) {
        answers.unit = *said;
        suggested.unit_why = fmt::format("It was opened as in {}.", to_string(*said));
    }
    const double size_mm = longest(size) * mm_per(answers.unit);
    if (size_mm < kLargestMockUp_mm) {
        answers.mesh_is_product = false;
        suggested.scale_why = "It is as small as what stands on a bench.";
    } else {
        const auto fits = [&](double scale) { return size_mm / scale < kLargestModel_mm; };
        const auto* usual = std::find_if(kUsualScales.begin(), kUsualScales.end(), fits);
        answers.product_scale = usual == kUsualScales.end() ? kUsualScales.back() : *usual;
        suggested.scale_why = "It is too large for a bench, so a smaller model stands for it.";
    }
    return suggested;
}

void turn(ProductAnswers& answers) {
    answers.quarter_turns = (answers.quarter_turns + 1) % 4;
    // Counter-clockwise seen from above, as upright_rotation() turns.
    constexpr std::array kAround{"+x", "-z", "-x", "+z"};
    const auto* from = std::find(kAround.begin(), kAround.end(), answers.front);
    if (from == kAround.end()) return;
    answers.front = kAround[static_cast<std::size_t>(from - kAround.begin() + 1) % kAround.size()];
}

void set_up(ProductAnswers& answers, UpAxis up) {
    if (answers.up != up) answers.front.clear();
    answers.up = up;
}

glm::dvec3 mock_up_size_mm(const MeshFacts& facts, const ProductAnswers& answers) {
    const glm::dvec3 turned = upright_rotation(answers.up, answers.quarter_turns) *
                              (size_in_numbers(facts) * mm_per(answers.unit));
    return glm::abs(turned) * mesh_scale(answers);
}

glm::dvec3 product_size_mm(const MeshFacts& facts, const ProductAnswers& answers) {
    return mock_up_size_mm(facts, answers) * answers.product_scale;
}

std::string size_text(const glm::dvec3& size_mm) {
    const auto side = [](double mm) {
        return mm < 10.0 ? fmt::format("{:.2g}", mm) : readable_number(std::round(mm));
    };
    return fmt::format("{} x {} x {} mm", side(size_mm.x), side(size_mm.y), side(size_mm.z));
}

std::string scale_text(double product_scale) {
    if (product_scale == 1.0) return "real size";
    if (product_scale < 1.0) return readable_number(1.0 / product_scale) + ":1 model";
    return "1:" + readable_number(product_scale) + " model";
}

std::string problem_of(const ProductAnswers& answers) {
    if (!(answers.product_scale >= kLeastScale && answers.product_scale <= kMostScale)) {
        return fmt::format("The model's scale must lie between 1:{:.0f} and {:.0f}:1.",
                           kMostScale,
                           1 / kLeastScale);
    }
    std::set<std::string> names;
    for (const std::string& name : answers.part_names) {
        if (name.find_first_not_of(' ') == std::string::npos) return "Each part needs a name.";
        if (!names.insert(name).second) {
            return "Two parts are called \"" + name + "\"; each needs a name of its own.";
        }
    }
    return "";
}

ProductFile product_file_of(const MeshFacts& facts,
                            const ProductAnswers& answers,
                            const std::string& name) {
    ProductFile product;
    product.name = name;
    product.mesh = facts.file;
    product.unit = answers.unit;
    product.mesh_scale = mesh_scale(answers);
    product.product_scale = answers.product_scale;
    product.front = answers.front;
    const double mm = mm_per(answers.unit) * product.mesh_scale;
    product.world_from_mesh = standing_pose({facts.bounds.low * mm, facts.bounds.high * mm},
                                            upright_rotation(answers.up, answers.quarter_turns));
    for (std::size_t k = 0; k < facts.parts.size() && k < answers.part_names.size(); ++k) {
        if (answers.part_names[k] == facts.parts[k]) continue;
        product.part_names[facts.parts[k]] = answers.part_names[k];
    }
    return product;
}

namespace {

/// Below it a rim is cut off that nobody sees.
constexpr double kAll = 0.995;

}  // namespace

std::vector<MeshSample> mesh_samples(const Mesh& mesh, std::size_t count) {
    std::vector<double> area_up_to;
    double area = 0.0;
    const auto corner = [&](std::uint32_t k) { return glm::dvec3(mesh.positions_mm[k]); };
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = corner(t.x);
        area += glm::length(glm::cross(corner(t.y) - a, corner(t.z) - a));
        area_up_to.push_back(area);
    }
    std::vector<MeshSample> samples;
    if (!(area > 0.0)) return samples;
    for (std::size_t k = 0; k < count; ++k) {
        const auto number = static_cast<double>(k);
        const double at = (number + 0.5) / static_cast<double>(count) * area;
        const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end(), at);
        const auto last = static_cast<std::ptrdiff_t>(area_up_to.size()) - 1;
        const auto& t =
            mesh.triangles[static_cast<std::size_t>(std::min(found - area_up_to.begin(), last))];
        // Multiples of the plastic number's powers fill the plane evenly (Roberts' R2 sequence).
        double u = std::fmod(0.5 + 0.7548776662466927 * number, 1.0),
               v = std::fmod(0.5 + 0.5698402909980532 * number, 1.0);
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const glm::dvec3 a = corner(t.x), ab = corner(t.y) - a, ac = corner(t.z) - a;
        samples.push_back({a + u * ab + v * ac, glm::normalize(glm::cross(ab, ac))});
    }
    return samples;
}

std::optional<double> lit_share(const std::vector<MeshSample>& samples,
                                const ProductFile& product,
                                const View& projector) {
    const double mm = mm_per(product.unit.value_or(LengthUnit::mm)) * product.mesh_scale;
    const Rigid3 world_from_mesh = product.world_from_mesh.value_or(Rigid3{});
    const glm::dvec3 from = centre_in_world(projector);
    double all = 0.0, lit = 0.0;
    for (const MeshSample& sample : samples) {
        const glm::dvec3 position = world_from_mesh * (mm * glm::dvec3(sample.position));
        const glm::dvec3 normal = world_from_mesh.rotation * glm::dvec3(sample.normal);
        const glm::dvec3 way = position - from;
        const double distance = glm::length(way);
        // Scans are open and turned over in places: either side counts.
        const double angle = std::abs(glm::dot(normal, way)) / (distance * distance * distance);
        if (!std::isfinite(angle)) continue;
        all += angle;
        const auto pixel = project(projector, position);
        if (pixel && pixel->x >= 0.0 && pixel->y >= 0.0 && pixel->x <= projector.width &&
            pixel->y <= projector.height) {
            lit += angle;
        }
    }
    if (!(all > 0.0)) return std::nullopt;
    return lit / all;
}

std::string lit_share_text(double share) {
    if (share >= kAll) return "The simulated bench's projector lights all of it.";
    return fmt::format(
        "The simulated bench's projector lights {:.0f}% of it. A smaller model lies "
        "in its picture as a whole.",
        std::floor(100.0 * share));
}

}  // namespace livery
