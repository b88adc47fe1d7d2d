// livery fit brdf, as scripts use it.

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "appearance/bsdf.h"
#include "appearance/fit/fit_brdf.h"
#include "appearance/material.h"
#include "core/colour.h"
#include "support/run_program.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;

class Fit : public ::testing::Test {
  protected:
    /// A paint's values as somebody's measurements.
    std::string measurements(const Material& paint) const {
        const f64::BsdfParameters p = parameters_of_f64(paint);
        const FitSamples samples = fit_samples(
            [&](const glm::dvec3& wi, const glm::dvec3& wo) {
                return rec709_from_working() * evaluate(paint.model, p, wi, wo);
            },
            [](const DirectionPair&) { return true; },
            {24, 8, 8});
        std::string text = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
        const auto angles = [](const glm::dvec3& w) {
            return fmt::format("{},{}", std::acos(w.z), std::atan2(w.y, w.x));
        };
        for (std::size_t i = 0; i < samples.pairs.size(); ++i) {
            const glm::dvec3& value = samples.values_working[i];
            text += fmt::format("{},{},{},{},{}\n",
                                angles(samples.pairs[i].wi),
                                angles(samples.pairs[i].wo),
                                value.x,
                                value.y,
                                value.z);
        }
        return folder_.write("my_green.csv", text).string();
    }
    ProgramRun fit(const std::vector<std::string>& words) const {
        std::vector<std::string> all = {"fit", "brdf", "--json"};
        all.insert(all.end(), words.begin(), words.end());
        return run_program(LIVERY_PROGRAM, all);
    }
    std::string out() const { return (folder_ / "paint.json").string(); }

    TemporaryFolder folder_;
};

Material glossy_green() {
    Material green;
    green.model = ReflectanceModel::ggx;
    green.diffuse = {0.05, 0.3, 0.1};
    green.f0 = glm::dvec3(0.05);
    green.alpha = glm::dvec2(0.2);
    return green;
}

void expect_all_fields(const Json& model) {
    for (const char* field :
         {"name", "parameters", "error", "error_log", "error_de00", "error_de00_p95", "seconds"}) {
        EXPECT_TRUE(model.contains(field)) << field;
    }
}

TEST_F(Fit, NightlyWritesThePaintThatItFound) {
    const std::string csv = measurements(glossy_green());
    const ProgramRun run = fit({"--measured", csv, "--out", out()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json answer = Json::parse(run.out);
    const Json& models = answer["models"];
    ASSERT_GT(models.size(), 2u);
    for (std::size_t k = 0; k < models.size(); ++k) {
        expect_all_fields(models[k]);
        const Json& before = models[k > 0 ? k - 1 : 0];
        EXPECT_LE(before["error"], models[k]["error"]);
    }
    EXPECT_TRUE(answer["error_is"].is_string());
    const Material paint = read_material_file(out());
    EXPECT_EQ(paint.name, "my green");
    EXPECT_NE(paint.provenance.find("my_green.csv"), std::string::npos) << paint.provenance;
}

TEST_F(Fit, WritesOneModelUnderAName) {
    const std::string csv = measurements(glossy_green());
    const ProgramRun one =
        fit({"--measured", csv, "--model", "ggx", "--name", "leaf", "--out", out()});
    ASSERT_EQ(one.exit_code, 0) << one.err;
    const Json answer = Json::parse(one.out);
    EXPECT_TRUE(answer["error_is"].is_string());
    ASSERT_EQ(answer["models"].size(), 1u);
    expect_all_fields(answer["models"][0]);
    const Material leaf = read_material_file(out());
    EXPECT_NE(leaf.provenance.find("my_green.csv"), std::string::npos) << leaf.provenance;
    EXPECT_EQ(leaf.name, "leaf");
    EXPECT_EQ(leaf.model, ReflectanceModel::ggx);
    // The file's samples are interpolated between: not as exact as the model's own.
    EXPECT_NEAR(leaf.alpha.x, 0.2, 0.02);
    EXPECT_NEAR(leaf.diffuse.y, 0.3, 0.02);
}

TEST_F(Fit, SaysWhatIsWrong) {
    const ProgramRun missing = fit({"--measured", "no.csv", "--out", out()});
    EXPECT_EQ(missing.exit_code, 2);
    EXPECT_NE(missing.err.find("no.csv"), std::string::npos) << missing.err;
    const ProgramRun model = fit({"--measured", "no.csv", "--model", "plastic", "--out", out()});
    EXPECT_EQ(model.exit_code, 2);
    EXPECT_NE(model.err.find("plastic"), std::string::npos) << model.err;
    const std::string few =
        folder_.write("few.csv", "theta_i,phi_i,theta_o,phi_o,r,g,b\n0,0,0,0,1,1,1\n").string();
    const ProgramRun sparse = fit({"--measured", few, "--out", out()});
    EXPECT_EQ(sparse.exit_code, 2);
    EXPECT_NE(sparse.err.find("few.csv"), std::string::npos) << sparse.err;
    EXPECT_FALSE(std::filesystem::exists(out()));
}

}  // namespace
}  // namespace livery
