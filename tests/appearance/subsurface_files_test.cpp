// Files of profiles and of translucent materials: what they hold, and what is wrong with them.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/material_library.h"
#include "appearance/subsurface/radial_profile.h"
#include "appearance/subsurface/translucent_material.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/text/csv.h"
#include "support/reference_data.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

template <typename Work, typename... Parts>
void expect_error(const Work& work, const Parts&... parts) {
    try {
        work();
        ADD_FAILURE() << "nothing was thrown";
    } catch (const FileError& error) {
        const std::string message = error.what();
        for (const std::string& part : {std::string(parts)...}) {
            EXPECT_NE(message.find(part), std::string::npos) << message << "\nwithout " << part;
        }
    }
}

TEST(ProfileFile, IsReadInAnyOrder) {
    const auto samples = parse_profile_csv(
        "# spot 0.2 mm\nnote,rd,r_mm\nfar,-1e-6,9\nnear,0.5,0\n,0.25,1\n,0.125,2.5\n", "a.csv");
    ASSERT_EQ(samples.size(), 4u);
    EXPECT_EQ(samples[0].r_mm, 0.0);
    EXPECT_EQ(samples[0].rd, 0.5);
    EXPECT_EQ(samples[3].r_mm, 9.0);
    EXPECT_EQ(samples[3].rd, -1e-6);
}

TEST(ProfileFile, IsRefusedWithLineAndColumn) {
    const auto refuses = [](const std::string& text, auto... parts) {
        expect_error([&] { parse_profile_csv(text, "a.csv"); }, "a.csv", parts...);
    };
    const std::string rows = "1,0.5\n2,0.25\n3,0.1\n4,0.05\n";
    refuses("", "nothing");
    refuses("r_mm,value\n" + rows, "header", "'rd'");
    refuses("radius,rd\n" + rows, "header", "'r_mm'");
    refuses("r_mm,rd\n1,0.5\n2,0.25\n3,0.1\n", "rows", "3", "4 or more");
    refuses("r_mm,rd\n" + rows + "-5,0.01\n", "line 6", "r_mm", "'-5'");
    refuses("r_mm,rd\n" + rows + "5,nan\n", "line 6", "rd", "'nan'");
    refuses("r_mm,rd\n" + rows + "5,inf\n", "line 6", "rd", "'inf'");
    refuses("r_mm,rd\n" + rows + "5\n", "line 6", "1 cell");
    refuses("r_mm,rd\n" + rows + "5,1e20\n", "line 6", "rd", "1e15");
    refuses("r_mm,rd\n" + rows + "3,0.2\n", "r_mm", "3 more than once");
    refuses("r_mm,rd\n1,0\n2,0\n3,-1\n4,0\n", "rd", "nothing above 0");
    std::string many = "r_mm,rd\n";
    for (int k = 0; k < 5002; ++k) many += std::to_string(k) + ",1\n";
    refuses(many, "a further row", "5000");
}

TEST(TranslucentMaterial, IsWrittenAndRead) {
    const TemporaryFolder folder;
    TranslucentMaterial material;
    material.name = "frosted";
    material.sigma_a_per_mm = {0.001, 0.002, 0.003};
    material.sigma_s_prime_per_mm = glm::dvec3(1.5);
    material.g = 0.8;
    material.eta = 1.49;
    material.thickness_mm = 3.0;
    material.provenance = "measured";
    const auto file = folder / "frosted.json";
    write_translucent_material(file, material);
    const TranslucentMaterial back = read_translucent_material(file);
    EXPECT_EQ(back.name, "frosted");
    EXPECT_EQ(back.sigma_a_per_mm, material.sigma_a_per_mm);
    EXPECT_EQ(back.sigma_s_prime_per_mm, material.sigma_s_prime_per_mm);
    EXPECT_EQ(back.thickness_mm, 3.0);
    EXPECT_EQ(back.provenance, "measured");
    const ScatteringMedium blue = medium_of(back, 2);
    EXPECT_EQ(blue.sigma_a_per_mm, 0.003);
    EXPECT_NEAR(blue.sigma_s_prime(), 1.5, 1e-12);
    EXPECT_NEAR(blue.sigma_s_per_mm, 7.5, 1e-9);
    EXPECT_THROW(medium_of(back, 3), std::invalid_argument);
    material.eta = 9.0;
    EXPECT_THROW(write_translucent_material(file, material), std::invalid_argument);
}

TEST(TranslucentMaterial, IsRefusedByField) {
    const auto refuses = [](const std::string& text, auto... parts) {
        expect_error([&] { parse_translucent_material(text, "a.json"); }, "a.json", parts...);
    };
    const auto with = [](const std::string& members) {
        return R"({"format_version": 1, "kind": "translucent", "name": "a", )" + members + "}";
    };
    const std::string good =
        R"("sigma_a_per_mm": 0.1, "sigma_s_prime_per_mm": [1, 2, 3], "eta": 1.5)";
    EXPECT_EQ(parse_translucent_material(with(good), "a.json").sigma_s_prime_per_mm.z, 3.0);
    refuses("{}", "format_version");
    refuses(R"({"format_version": 9})", "format_version", "9");
    refuses(R"({"format_version": 1, "kind": "room"})", "kind", "'room'", "'translucent'");
    refuses(with(good + R"(, "colour": 1)"), "colour");
    refuses(with(good + R"(, "g": 1)"), "g", "1");
    refuses(with(good + R"(, "thickness_mm": 0)"), "thickness_mm");
    refuses(with(R"("sigma_a_per_mm": -1, "sigma_s_prime_per_mm": 1, "eta": 1.5)"),
            "sigma_a_per_mm",
            "-1");
    refuses(with(R"("sigma_a_per_mm": 1, "sigma_s_prime_per_mm": [1, 2], "eta": 1.5)"),
            "sigma_s_prime_per_mm");
    refuses(with(R"("sigma_a_per_mm": 1, "sigma_s_prime_per_mm": 1, "eta": 9)"), "eta", "9");
    refuses(with(R"("sigma_a_per_mm": 1, "sigma_s_prime_per_mm": 9e5, "eta": 1.5, "g": 0.9)"),
            "sigma_s_prime_per_mm",
            "1 - g");
    expect_error([] { read_translucent_material("kryptonite"); }, "kryptonite", "marble");
}

TEST(TranslucentMaterial, EveryShippedOneIsReadAndSaysItsSource) {
    const auto names = shipped_names("materials/translucent");
    EXPECT_GE(names.size(), 12u);
    for (const std::string& name : names) {
        const TranslucentMaterial material = read_translucent_material(name);
        EXPECT_FALSE(material.provenance.empty()) << name;
        for (int channel = 0; channel < 3; ++channel) check_medium(medium_of(material, channel));
    }
    const ScatteringMedium milk = medium_of(read_translucent_material("skim milk"), 1);
    EXPECT_EQ(milk.sigma_s_prime(), 1.22);
    EXPECT_EQ(milk.sigma_a_per_mm, 0.0025);
    EXPECT_EQ(milk.eta, 1.3);
}

/// Jensen's and Narasimhan's media are shipped as they were published, every one.
TEST(TranslucentMaterial, ShippedOnesAreThePublishedOnes) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    std::vector<TranslucentMaterial> shipped;
    for (const std::string& name : shipped_names("materials/translucent")) {
        shipped.push_back(read_translucent_material(name));
    }
    const auto file = data / "scattering" / "measured_media_rgb_mm.csv";
    const std::string text = read_text_file(file);
    CsvReader csv(text, file);
    std::size_t rows = 0;
    for (; csv.next(); ++rows) {
        const glm::dvec3 scattering(csv.number(2), csv.number(3), csv.number(4));
        const glm::dvec3 absorption(csv.number(5), csv.number(6), csv.number(7));
        EXPECT_TRUE(std::any_of(shipped.begin(), shipped.end(), [&](const auto& one) {
            return one.sigma_s_prime_per_mm == scattering && one.sigma_a_per_mm == absorption;
        })) << csv.text(0);
    }
    EXPECT_EQ(rows, 47u);
}

TEST(TranslucentMaterial, ItsSurfaceIsReadWornAndWritten) {
    const TemporaryFolder folder;
    TranslucentMaterial ground = read_translucent_material("frosted glass");
    EXPECT_EQ(ground.alpha, 0.25);
    EXPECT_EQ(find_material("frosted glass").alpha, glm::dvec2(0.25));
    EXPECT_EQ(find_material("marble").alpha, glm::dvec2(kSmoothAlpha));
    ground.alpha = 0.4;
    write_translucent_material(folder / "ground.json", ground);
    EXPECT_EQ(read_translucent_material(folder / "ground.json").alpha, 0.4);
    write_text_file(folder / "bad.json",
                    R"({"format_version": 1, "kind": "translucent", "name": "x", "eta": 1.5,
                        "sigma_a_per_mm": 1, "sigma_s_prime_per_mm": 1, "alpha": 2})");
    expect_error([&] { read_translucent_material(folder / "bad.json"); }, "alpha", "2");
}

}  // namespace
}  // namespace livery
