// Every shipped product is made of closed, sound solids.
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "scene/product.h"
#include "soundness.h"

namespace livery {
namespace {

const Solids& solids_of_product(const std::string& name) {
    static std::map<std::string, Solids> known;
    const auto [place, is_new] = known.try_emplace(name);
    if (is_new) {
        place->second = solids_of(load_product(shipped_path("assets/" + name + ".json")).mesh);
    }
    return place->second;
}

class Products : public ::testing::TestWithParam<const char*> {
  protected:
    const Solids& solids() const { return solids_of_product(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Shipped,
                         Products,
                         ::testing::Values("car", "player", "sphere"),
                         [](const auto& product) { return std::string(product.param); });

TEST_P(Products, AreWatertight) {
    const auto faults = open_edges(solids());
    EXPECT_TRUE(faults.empty()) << to_text(solids(), faults);
}

TEST_P(Products, EnclosePositiveVolumes) {
    const auto faults = inside_out_shells(solids());
    EXPECT_TRUE(faults.empty()) << to_text(solids(), faults);
}

TEST_P(Products, HaveNoSlivers) {
    const auto faults = slivers(solids(), 1e-3);
    EXPECT_TRUE(faults.empty()) << to_text(solids(), faults);
}

TEST_P(Products, HaveNoInvertedFaces) {
    const auto faults = inverted_faces(solids());
    EXPECT_TRUE(faults.empty()) << to_text(solids(), faults);
}

// A shell never crosses itself. Shells of one part cross only where this says so; shells of
// different parts may enter one another out of sight, as a mirror's foot the door.
TEST_P(Products, CrossOnlyWhereTheyAreJoined) {
    const std::set<std::string> joined{"rims"};  // spokes run into the hub and the barrel
    std::vector<Fault> faults;
    for (const auto& fault : crossings(solids())) {
        const auto& part = solids().part_names[static_cast<std::size_t>(fault.part_a)];
        const bool one_part = fault.part_a == fault.part_b;
        if (fault.one_shell || (one_part && !joined.contains(part))) faults.push_back(fault);
    }
    EXPECT_TRUE(faults.empty()) << to_text(solids(), faults);
}

TEST_P(Products, ShowOnePartAtAPlace) {
    const auto faults = coincident_faces(solids(), 0.003);
    EXPECT_TRUE(faults.empty()) << to_text(solids(), faults);
}

}  // namespace
}  // namespace livery
