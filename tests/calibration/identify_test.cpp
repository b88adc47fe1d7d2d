#include "calibration/captures/identify.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "calibration/correspondence/patterns.h"
#include "calibration/support/synthetic_bench.h"

namespace livery {
namespace {

using testing::SyntheticBench;

/// A session of photographs in the order in which they were taken, as a camera names them.
struct Shoot {
    std::vector<std::string> roles;
    std::vector<Glimpse> photographs;
};

/// `lit`: the share of the projector's width that the mock-up takes, in its middle.
Shoot shoot(double lit = 1.0, std::uint64_t seed = 1) {
    SyntheticBench bench;
    bench.projector_width = 240;
    bench.projector_height = 150;
    bench.camera_width = 300;
    bench.camera_height = 200;
    bench.read_noise = 20.0;
    bench.random = Random(seed);
    bench.leak = 0.002;
    bench.ambient = glm::dvec3(0.01);
    bench.scale = [lit](glm::dvec2 at) {
        const double x = at.x / 240.0 - 0.5;
        return std::abs(x) < 0.5 * lit ? 0.5 + 0.5 * std::sin(0.02 * at.y) * std::sin(0.03 * at.x)
                                       : 0.0;
    };
    Shoot result;
    std::vector<Pattern> patterns = geometry_patterns(240, 150);
    for (Pattern& pattern : colour_patterns(240, 150, 0, 255)) patterns.push_back(pattern);
    for (const Pattern& pattern : patterns) {
        Photograph photograph = bench.photograph(pattern.drive);
        photograph.name = fmt::format("IMG_{:04}.CR2", 118 + result.roles.size());
        result.photographs.push_back(glimpse_of(photograph));
        result.roles.push_back(pattern.role);
    }
    return result;
}

/// Places of roles that have another photograph than by that name, or none.
std::vector<std::string> wrong_roles(const IdentifiedPhotographs& found,
                                     const std::vector<Glimpse>& photographs,
                                     const Shoot& truth) {
    std::vector<std::string> wrong;
    for (std::size_t r = 0; r < truth.roles.size(); ++r) {
        const auto& place = found.photograph_of_role[r];
        if (!place || photographs[*place].name != truth.photographs[r].name)
            wrong.push_back(truth.roles[r]);
    }
    return wrong;
}

TEST(Identify, FindsEachInAWholeSession) {
    for (const double lit : {1.0, 0.4, 0.15}) {
        const Shoot truth = shoot(lit);
        const auto found = identify(truth.photographs, truth.roles);
        EXPECT_TRUE(found.complete()) << lit;
        EXPECT_TRUE(found.odd.empty()) << lit;
        EXPECT_TRUE(wrong_roles(found, truth.photographs, truth).empty()) << lit;
    }
}

TEST(Identify, NamesTheOneThatIsMissing) {
    for (const double lit : {1.0, 0.15}) {
        const Shoot truth = shoot(lit);
        for (std::size_t gone = 0; gone < truth.roles.size(); ++gone) {
            auto photographs = truth.photographs;
            photographs.erase(photographs.begin() + static_cast<std::ptrdiff_t>(gone));
            const auto found = identify(photographs, truth.roles);
            EXPECT_EQ(wrong_roles(found, photographs, truth),
                      std::vector<std::string>{truth.roles[gone]})
                << lit;
            EXPECT_TRUE(found.odd.empty());
        }
    }
}

TEST(Identify, NamesTheOneThatWasTakenTwice) {
    const Shoot truth = shoot(), again = shoot(1.0, 2);
    for (std::size_t twice = 0; twice < truth.roles.size(); ++twice) {
        // The camera counted on, so that all names after it are one later.
        auto photographs = truth.photographs;
        photographs.insert(photographs.begin() + static_cast<std::ptrdiff_t>(twice + 1),
                           again.photographs[twice]);
        for (std::size_t k = 0; k < photographs.size(); ++k)
            photographs[k].name = fmt::format("IMG_{:04}.CR2", 7 + k);
        const auto found = identify(photographs, truth.roles);
        EXPECT_TRUE(found.complete()) << truth.roles[twice];
        ASSERT_EQ(found.odd.size(), 1u) << truth.roles[twice];
        // Dark gray comes after black and shows the same.
        const std::size_t last = twice + (truth.roles[twice] == "black" ? 2 : 1);
        EXPECT_TRUE(found.odd[0].photograph >= twice && found.odd[0].photograph <= last)
            << truth.roles[twice] << " " << found.odd[0].photograph;
        EXPECT_NE(found.odd[0].why.find("shows the same as IMG_"), std::string::npos);
    }
}

TEST(Identify, ToldByNameOneTwiceAndOneMissing) {
    const Shoot truth = shoot(), again = shoot(1.0, 2);
    Random random(5);
    for (int round = 0; round < 20; ++round) {
        const auto count = static_cast<double>(truth.roles.size());
        const auto gone = static_cast<std::size_t>(random.uniform() * count);
        const auto twice = static_cast<std::size_t>(random.uniform() * count);
        if (gone == twice) continue;
        auto photographs = truth.photographs;
        Glimpse copy = again.photographs[twice];
        copy.name.insert(8, " (copy)");
        photographs.push_back(copy);
        photographs.erase(photographs.begin() + static_cast<std::ptrdiff_t>(gone));
        std::sort(photographs.begin(), photographs.end(), [](const auto& a, const auto& b) {
            return comes_before(a.name, b.name);
        });
        const auto found = identify(photographs, truth.roles);
        EXPECT_EQ(found.odd.size(), 1u) << truth.roles[twice] << ", without " << truth.roles[gone];
        std::vector<std::string> missing;
        for (std::size_t r = 0; r < truth.roles.size(); ++r)
            if (!found.photograph_of_role[r]) missing.push_back(truth.roles[r]);
        EXPECT_EQ(missing, std::vector<std::string>{truth.roles[gone]}) << truth.roles[twice];
    }
}

TEST(Identify, PassesOverWhatShowsSomethingElse) {
    const Shoot truth = shoot();
    auto photographs = truth.photographs;
    Glimpse cat = photographs.front();
    cat.name = "IMG_0130.CR2";
    Random random(3);
    for (float& value : cat.values) value = static_cast<float>(12000.0 * random.uniform());
    photographs[12] = cat;  // in place of one
    const auto found = identify(photographs, truth.roles);
    EXPECT_EQ(wrong_roles(found, photographs, truth), std::vector<std::string>{truth.roles[12]});
    ASSERT_EQ(found.odd.size(), 1u);
    EXPECT_EQ(found.odd[0].photograph, 12u);
    EXPECT_EQ(found.odd[0].why, "shows none of the pictures that are wanted");
}

// White and black before all stripes, or what was forgotten photographed at the end.
TEST(Identify, FindsWhatWasTakenOutOfOrder) {
    const Shoot truth = shoot();
    const auto moved = [&](const std::vector<std::string>& late, bool to_the_front) {
        std::vector<Glimpse> first, rest;
        for (std::size_t r = 0; r < truth.roles.size(); ++r) {
            const bool is_late = std::find(late.begin(), late.end(), truth.roles[r]) != late.end();
            (is_late == to_the_front ? first : rest).push_back(truth.photographs[r]);
        }
        first.insert(first.end(), rest.begin(), rest.end());
        const auto found = identify(first, truth.roles);
        EXPECT_TRUE(found.complete()) << late.front();
        EXPECT_TRUE(wrong_roles(found, first, truth).empty()) << late.front();
        EXPECT_EQ(found.out_of_order.size(), late.size()) << late.front();
    };
    moved({"white", "black"}, true);
    moved({"gray-column-3"}, false);
    moved({"gray-row-2-inverse"}, false);
    moved({"gray-column-4", "gray-column-4-inverse"}, false);
    moved({"red"}, false);
}

// One of a pair was forgotten, and numbers do not tell which: both are photographed again.
TEST(Identify, TakesAPairAgainOfWhichOneWasForgotten) {
    const Shoot truth = shoot(), again = shoot(1.0, 2);
    for (const std::string forgotten : {"gray-row-1", "gray-row-1-inverse"}) {
        std::vector<Glimpse> photographs;
        for (std::size_t r = 0; r < truth.roles.size(); ++r)
            if (truth.roles[r] != forgotten) photographs.push_back(truth.photographs[r]);
        std::vector<std::string> late;
        for (std::size_t r = 0; r < truth.roles.size(); ++r) {
            if (!truth.roles[r].starts_with("gray-row-1")) continue;
            photographs.push_back(again.photographs[r]);
            late.push_back(truth.roles[r]);
        }
        for (std::size_t k = 0; k < photographs.size(); ++k)
            photographs[k].name = fmt::format("IMG_{:04}.CR2", 7 + k);
        const auto found = identify(photographs, truth.roles);
        ASSERT_TRUE(found.complete()) << forgotten;
        for (std::size_t r = 0; r < truth.roles.size(); ++r)
            for (std::size_t k = 0; k < late.size(); ++k)
                if (truth.roles[r] == late[k]) {
                    EXPECT_EQ(*found.photograph_of_role[r], truth.roles.size() - 1 + k)
                        << forgotten;
                }
        EXPECT_EQ(found.odd.size(), 1u);
    }
}

TEST(Identify, TakesAFewAndNone) {
    const Shoot truth = shoot();
    EXPECT_FALSE(identify({}, truth.roles).complete());
    EXPECT_EQ(identify({}, truth.roles).photograph_of_role.size(), truth.roles.size());
    const auto found = identify({truth.photographs[0], truth.photographs[1]}, truth.roles);
    EXPECT_FALSE(found.complete());
    Glimpse small = truth.photographs[2];
    small.values.resize(30);
    EXPECT_THROW(identify({truth.photographs[0], small}, truth.roles), std::invalid_argument);
}

TEST(Identify, OrdersNamesByTheirNumbers) {
    EXPECT_TRUE(comes_before("IMG_9.CR2", "IMG_10.CR2"));
    EXPECT_TRUE(comes_before("IMG_0099.CR2", "IMG_0100.CR2"));
    EXPECT_FALSE(comes_before("IMG_0100.CR2", "IMG_0099.CR2"));
    EXPECT_FALSE(comes_before("a", "a"));
    EXPECT_TRUE(comes_before("a", "a1"));
    EXPECT_TRUE(comes_before("IMG_0012.CR2", "IMG_0013.CR2"));
    EXPECT_TRUE(comes_before("12345678901234567890a", "12345678901234567891a"));
    // A camera counts from 0001 again after 9999
    EXPECT_EQ(order_of_names({"IMG_0001.CR2", "IMG_0002.CR2", "IMG_9998.CR2", "IMG_9999.CR2"}),
              (std::vector<std::size_t>{2, 3, 0, 1}));
    EXPECT_EQ(order_of_names({"IMG_9997.CR2", "IMG_9999.CR2", "IMG_9998.CR2"}),
              (std::vector<std::size_t>{0, 2, 1}));
    EXPECT_EQ(order_of_names({"b", "a"}), (std::vector<std::size_t>{1, 0}));
}

}  // namespace
}  // namespace livery
