// Every model against values from an independent implementation (golden.py).
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/model_table.h"

namespace livery {
namespace {

/// Columns of a parameter's numbers.
std::vector<std::string> columns_of(const ParameterInfo& parameter) {
    const std::string name = parameter.name;
    if (parameter.kind == ParameterKind::number) return {name};
    if (parameter.kind == ParameterKind::pair) return {name + "_x", name + "_y"};
    return {name + "_r", name + "_g", name + "_b"};
}

std::vector<std::string> cells_of(const std::string& line) {
    std::istringstream row(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    return cells;
}

TEST(Golden, ValuesOfAnIndependentImplementation) {
    std::ifstream file(LIVERY_GOLDEN_CSV);
    ASSERT_TRUE(file) << LIVERY_GOLDEN_CSV;
    std::string line;
    std::getline(file, line);
    const std::vector<std::string> names = cells_of(line);
    std::map<std::string, int> count;
    while (std::getline(file, line)) {
        const std::vector<std::string> cells = cells_of(line);
        ASSERT_EQ(cells.size(), names.size()) << line;
        std::map<std::string, double> at;
        for (std::size_t k = 1; k < cells.size(); ++k) at[names[k]] = std::stod(cells[k]);
        const ModelInfo* model = find_model(cells[0]);
        ASSERT_TRUE(model) << line;
        f64::BsdfParameters p{};
        for (const ParameterInfo& parameter : parameter_table()) {
            // Single flakes are a pixel's: the reflectance does not know of them.
            if (std::string(parameter.name).starts_with("glint_")) continue;
            const std::vector<std::string> columns = columns_of(parameter);
            for (std::size_t k = 0; k < columns.size(); ++k) {
                *parameter.in_f64(p)[k] = at.at(columns[k]);
            }
        }
        const glm::dvec3 wi(at["wi_x"], at["wi_y"], at["wi_z"]);
        const glm::dvec3 wo(at["wo_x"], at["wo_y"], at["wo_z"]);
        const glm::dvec3 value = evaluate(model->model, p, wi, wo);
        for (int c = 0; c < 3; ++c) {
            const double expected = at[std::string(1, "rgb"[c])];
            // Double precision, amplified near the peak of the narrowest lobe (alpha 0.01) and by
            // directions that are unit to 1e-16 only.
            const double exponent = std::max(p.exponent_x, p.exponent_y);
            const double tolerance = 1e-11 + 4e-16 * exponent;
            EXPECT_NEAR(value[c], expected, tolerance * expected + 1e-14) << line;
        }
        ++count[cells[0]];
    }
    for (const ModelInfo& model : formula_models()) EXPECT_GE(count[model.name], 50) << model.name;
}

}  // namespace
}  // namespace livery
