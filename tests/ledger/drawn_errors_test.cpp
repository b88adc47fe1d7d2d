// What shades a frame against the same lines in double.
#include "ledger/drawn_errors.h"

#include <cstdio>

#include <gtest/gtest.h>

#include "appearance/model_table.h"
#include "gl/context.h"
#include "radiance/shading.h"
#include "support/gl_device.h"

namespace livery {
namespace {

class Drawn : public ::testing::TestWithParam<ReflectanceModel> {
  protected:
    HeadlessContext context_{tested_gl()};
};

TEST_P(Drawn, FollowsDouble) {
    const std::vector<DrawnError> rows = drawn_errors(GetParam(), true, 5);
    EXPECT_GE(rows.size(), drawn_lights(GetParam()).size());
    for (const DrawnError& row : rows) {
        std::printf("    %-24s %-20s alpha %-8.4g lanes %.1e OpenGL %.1e of %.1e\n",
                    row.paint.c_str(),
                    to_string(row.light).c_str(),
                    row.alpha,
                    row.in_lanes,
                    row.in_gl,
                    row.allowed);
        EXPECT_LE(row.in_lanes, row.allowed) << to_string(row.light) << ", alpha " << row.alpha;
        EXPECT_LE(row.in_gl, row.allowed) << to_string(row.light) << ", alpha " << row.alpha;
        EXPECT_EQ(row.invalid, 0u) << to_string(row.light) << ", alpha " << row.alpha;
        EXPECT_GT(row.values, 3000u);
    }
}

std::vector<ReflectanceModel> every_model() {
    std::vector<ReflectanceModel> models;
    for (const ModelInfo& info : formula_models()) models.push_back(info.model);
    models.push_back(ReflectanceModel::measured);
    return models;
}

std::string name_of_model(const ::testing::TestParamInfo<ReflectanceModel>& parameter) {
    std::string name = model_info(parameter.param).name;
    for (char& c : name) c = c == '-' ? '_' : c;
    return name;
}

INSTANTIATE_TEST_SUITE_P(Models, Drawn, ::testing::ValuesIn(every_model()), name_of_model);

}  // namespace
}  // namespace livery
