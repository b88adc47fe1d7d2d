// The tables of docs/materials.md about measured reflectance: what resampling costs at which size.
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/material_library.h"
#include "appearance/measured/measured_grid.h"
#include "appearance/merl_bytes.h"
#include "core/colour.h"
#include "support/reference_data.h"

namespace livery {
namespace {

/// Prints a row a size. What the size that is drawn with loses is hardly visible (CIEDE2000 below 1
/// for 95% of the directions), and a finer grid loses less.
void expect_enough_nodes(const char* name, const MeasuredReflectance& measured) {
    double coarser = std::numeric_limits<double>::infinity();
    for (const MeasuredGridSize size : {MeasuredGridSize{32, 16, 16},
                                        MeasuredGridSize{64, 32, 32},
                                        MeasuredGridSize{96, 48, 48}}) {
        const MeasuredGrid grid = resampled(measured, size);
        const ReflectanceDifference d = resampling_error(grid, measured);
        std::printf("%-16s %3d x %2d x %2d  %6.2f MB  relative %.4f %.4f  CIEDE2000 %.3f %.3f\n",
                    name,
                    size.theta_h,
                    size.theta_d,
                    size.phi_d,
                    static_cast<double>(grid.texels.size()) * 4e-6,
                    d.relative_median,
                    d.relative_p95,
                    d.de00_mean,
                    d.de00_p95);
        EXPECT_LT(d.de00_mean, coarser) << name;
        if (size.theta_h >= MeasuredGridSize().theta_h) {
            EXPECT_LT(d.de00_p95, 1.0) << name;
        }
        coarser = d.de00_mean;
    }
}

TEST(MeasuredStudy, NightlyPaintsOnGridsOfSeveralSizes) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const char* name : {"garnet_red", "cayman", "krylon_blue"}) {
        const auto file = data / "paint" / (std::string(name) + ".brdf");
        expect_enough_nodes(name, read_measured_file(file));
    }
    const Material metal = find_material("silver metallic");
    const auto p = parameters_of_f64(metal);
    const std::string bytes = merl_bytes([&](const glm::dvec3& wi, const glm::dvec3& wo) {
        return rec709_from_working() * evaluate(metal.model, p, wi, wo);
    });
    expect_enough_nodes("silver metallic",
                        measured_from(parse_merl(bytes, "silver.binary"), "silver.binary"));
}

}  // namespace
}  // namespace livery
