// The shaders against the same lines in double.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/models.h"
#include "core/random.h"
#include "gl/context.h"
#include "gl/draw.h"
#include "gl/program.h"
#include "gl/read_back.h"
#include "support/gl_device.h"

namespace livery {
namespace {

constexpr int kCases = 4096;

struct Cases {
    std::vector<glm::vec3> wi, wo;
};

class OnTheGpu : public ::testing::TestWithParam<ReflectanceModel> {
  protected:
    static Texture2D texture_of(const std::vector<glm::vec3>& vectors) {
        std::vector<float> texels;
        for (const glm::vec3& v : vectors) texels.insert(texels.end(), {v.x, v.y, v.z, 0.0f});
        Texture2D texture(kCases, 1, TexelFormat::rgba32f);
        texture.upload(texels);
        return texture;
    }

    HeadlessContext context_{tested_gl()};
};

void set_parameters(Program& program, f32::BsdfParameters p) {
    for (const ParameterInfo& parameter : parameter_table()) {
        const Components<float> v = parameter.in_f32(p);
        const std::string name = std::string("p.") + parameter.name;
        switch (parameter.kind) {
            case ParameterKind::colour:
                program.set(name, glm::vec3(*v[0], *v[1], *v[2]));
                break;
            case ParameterKind::number:
                program.set(name, *v[0]);
                break;
            case ParameterKind::pair:
                program.set(name + "_x", *v[0]);
                program.set(name + "_y", *v[1]);
                break;
        }
    }
}

constexpr const char* kBody = R"(
uniform sampler2D directions_in;
uniform sampler2D directions_out;
uniform BsdfParameters p;
layout(location = 0) out vec4 value;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 wi = texelFetch(directions_in, at, 0).xyz;
    vec3 wo = texelFetch(directions_out, at, 0).xyz;
    value = vec4(bsdf_eval(p, wi, wo), bsdf_pdf(p, wi, wo));
    if (wi.z < -2.0) {  // never: the rest of the interface must compile
        BsdfEnvironment e = bsdf_environment(bsdf_widen(p, 0.1), wo.z);
        value.xyz = e.diffuse + e.specular + e.coat + bsdf_sample(p, wo, wi);
    }
}
)";

TEST_P(OnTheGpu, GivesTheValuesOfDouble) {
    const ReflectanceModel model = GetParam();
    Program program =
        Program::screen_pass({"bsdf_test.frag", "#version 450 core\n" + bsdf_glsl(model) + kBody});
    Texture2D target(kCases, 1, TexelFormat::rgba32f);
    const Framebuffer framebuffer({&target});
    const ScreenPass pass;
    Random random(7);
    for (const double alpha : {1e-4, 1e-3, 0.01, 0.1, 0.3, 1.0}) {
        f64::BsdfParameters wide = plain_parameters();
        wide.diffuse = {0.7, 0.4, 0.1};
        wide.f0 = {0.6, 0.3, 0.05};
        wide.specular = {0.3, 0.2, 0.1};
        set_slopes(wide, alpha, std::min(2.0 * alpha, 1.0));
        wide.flake_f0 = {0.1, 0.3, 0.8};
        wide.flake_alpha = std::min(3.0 * alpha, 1.0);
        wide.film_nm = alpha < 0.05 ? 0.0 : 320.0;
        wide.film_eta = 2.3;
        wide.coat_alpha = alpha;
        wide.coat_transmittance = {0.9, 0.8, 0.5};
        const f32::BsdfParameters p = rounded(wide);
        const f64::BsdfParameters exact = widened(p);
        Cases cases;
        for (int k = 0; k < kCases; ++k) {
            const glm::dvec3 wo = random_direction(random);
            cases.wo.push_back(glm::vec3(wo));
            cases.wi.push_back(glm::vec3(random_partner(random, wo, alpha)));
        }
        const Texture2D in = texture_of(cases.wi);
        const Texture2D out = texture_of(cases.wo);
        in.bind(0);
        out.bind(1);
        program.use();
        program.set("directions_in", 0);
        program.set("directions_out", 1);
        set_parameters(program, p);
        pass.run(program, framebuffer);
        const ImageF values = read_floats(target);
        // A few ulp per operation, amplified by the slope of a narrow lobe as 1e-7 / alpha.
        const double tolerance = std::max(1e-4, 4e-7 / alpha);
        for (int k = 0; k < kCases; ++k) {
            const auto at = static_cast<std::size_t>(k);
            const glm::dvec3 wi(cases.wi[at]), wo(cases.wo[at]);
            const glm::dvec3 expected = evaluate(model, exact, wi, wo);
            for (int c = 0; c < 3; ++c) {
                ASSERT_NEAR(static_cast<double>(values.at(k, 0, c)),
                            expected[c],
                            tolerance * expected[c] + 1e-6)
                    << "alpha " << alpha << " case " << k << " channel " << c;
            }
            const double density = pdf(model, exact, wi, wo);
            ASSERT_NEAR(
                static_cast<double>(values.at(k, 0, 3)), density, tolerance * density + 1e-6)
                << "pdf, alpha " << alpha << " case " << k;
        }
    }
}

TEST(PreparedFields, AreAllOfThePreparedNumbers) {
    for (const ModelInfo& model : formula_models()) {
        if (!model.prepared.type) {
            EXPECT_TRUE(prepared_fields(model.model).empty()) << model.name;
            continue;
        }
        std::size_t count = 0;
        for (const PreparedField& field : prepared_fields(model.model)) count += field.count;
        EXPECT_EQ(count, model.prepared.of(rounded(plain_parameters())).numbers.size())
            << model.name;
    }
    const auto fields = prepared_fields(ReflectanceModel::clearcoat);
    EXPECT_EQ(fields.front().name, "base.f0");
    EXPECT_EQ(fields.front().count, 3u);
    EXPECT_EQ(fields.back().name, "entry.path");
}

INSTANTIATE_TEST_SUITE_P(Models, OnTheGpu, ::testing::ValuesIn(all_models()), prefix_of);

}  // namespace
}  // namespace livery
