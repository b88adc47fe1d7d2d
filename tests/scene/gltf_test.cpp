#include <gtest/gtest.h>

#include "scene/product.h"
#include "support/reference_data.h"

namespace livery {
namespace {

TEST(LoadMesh, SplitsATruckByItsNodes) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const char* name : {"vehicle-truck-green.glb", "vehicle-truck-red.glb"}) {
        const Product truck = load_product(data / "meshes" / name);
        for (const char* part : {"body", "underside", "wheel-front-left", "wheel-back-right"}) {
            EXPECT_NO_THROW(part_index(truck, part)) << name;
        }
        const Bounds bounds = bounds_of(truck.mesh);
        EXPECT_NEAR(bounds.high.x - bounds.low.x, 1500.0, 1e-3);
        EXPECT_EQ(truck.notes.at(1),
                  "material \"colormap\": the picture \"Textures/colormap.png\" is missing; its "
                  "plain colour is shown");
    }
}

}  // namespace
}  // namespace livery
