// Material files that name a measurement.
#include <filesystem>

#include <gtest/gtest.h>

#include "appearance/material_library.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/paint_bsdf.h"
#include "appearance/parameter_table.h"
#include "core/paths.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

class MeasuredMaterial : public ::testing::Test {
  protected:
    std::filesystem::path measurement(const std::string& name, const std::string& rgb) const {
        std::string text = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
        for (int k = 0; k < 12; ++k) {
            text +=
                std::to_string(0.1 * k) + ",0,0.4," + std::to_string(0.5 * k) + "," + rgb + "\n";
        }
        return folder_.write(name, text);
    }
    std::filesystem::path material(const std::string& parameters) const {
        return folder_.write("paint.json",
                             R"({"format_version": 1, "name": "probe", "family": "solid",
                                 "model": "measured", "parameters": )" +
                                 parameters + R"(, "provenance": "a test"})");
    }
    static double grey(const Material& paint) {
        const glm::vec3 n(0.0f, 0.0f, 1.0f);
        return static_cast<double>(evaluate(bsdf_of(paint), n, n).y);
    }

    const TemporaryFolder folder_;
};

TEST_F(MeasuredMaterial, IsReadFromBesideItAndWrittenForAnywhere) {
    measurement("probe.csv", "0.2,0.2,0.2");
    const Material paint = read_material_file(material(R"({"file": "probe.csv"})"));
    EXPECT_EQ(paint.model, ReflectanceModel::measured);
    EXPECT_NEAR(grey(paint), 0.2, 1e-5);
    const TemporaryFolder elsewhere;
    write_material_file(elsewhere / "copy.json", paint);
    const Material copy = read_material_file(elsewhere / "copy.json");
    EXPECT_EQ(copy.provenance, "a test");
    EXPECT_TRUE(same_reflectance(copy, paint));
}

TEST_F(MeasuredMaterial, LeavesItsMeasurementBehindForAFormula) {
    const Material paint = find_material(measurement("probe.csv", "0.2,0.2,0.2").string());
    Material formula = paint;
    formula.model = ReflectanceModel::lambert;
    EXPECT_TRUE(same_reflectance(formula, Material{}));
    EXPECT_FALSE(same_reflectance(formula, paint));
    EXPECT_NE(grey(formula), grey(paint));
}

TEST_F(MeasuredMaterial, MayBeTheMeasurementAlone) {
    const auto file = measurement("my panel.csv", "0.1,0.1,0.1");
    const Material paint = find_material(file.string());
    EXPECT_EQ(paint.name, "my panel");
    EXPECT_NEAR(grey(paint), 0.1, 1e-5);
}

TEST_F(MeasuredMaterial, IsReadAnewWhenItsFileChanges) {
    const auto file = measurement("probe.csv", "0.2,0.2,0.2");
    const Material before = find_material(file.string());
    measurement("probe.csv", "0.30,0.30,0.30");
    const Material after = find_material(file.string());
    EXPECT_NEAR(grey(before), 0.2, 1e-5);
    EXPECT_NEAR(grey(after), 0.3, 1e-5);
    EXPECT_FALSE(same_reflectance(before, after));
}

TEST_F(MeasuredMaterial, RefusesWhatIsNoMeasurement) {
    const auto refuses = [&](const std::string& parameters, auto... parts) {
        const auto file = material(parameters);
        EXPECT_TRUE(fails_with([&] { read_material_file(file); }, {parts...})) << parameters;
    };
    refuses("{}", "paint.json", "parameters.file");
    refuses("[]", "paint.json", "parameters", "an object");
    refuses(R"({"file": ""})", "paint.json", "parameters.file", "empty text");
    refuses(R"({"file": 3})", "paint.json", "parameters.file");
    refuses(R"({"file": "none.binary"})", "none.binary", "no such file");
    refuses(R"({"file": "paint.json"})", "paint.json", ".binary, .brdf or .csv");
    measurement("probe.csv", "0.2,nan,0.2");
    refuses(R"({"file": "probe.csv"})", "probe.csv", "line 2, g", "'nan'");
    measurement("probe.csv", "0.2,0.2,0.2");
    refuses(R"({"file": "probe.csv", "alpha": 0.2})", "paint.json", "alpha");
    Material nothing;
    nothing.model = ReflectanceModel::measured;
    EXPECT_THROW(bsdf_of(nothing), std::invalid_argument);
    EXPECT_THROW(write_material_file(folder_ / "no.json", nothing), std::invalid_argument);
}

TEST_F(MeasuredMaterial, BlankIsBlack) {
    Material paint;
    paint.model = ReflectanceModel::measured;
    paint.measured = blank_measured_paint();
    EXPECT_LT(grey(paint), 1e-9);
    EXPECT_EQ(blank_measured_paint()->id.size(), 32u);
}

}  // namespace
}  // namespace livery
