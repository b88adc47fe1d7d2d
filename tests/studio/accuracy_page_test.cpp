// What accuracy costs, drawn without a window: what was measured here goes before what was shipped.
#include "studio/light/accuracy_page.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include "core/paths.h"
#include "studio/light/lighting_panel.h"
#include "studio/panels_fixture.h"
#include "studio/studio.h"

namespace livery {
namespace {

AccuracyLedger two_levels() {
    AccuracyLedger ledger;
    ledger.renderer = "a card of this machine";
    ledger.threads = 2;
    ledger.samples_per_pixel = 64;
    for (const char* level : {"draft", "normal"}) {
        AccuracyRow& row = ledger.rows.emplace_back();
        row.scene = "ball";
        row.effect = kQualityRows;
        row.level = level;
        row.solve_ms = ledger.rows.size() == 1 ? 100.0 : 900.0;
        row.error.median = 0.3;
        row.error.p95 = ledger.rows.size() == 1 ? 5.0 : 2.0;
        row.p99 = 8.0;
    }
    return ledger;
}

TEST_F(Panels, AccuracyAsShippedUntilItIsMeasuredHere) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const AccuracyPage& page = studio.panels.of<AccuracyPage>();
    frames(studio, draw_accuracy_page, 2);
    EXPECT_FALSE(page.shown) << "nothing is read before somebody asks";
    show_accuracy_page(studio, true);
    ItemPlaces places = frames(studio, draw_accuracy_page, 3);
    ASSERT_TRUE(page.shown) << page.problem;
    EXPECT_FALSE(page.measured_here);
    EXPECT_FALSE(page.levels.empty());
    for (const char* name : {"accuracy:measure", "accuracy:chart", "accuracy:quality:draft"}) {
        EXPECT_TRUE(places.contains(name)) << name;
    }
    write_accuracy(accuracy_file(), two_levels());
    show_accuracy_page(studio, true);
    frames(studio, draw_accuracy_page, 3);
    EXPECT_TRUE(page.measured_here);
    EXPECT_EQ(page.shown->renderer, "a card of this machine");
    ASSERT_EQ(page.levels.size(), 2u);
    EXPECT_EQ(page.on_front, (std::vector<bool>{true, true}));
}

TEST_F(Panels, ARowOfTheLedgerAndItsMarkArePointedAtTogether) {
    use_scale(1.0f);
    Studio studio = make_studio();
    write_accuracy(accuracy_file(), two_levels());
    show_accuracy_page(studio, true);
    const AccuracyPage& page = studio.panels.of<AccuracyPage>();
    ItemPlaces places = frames(studio, draw_accuracy_page, 3);
    const auto row = places["accuracy:quality:normal"];
    const auto point_at = [](int x, int y) {
        ImGui::GetIO().MousePos = {static_cast<float>(x), static_cast<float>(y)};
    };
    point_at(row.x + 5, row.y + row.height / 2);
    frames(studio, draw_accuracy_page, 2);
    EXPECT_EQ(page.pointed, 1);
    // The slower and nearer mark is the one at the right and low
    const auto chart = places["accuracy:chart"];
    int found = -1;
    for (int x = chart.width / 2; x < chart.width && found != 1; x += 10) {
        for (int y = chart.height / 3; y < chart.height && found != 1; y += 10) {
            point_at(chart.x + x, chart.y + y);
            frames(studio, draw_accuracy_page, 1);
            found = page.pointed;
        }
    }
    EXPECT_EQ(found, 1);
}

TEST_F(Panels, ADamagedLedgerIsNamedAndNothingIsLost) {
    use_scale(1.0f);
    Studio studio = make_studio();
    write_text_file(accuracy_file(), "{\"format_version\": 1, \"renderer\": 7}");
    show_accuracy_page(studio, true);
    const ItemPlaces places = frames(studio, draw_accuracy_page, 3);
    const AccuracyPage& page = studio.panels.of<AccuracyPage>();
    EXPECT_FALSE(page.shown);
    EXPECT_NE(page.problem.find("renderer"), std::string::npos) << page.problem;
    EXPECT_TRUE(places.contains("accuracy:measure")) << "it can be measured anew";
}

}  // namespace
}  // namespace livery
