#include "appearance/material.h"

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "core/paths.h"

namespace livery {
namespace {

TEST(Library, EveryShippedPaintIsReadAndFoundByItsName) {
    const auto library = load_library(shipped_path("materials"));
    EXPECT_GE(library.size(), 12u);
    for (const Material& material : library) {
        EXPECT_EQ(find_material(material.name).file, material.file);
        EXPECT_FALSE(material.provenance.empty()) << material.name;
        EXPECT_NO_THROW(parameters_of(material)) << material.name;
    }
}

}  // namespace
}  // namespace livery
