#include "live/frame_description.h"

#include "live/frame_thread_fixture.h"

namespace livery {
namespace {

TEST(SolveKey, SaysWhatIsMissing) {
    FrameDescription description;
    auto setup = std::make_shared<ProjectorSetup>();
    setup->view = test_view(8, 8);
    description.setup = setup;
    description.scene.product = std::make_shared<Product>();
    const SolveKeys wanted = WantedFrame(description).keys;
    EXPECT_EQ(missing_of(wanted, wanted), "");
    EXPECT_EQ(missing_of({}, wanted), "picture");
    EXPECT_FALSE(covers_light({}, wanted));
    const auto missing = [&](const auto& change) {
        SolveKeys solved = wanted;
        change(*solved[0]);
        return missing_of(solved, wanted);
    };
    EXPECT_EQ(missing([](SolveKey& key) { key.lights.emplace_back(); }), "light");
    EXPECT_EQ(missing([](SolveKey& key) { key.eye_mm.x = 1.0; }), "eye");
    EXPECT_EQ(missing([](SolveKey& key) { key.environment = sky(1.0); }), "environment");
    EXPECT_EQ(missing([](SolveKey& key) { key.view.focal_px.x += 1.0; }), "projector");
    EXPECT_EQ(missing([](SolveKey& key) { key.product = nullptr; }), "product");
    EXPECT_EQ(missing([](SolveKey& key) {
                  key.media = {{1.0, 2.0}};
              }),
              "light in translucent parts");
    const EffectLevels draft = levels_of(Quality::draft);
    EXPECT_EQ(missing([&](SolveKey& key) { key.levels = draft; }), "normal quality");
    EXPECT_TRUE(covers_light(with_levels(wanted, draft), wanted));
    SolveKeys chosen = wanted;
    chosen[0]->levels[Effect::shadows] = 0;
    EXPECT_EQ(missing_of(wanted, chosen), "levels");
}

}  // namespace
}  // namespace livery
