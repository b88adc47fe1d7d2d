// Every model against values from an independent implementation (golden.py).
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"

namespace livery {
namespace {

TEST(Golden, ValuesOfAnIndependentImplementation) {
    const std::map<std::string, ReflectanceModel> models = {
        {"lambert", ReflectanceModel::lambert},
        {"ggx", ReflectanceModel::ggx},
        {"clearcoat", ReflectanceModel::clearcoat}};
    std::ifstream file(LIVERY_GOLDEN_CSV);
    ASSERT_TRUE(file) << LIVERY_GOLDEN_CSV;
    std::string line;
    std::getline(file, line);
    std::map<std::string, int> count;
    while (std::getline(file, line)) {
        std::istringstream row(line);
        std::string name, cell;
        std::getline(row, name, ',');
        std::vector<double> v;
        while (std::getline(row, cell, ',')) v.push_back(std::stod(cell));
        ASSERT_EQ(v.size(), 22u) << line;
        ASSERT_TRUE(models.contains(name)) << line;
        const auto vec = [&](std::size_t i) { return glm::dvec3(v[i], v[i + 1], v[i + 2]); };
        f64::BsdfParameters p;
        p.diffuse = vec(0);
        p.f0 = vec(3);
        p.alpha_x = v[6];
        p.alpha_y = v[7];
        p.coat_alpha = v[8];
        p.coat_f0 = v[9];
        p.coat_transmittance = vec(10);
        const glm::dvec3 value = evaluate(models.at(name), p, vec(13), vec(16));
        for (int c = 0; c < 3; ++c) {
            const double expected = v[19 + static_cast<std::size_t>(c)];
            // Double precision, amplified near the peak of the narrowest lobe (alpha 0.01) and by
            // directions that are unit to 1e-16 only.
            EXPECT_NEAR(value[c], expected, 1e-11 * expected + 1e-14) << line;
        }
        ++count[name];
    }
    for (const auto& [name, model] : models) EXPECT_GE(count[name], 50) << name;
}

}  // namespace
}  // namespace livery
