#include <atomic>
#include <cstdlib>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "appearance/material_library.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "live/contexts.h"
#include "live/preview_picture.h"
#include "live/preview_thread.h"
#include "support/gl_device.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::SharedContexts;

/// The user's folder for one test; no thread may read the environment while it changes.
class Swatches : public ::testing::Test {
  protected:
    Swatches() {
        const char* before = std::getenv("LIVERY_HOME");
        before_ = before ? before : "";
        ::setenv("LIVERY_HOME", (folder_ / "home").c_str(), 1);
    }
    ~Swatches() override {
        if (before_.empty()) {
            ::unsetenv("LIVERY_HOME");
        } else {
            ::setenv("LIVERY_HOME", before_.c_str(), 1);
        }
    }
    TemporaryFolder folder_;

  private:
    std::string before_;
};

const SwatchStudio& studio() {
    static const SwatchStudio made = make_swatch_studio();
    return made;
}

double mean_of(const Image8& swatch, int channel) {
    double sum = 0.0;
    for (std::size_t i = 0; i < swatch.pixel_count(); ++i) {
        sum += swatch.values[4 * i + static_cast<std::size_t>(channel)];
    }
    return sum / static_cast<double>(swatch.pixel_count());
}

TEST_F(Swatches, ShowEachPaintOnASphereTheSameEveryTime) {
    HeadlessContext context(tested_gl());
    SwatchPainter painter(studio());
    std::set<std::vector<std::uint8_t>> different;
    const std::vector<Material> library = read_paint_folder(shipped_path("materials"));
    ASSERT_GE(library.size(), 16u);
    for (const Material& paint : library) {
        const Image8 swatch = painter.paint(paint, 48);
        EXPECT_EQ(swatch.values, painter.paint(paint, 48).values) << paint.name;
        EXPECT_EQ(swatch.at(0, 0, 3), 0) << paint.name;
        EXPECT_EQ(swatch.at(47, 47, 3), 0) << paint.name;
        EXPECT_EQ(swatch.at(24, 24, 3), 255) << paint.name;
        EXPECT_NEAR(mean_of(swatch, 3), 255.0 * 0.785 * 0.96 * 0.96, 4.0) << paint.name;
        different.insert(swatch.values);
    }
    EXPECT_EQ(different.size(), library.size());
    const Image8 red = painter.paint(find_material("solid red"), 48);
    EXPECT_GT(mean_of(red, 0), 2.0 * mean_of(red, 1));
    EXPECT_THROW(painter.paint(library.front(), 7), std::invalid_argument);
    EXPECT_THROW(painter.paint(library.front(), 1025), std::invalid_argument);
}

TEST_F(Swatches, OfTranslucentPaintsAreDiscsLitFromBehind) {
    const Material marble = translucent_paint(read_translucent_material("marble"));
    const Image8 swatch = translucent_swatch(marble, 64);
    EXPECT_EQ(swatch.at(0, 0, 3), 0);
    EXPECT_EQ(swatch.at(32, 32, 3), 255);
    // Brighter where it is thin; where it is thick blue is lost first
    const std::uint8_t *thin = swatch.pixel(4, 32), *thick = swatch.pixel(59, 32);
    for (int c = 0; c < 3; ++c) EXPECT_GT(thin[c], thick[c] + 40) << c;
    EXPECT_GT(thick[0], thick[2] + 5);
    // Nothing that absorbs and does not scatter comes back, and little gets through
    Material ink = marble;
    TranslucentMaterial black = *marble.medium;
    black.sigma_s_prime_per_mm = glm::dvec3(0.0);
    black.sigma_a_per_mm = glm::dvec3(10.0);
    ink.medium = std::make_shared<const TranslucentMaterial>(black);
    EXPECT_LT(translucent_swatch(ink, 64).at(32, 32, 1), 3);
    Material opaque;
    EXPECT_THROW(translucent_swatch(opaque, 64), std::invalid_argument);
}

TEST_F(Swatches, AreKeptByWhatDecidesHowTheyLook) {
    const Material red = find_material("solid red");
    Material renamed = red;
    renamed.name = "another name";
    EXPECT_EQ(swatch_file(red, 64), swatch_file(renamed, 64));
    EXPECT_NE(swatch_file(red, 64), swatch_file(red, 65));
    std::set<std::filesystem::path> files{swatch_file(red, 64)};
    for (int k = 0; k < 8; ++k) {
        Material changed = red;
        if (k == 0) changed.model = ReflectanceModel::ggx;
        if (k == 1) changed.diffuse.z += 1e-4;
        if (k == 2) changed.f0.x += 1e-4;
        if (k == 3) changed.alpha.x += 1e-4;
        if (k == 4) changed.alpha.y += 1e-4;
        if (k == 5) changed.coat_alpha += 1e-4;
        if (k == 6) changed.coat_f0 += 1e-4;
        if (k == 7) changed.coat_transmittance.y -= 1e-4;
        files.insert(swatch_file(changed, 64));
    }
    EXPECT_EQ(files.size(), 9u);

    EXPECT_FALSE(kept_swatch(red, 16));
    Image8 swatch(16, 16, 4);
    for (std::size_t i = 0; i < swatch.values.size(); ++i) {
        swatch.values[i] = static_cast<std::uint8_t>(i % 251);
    }
    ASSERT_TRUE(keep_swatch(red, swatch));
    EXPECT_EQ(kept_swatch(red, 16)->values, swatch.values);
    EXPECT_FALSE(kept_swatch(red, 17));
}

TEST_F(Swatches, DamagedFilesCountAsNone) {
    const Material red = find_material("solid red");
    ASSERT_TRUE(keep_swatch(red, Image8(16, 16, 4, 99)));
    const auto file = swatch_file(red, 16);
    const std::string whole = read_text_file(file);
    for (const std::string& damaged :
         {std::string(), std::string("not a picture"), whole.substr(0, whole.size() / 2)}) {
        std::ofstream(file, std::ios::binary | std::ios::trunc) << damaged;
        EXPECT_FALSE(kept_swatch(red, 16)) << damaged.size();
    }
    write_png(file, Image8(16, 16, 3));  // no coverage below
    EXPECT_FALSE(kept_swatch(red, 16));
    write_png(file, Image8(16, 32, 1));
    EXPECT_FALSE(kept_swatch(red, 16));
    std::filesystem::remove(file);
    std::filesystem::create_directory(file);
    EXPECT_FALSE(kept_swatch(red, 16));
    EXPECT_FALSE(keep_swatch(red, Image8(16, 16, 4)));
}

TEST_F(Swatches, TheThreadDrawsOnceThenReadsTheFile) {
    const Material red = find_material("solid red");
    SharedContexts contexts;
    testing::Finished<Image8> drawn;
    {
        PreviewThread thread(contexts.theirs, [](const auto&) {});
        thread.request_swatch(red, 40, drawn.callback());
        ASSERT_TRUE(drawn.wait_for_count(1));
        EXPECT_THROW(thread.request_swatch(red, 0, {}), std::invalid_argument);
    }
    const Image8 first = drawn.all().front();
    ASSERT_EQ(first.width, 40);
    EXPECT_EQ(kept_swatch(red, 40)->values, first.values);
    // What the file says is what is shown
    Image8 marked = first;
    marked.at(20, 20, 1) ^= 0xff;
    ASSERT_TRUE(keep_swatch(red, marked));
    {
        PreviewThread thread(contexts.theirs, [](const auto&) {});
        thread.request_swatch(red, 40, drawn.callback());
        ASSERT_TRUE(drawn.wait_for_count(2));
        EXPECT_EQ(drawn.all().back().values, marked.values);
        // A damaged one is drawn anew and replaced
        std::ofstream(swatch_file(red, 40), std::ios::trunc) << "damaged";
        thread.request_swatch(red, 40, drawn.callback());
        ASSERT_TRUE(drawn.wait_for_count(3));
    }
    EXPECT_EQ(drawn.all().back().values, first.values);
    EXPECT_EQ(kept_swatch(red, 40)->values, first.values);
}

TEST_F(Swatches, TheLastRequestedComesFirst) {
    SharedContexts contexts;
    std::mutex mutex;
    std::condition_variable wake;
    bool go_on = false, started = false;
    testing::Finished<int> order;
    PreviewThread thread(contexts.theirs, [](const auto&) {});
    const Material red = find_material("solid red");
    thread.request_swatch(red, 16, [&](const Image8&) {
        std::unique_lock lock(mutex);
        started = true;
        wake.notify_all();
        wake.wait(lock, [&] { return go_on; });
    });
    {
        std::unique_lock lock(mutex);
        wake.wait(lock, [&] { return started; });
    }
    for (int k = 1; k <= 4; ++k) {
        thread.request_swatch(red, 16 + k, [&order, k](const Image8&) { order.add(k); });
    }
    {
        const std::scoped_lock lock(mutex);
        go_on = true;
    }
    wake.notify_all();
    ASSERT_TRUE(order.wait_for_count(4));
    EXPECT_EQ(order.all(), (std::vector<int>{4, 3, 2, 1}));
}

TEST_F(Swatches, AreDrawnWhereNothingCanBeKept) {
    // A file where the user's folder should be
    std::ofstream(folder_ / "home") << "no folder";
    SharedContexts contexts;
    testing::Finished<Image8> drawn;
    PreviewThread thread(contexts.theirs, [](const auto&) {});
    thread.request_swatch(find_material("chrome trim"), 24, drawn.callback());
    ASSERT_TRUE(drawn.wait_for_count(1));
    EXPECT_EQ(drawn.all().front().width, 24);
    EXPECT_FALSE(kept_swatch(find_material("chrome trim"), 24));
}

}  // namespace
}  // namespace livery
