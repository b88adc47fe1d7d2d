// The levels for a budget: of all that fit, the least error, at the least cost.
#include "ledger/budget.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/paths.h"
#include "support/file_error.h"
#include "support/message_of.h"
#include "support/small_meshes.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// A matt box under a lamp and a grey sky: shadows, environment, occlusion, light between its
/// sides.
Scene matt_box() {
    Product product;
    product.mesh = open_box();
    Scene scene;
    scene.product = std::make_shared<const Product>(std::move(product));
    scene.part_materials.resize(1);
    scene.lights.push_back({{0, 1, 0}, {1, 1, 1}, 0.1});
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(8, 4, 3, 0.5f);
    environment->scale = 1.0;
    scene.environment = environment;
    return scene;
}

constexpr double kDearest = 3.0;

/// Dearer levels take twice the time of those before, and leave half of what those add.
std::vector<PassCost> doubling_costs() {
    std::vector<PassCost> costs;
    for (int kind = 0; kind <= static_cast<int>(PassKind::compensation); ++kind) {
        const PassId pass(static_cast<PassKind>(kind));
        const auto effect = effect_of(pass);
        const int levels = effect ? static_cast<int>(effect_info(*effect).levels.size()) : 1;
        for (int level = 0; level < levels; ++level) {
            costs.push_back({pass, level, 10.0 * std::pow(2.0, level), 0.0, 0.0, {}});
        }
    }
    for (const bool glints : {false, true}) {
        for (const auto model : {ReflectanceModel::lambert, ReflectanceModel::car_paint}) {
            costs.push_back({PassId(PassKind::shade, "", model, glints), 0, 5.0, 0.0, 0.0, {}});
        }
    }
    return costs;
}

EffectErrors halving_errors() {
    SceneErrors scene;
    scene.scene = "one";
    scene.dearest = kDearest;
    for (const EffectInfo& info : effect_table()) {
        const std::size_t last = info.levels.size() - 1;
        for (std::size_t k = 0; k <= last; ++k) {
            const double added = k == last ? 0.0 : 4.0 * std::pow(0.5, static_cast<double>(k));
            scene.at_level[static_cast<std::size_t>(info.effect)].push_back(
                std::sqrt(kDearest * kDearest + added * added));
        }
    }
    return {scene};
}

PriceList list_of(const Scene& scene) {
    FrameCounts areas;
    areas.covered_pixels = 1000.0;
    areas.fragments_of_part.assign(scene.part_materials.size(), 1000.0);
    return make_price_list(scene, FrameStage::radiance, areas, doubling_costs(), halving_errors());
}

void every_levels(const std::function<void(const EffectLevels&)>& visit) {
    EffectLevels levels = levels_of(Quality::normal);
    const std::function<void(std::size_t)> from = [&](std::size_t e) {
        // A matt box mirrors nothing and wears neither flakes nor relief
        if (e > static_cast<std::size_t>(Effect::interreflection)) return visit(levels);
        const Effect effect = static_cast<Effect>(e);
        if (effect == Effect::mirrored_environment || effect == Effect::reflected_occlusion) {
            levels.of[e] = 0;
            return from(e + 1);
        }
        for (std::size_t k = 0; k < effect_table()[e].levels.size(); ++k) {
            levels.of[e] = static_cast<int>(k);
            from(e + 1);
        }
    };
    from(0);
}

TEST(Budget, ChoosesWhatSearchingEverythingFinds) {
    const Scene scene = matt_box();
    const PriceList list = list_of(scene);
    struct One {
        double ms, error;
    };
    std::vector<One> all;
    every_levels([&](const EffectLevels& levels) {
        all.push_back({time_of(list, levels).all_ms, error_of(list, levels)});
    });
    ASSERT_EQ(all.size(), 3u * 4u * 2u * 4u * 3u);
    double last_error = std::numeric_limits<double>::infinity();
    int chosen = 0;
    for (const double budget_ms : {75.0, 90.0, 130.0, 200.0, 300.0, 1000.0}) {
        SCOPED_TRACE(budget_ms);
        double least = std::numeric_limits<double>::infinity();
        for (const One& one : all) {
            if (one.ms <= budget_ms) least = std::min(least, one.error);
        }
        const EffectLevels levels = levels_within(list, {budget_ms, {}});
        const double error = error_of(list, levels), ms = time_of(list, levels).all_ms;
        EXPECT_LE(ms, budget_ms);
        EXPECT_LE(error, 1.01 * least);
        EXPECT_LE(error, 1.01 * last_error) << "more time, more error";
        for (const One& one : all) {
            EXPECT_FALSE(one.ms < ms - 1e-9 && one.error <= error) << "cheaper and as good";
        }
        last_error = error;
        ++chosen;
    }
    EXPECT_EQ(chosen, 6);
    EXPECT_NEAR(last_error, kDearest, 0.01 * kDearest) << "with all the time there is";
}

TEST(Budget, ThatNothingFitsIsRefusedWithWhatTheCheapestTakes) {
    const Scene scene = matt_box();
    const PriceList list = list_of(scene);
    EXPECT_NE(message_of([&] {
                  levels_within(list, {1.0, {}});
              }).find("no levels fit the budget"),
              std::string::npos);
    EXPECT_THROW(levels_within(list, {{}, 1.0}), Refused);
    PriceList untimed = list;
    untimed.costs.clear();
    EXPECT_NE(message_of([&] {
                  levels_within(untimed, {1e6, {}});
              }).find("nobody has timed"),
              std::string::npos);
}

TEST(Budget, HoldsForPaintsAndFirstFramesApart) {
    const Scene scene = matt_box();
    const PriceList list = list_of(scene);
    const double swap_ms = time_of(list, levels_of(Quality::normal)).swap_ms;
    const EffectLevels levels = levels_within(list, {{}, swap_ms});
    EXPECT_LE(time_of(list, levels).swap_ms, swap_ms);
    EXPECT_NEAR(error_of(list, levels), kDearest, 0.01 * kDearest) << "only paints were limited";
}

TEST(Budget, NeverDropsGlintsForWhichThereIsNoTruth) {
    Scene scene = matt_box();
    scene.part_materials[0].model = ReflectanceModel::car_paint;
    scene.part_materials[0].glint_density_per_mm2 = 100.0;
    const PriceList list = list_of(scene);
    const EffectLevels levels = levels_within(list, {80.0, {}});
    EXPECT_EQ(levels[Effect::glints], 1);
}

TEST(PricedFrames, AddUpAndSayWhatTheNextLevelBuys) {
    const Scene scene = matt_box();
    const PriceList list = list_of(scene);
    EffectLevels levels = levels_of(Quality::normal);
    levels[Effect::interreflection] = 0;  // one that is left out, and bounded
    const PricedFrame frame = priced(list, levels);
    ASSERT_EQ(frame.effects.size(), kEffects);
    EXPECT_TRUE(frame.time.complete);
    double own = 0.0, added = kDearest * kDearest;
    for (const EffectPrice& price : frame.effects) {
        SCOPED_TRACE(effect_info(price.effect).name);
        own += price.own_ms;
        added += price.called_for ? price.added * price.added : 0.0;
        if (!price.called_for) {
            EXPECT_EQ(price.own_ms, 0.0);
            EXPECT_FALSE(price.next || price.off);
            continue;
        }
        if (price.next) {
            EXPECT_GT(price.next->time.all_ms, frame.time.all_ms);
            EXPECT_LE(price.next->error, frame.error);
        }
        if (price.off) {
            EXPECT_LT(price.off->time.all_ms, frame.time.all_ms);
            EXPECT_GT(price.off->error, frame.error);
        }
        EXPECT_EQ(price.bound.has_value(),
                  price.effect == Effect::interreflection && price.chosen.level == 0);
    }
    double rest = 0.0;
    FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
    predict(plan, list);
    for (const PlannedPass& pass : plan.passes) {
        if (!effect_of(pass.id)) rest += pass.predicted_ms.value_or(0.0);
    }
    EXPECT_DOUBLE_EQ(own + rest, frame.time.all_ms);
    EXPECT_NEAR(std::sqrt(added), frame.error, 1e-12);
    const std::string text = text_of(frame);
    EXPECT_NE(text.find("not called for"), std::string::npos) << text;
    EXPECT_NE(text.find("at most, by the parts' albedos"), std::string::npos) << text;
}

// Few nodes have no rays: with one of the two alone nothing would be bought.
TEST(PricedFrames, MoveTheNodesOfMirrorsAndTheirRaysTogether) {
    Scene scene = matt_box();
    scene.part_materials[0].model = ReflectanceModel::car_paint;
    const PriceList list = list_of(scene);
    EffectLevels few = levels_of(Quality::normal);
    few[Effect::mirrored_environment] = kMirrorsWithRays - 1;
    few[Effect::reflected_occlusion] = 0;
    EffectLevels many = few;
    many[Effect::mirrored_environment] = kMirrorsWithRays;
    many[Effect::reflected_occlusion] = 1;
    ASSERT_GT(time_of(list, many).all_ms, time_of(list, few).all_ms);
    const auto price = [&](const EffectLevels& levels, Effect effect) {
        return priced(list, levels).effects.at(static_cast<std::size_t>(effect));
    };
    for (const Effect effect : {Effect::mirrored_environment, Effect::reflected_occlusion}) {
        SCOPED_TRACE(effect_info(effect).name);
        const auto next = price(few, effect).next;
        ASSERT_TRUE(next);
        EXPECT_EQ(next->time.all_ms, time_of(list, many).all_ms);
        EXPECT_EQ(next->error, error_of(list, many));
    }
    const auto off = price(many, Effect::reflected_occlusion).off;
    ASSERT_TRUE(off);
    EXPECT_EQ(off->time.all_ms, time_of(list, few).all_ms);
}

// Shipped for machines where no accuracy suite has run.
/// Where mirrors have parts alone to show they lose less than where they show a sky, and nothing
/// where parts send no light.
TEST(EffectErrors, AreThoseOfScenesThatHaveAnEnvironmentAsOnesOwn) {
    EffectErrors errors = halving_errors();
    SceneErrors& lamps = errors.emplace_back(errors.front());
    lamps.scene = "lamps";
    lamps.dearest = 1.0;
    for (const Effect effect : {Effect::environment, Effect::occlusion}) {
        lamps.at_level[static_cast<std::size_t>(effect)].clear();
    }
    std::array<bool, kEffects> called_for{};
    const auto call_for = [&](Effect effect, bool called) {
        called_for[static_cast<std::size_t>(effect)] = called;
    };
    for (const Effect effect : {Effect::environment,
                                Effect::mirrored_environment,
                                Effect::reflected_occlusion,
                                Effect::interreflection}) {
        call_for(effect, true);
    }
    const EffectErrors under_a_sky = errors_like(errors, called_for);
    ASSERT_EQ(under_a_sky.size(), 1u);
    EXPECT_EQ(under_a_sky.front().scene, "one");
    call_for(Effect::environment, false);
    const EffectErrors under_lamps = errors_like(errors, called_for);
    ASSERT_EQ(under_lamps.size(), 1u);
    EXPECT_EQ(under_lamps.front().scene, "lamps");
    // Those of another kind of scene are better than none
    EXPECT_EQ(errors_like({errors.front()}, called_for).size(), 1u);

    EffectLevels levels = dearest_levels();
    levels[Effect::interreflection] = 0;
    EXPECT_FALSE(has_what_is_mirrored(levels, called_for));
    EXPECT_TRUE(has_what_is_mirrored(dearest_levels(), called_for));
    EffectLevels no_mirrors = levels;
    no_mirrors[Effect::mirrored_environment] = no_mirrors[Effect::reflected_occlusion] = 0;
    EXPECT_EQ(error_of(under_lamps, levels, called_for),
              error_of(under_lamps, no_mirrors, called_for));
    no_mirrors[Effect::interreflection] = levels[Effect::interreflection] = 1;
    EXPECT_LT(error_of(under_lamps, levels, called_for),
              error_of(under_lamps, no_mirrors, called_for));
}

TEST(EffectErrors, ThatAreShippedRankTheQualities) {
    const EffectErrors errors = known_effect_errors();
    const auto scene = std::find_if(errors.begin(), errors.end(), [](const SceneErrors& one) {
        return one.scene == "car, solid red, studio";
    });
    ASSERT_NE(scene, errors.end());
    EXPECT_GT(scene->dearest, 0.0);
    std::array<bool, kEffects> called{};
    for (std::size_t e = 0; e < kEffects; ++e) called[e] = !scene->at_level[e].empty();
    const auto of = [&](Quality quality) {
        return error_of({*scene}, levels_of(quality), called).value_or(0.0);
    };
    EXPECT_GT(of(Quality::draft), of(Quality::normal));
    EXPECT_GT(of(Quality::normal), of(Quality::high));
    EXPECT_FALSE(error_of({}, levels_of(Quality::high), called).has_value());
}

// What no scene tells of would cost nothing to leave out.
TEST(EffectErrors, ThatAreShippedTellOfEveryEffect) {
    const EffectErrors errors = known_effect_errors();
    for (const EffectInfo& info : effect_table()) {
        const int last = static_cast<int>(info.levels.size()) - 1;
        EffectLevels without = dearest_levels();
        without[info.effect] = 0;
        std::array<bool, kEffects> called{};
        called.fill(true);
        EXPECT_GT(*error_of(errors, without, called),
                  1.01 * *error_of(errors, dearest_levels(), called))
            << info.name << " " << info.levels.front().name << " beside "
            << info.levels[static_cast<std::size_t>(last)].name;
    }
}

TEST(EffectErrors, OfAnEffectWithScenesOfItsOwnComeOnTop) {
    EffectErrors errors = halving_errors();
    errors[0].at_level[static_cast<std::size_t>(Effect::subsurface)].clear();
    SceneErrors& marble = errors.emplace_back();
    marble.scene = "marble";
    marble.dearest = 3.0;
    marble.at_level[static_cast<std::size_t>(Effect::subsurface)] = {5.0, 3.5, 3.0};
    std::array<bool, kEffects> called{};
    called.fill(true);
    EffectLevels levels = dearest_levels();
    EXPECT_DOUBLE_EQ(*error_of(errors, levels, called), kDearest) << "nothing of the scene's own";
    levels[Effect::subsurface] = 0;
    EXPECT_DOUBLE_EQ(*error_of(errors, levels, called), std::sqrt(kDearest * kDearest + 16.0));
    levels[Effect::subsurface] = 1;
    EXPECT_DOUBLE_EQ(*error_of(errors, levels, called), std::sqrt(kDearest * kDearest + 3.25));
    called[static_cast<std::size_t>(Effect::subsurface)] = false;
    EXPECT_DOUBLE_EQ(*error_of(errors, levels, called), kDearest);
    EXPECT_FALSE(error_of({marble}, levels, called).has_value());
}

TEST(EffectErrors, OfASceneForOneEffectAreKeptWhole) {
    const EffectInfo& info = effect_info(Effect::subsurface);
    std::vector<AccuracyRow> rows;
    for (std::size_t level = 0; level < info.levels.size(); ++level) {
        AccuracyRow& row = rows.emplace_back();
        row.scene = "marble";
        row.effect = info.name;
        row.index = static_cast<int>(level);
        row.error.p95 = 5.0 - row.index;
    }
    const EffectErrors errors = errors_of(rows);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_FALSE(is_of_all_effects(errors[0]));
    EXPECT_EQ(errors[0].at_level[static_cast<std::size_t>(Effect::subsurface)],
              (std::vector<double>{5.0, 4.0, 3.0}));
    rows.pop_back();
    EXPECT_TRUE(errors_of(rows).empty());
}

TEST(EffectErrors, ComeBackAsTheyWereWritten) {
    const TemporaryFolder folder;
    const auto file = folder / "errors.json";
    EffectErrors errors = halving_errors();
    errors[0].at_level[static_cast<std::size_t>(Effect::film)].clear();
    write_effect_errors(file, errors);
    const EffectErrors read = parse_effect_errors(read_text_file(file), file);
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read[0].scene, "one");
    EXPECT_EQ(read[0].dearest, kDearest);
    EXPECT_EQ(read[0].at_level, errors[0].at_level);
    EXPECT_TRUE(fails_with(
        [] { parse_effect_errors(R"({"format_version": 1, "scenes": [{"scene": 1}]})", "e.json"); },
        {"e.json: scenes[0].scene"}));
}

TEST(EffectErrors, OfRowsThatLackALevelAreLeftOut) {
    std::vector<AccuracyRow> rows;
    for (int level = 0; level < 2; ++level) {
        AccuracyRow& row = rows.emplace_back();
        row.scene = "half";
        row.effect = effect_info(Effect::sub_samples).name;
        row.index = level;
        row.error.p95 = 4.0 - level;
    }
    EXPECT_TRUE(errors_of(rows).empty());
    rows.push_back(rows.back());
    rows.back().index = 2;
    rows.back().error.p95 = 2.5;
    const EffectErrors errors = errors_of(rows);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].dearest, 2.5);
    EXPECT_DOUBLE_EQ(error_added(errors[0], Effect::sub_samples, 0), 16.0 - 6.25);
    EXPECT_EQ(error_added(errors[0], Effect::film, 0), 0.0) << "not called for there";
}

TEST(EffectErrors, SingleFlakesAreNoErrorOfTheOthers) {
    // Without a truth of their own they are far from it, and would hide every choice.
    std::vector<AccuracyRow> rows;
    for (const Effect effect : {Effect::sub_samples, Effect::glints}) {
        const EffectInfo& info = effect_info(effect);
        for (std::size_t level = 0; level < info.levels.size(); ++level) {
            AccuracyRow& row = rows.emplace_back();
            row.scene = "flakes";
            row.effect = info.name;
            row.index = static_cast<int>(level);
            row.error.p95 = effect == Effect::glints && level > 0 ? 14.0 : 3.0 - 0.5 * row.index;
        }
    }
    const EffectErrors errors = errors_of(rows);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].dearest, 2.0);
    for (const SceneErrors& shipped : known_effect_errors()) {
        if (!is_of_all_effects(shipped)) continue;
        EXPECT_LE(shipped.dearest, 2.0) << shipped.scene << ": what the ledger says of `high`";
    }
}

}  // namespace
}  // namespace livery
