// Files that a session names and that are no good: refused when they are chosen, left out and told
// when they go bad later. What else is shown never hangs on them.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "scene/library.h"
#include "session/some_commands.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::car;

std::filesystem::path sky(const TemporaryFolder& folder, const std::string& name) {
    const auto file = folder / name;
    write_exr(file, ImageF(8, 4, 3, 0.5f));
    return file;
}

SetEnvironment lit_by(const std::filesystem::path& file) { return {1, {file.string(), 0.0, 1.0}}; }

TEST(Environment, ThatIsNoMapIsRefusedWhenItIsChosen) {
    const TemporaryFolder folder;
    const auto junk = folder.write("junk.hdr", "this is no picture");
    const auto refusal = [](const SessionCommand& command) {
        return message_of([&] { applied(car(), command); });
    };
    EXPECT_NE(refusal(lit_by(junk)).find("junk.hdr"), std::string::npos) << refusal(lit_by(junk));
    write_exr(folder / "square.exr", ImageF(8, 8, 3, 0.5f));
    EXPECT_TRUE(says(refusal(lit_by(folder / "square.exr")), "twice as wide as high"));
    // Nor does a look bring one along.
    Look look = car().looks[0].look;
    look.name = "imported";
    look.environment.file = junk.string();
    EXPECT_NE(refusal(AddLook{look}).find("junk.hdr"), std::string::npos);
    EXPECT_EQ(refusal(lit_by(sky(folder, "sky.exr"))), "nothing thrown");
}

TEST(Environment, ThatGoesBadLaterIsLeftOutAndTold) {
    const TemporaryFolder folder;
    const auto file = sky(folder, "sky.exr");
    const Document document = applied(car(), lit_by(file));
    const auto product = find_product("car");
    EXPECT_TRUE(drawing_problems(document).empty());
    ASSERT_TRUE(scene_of(document, 1, product).environment);

    std::ofstream(file, std::ios::trunc) << "a broken copy";
    const Scene scene = scene_of(document, 1, product);
    EXPECT_FALSE(scene.environment);
    EXPECT_EQ(scene.part_materials.size(), product->mesh.parts.size());
    const auto told = drawing_problems(document);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_TRUE(says(told[0], car().looks[0].look.name + " is lit without its environment"));
    EXPECT_NE(told[0].find("sky.exr"), std::string::npos) << told[0];
    // Others are as they were.
    EXPECT_TRUE(drawing_problems(document, document.looks[1]).empty());
    // Later commands work, and the look is itself again with the file.
    const Document later = applied(document, SetPaint{1, "body", "solid red"});
    EXPECT_EQ(later.looks[0].look.environment.file, file.string());
    std::filesystem::remove(file);
    EXPECT_FALSE(scene_of(later, 1, product).environment);
    write_exr(file, ImageF(16, 8, 3, 0.5f));
    EXPECT_TRUE(scene_of(later, 1, product).environment);
    EXPECT_TRUE(drawing_problems(later).empty());
}

TEST(PaintFile, ThatIsGoneLaterLeavesItsPartBlackAndIsTold) {
    const TemporaryFolder folder;
    Material paint = testing::some_paint();
    paint.name = "ours";
    write_material_file(folder / "ours.json", paint);
    const auto product = find_product("car");
    const auto body = static_cast<std::size_t>(part_index(*product, "body"));
    Document document =
        testing::applied_with_files(car(), SetPaint{1, "body", (folder / "ours.json").string()});
    EXPECT_EQ(scene_of(document, 1, product).part_materials[body].diffuse, paint.diffuse);
    std::filesystem::remove(folder / "ours.json");
    document = in_library(document, read_paint_library(document.library));
    const Scene scene = scene_of(document, 1, product);
    EXPECT_EQ(scene.part_materials[body].diffuse, glm::dvec3(0.0));
    const auto told = drawing_problems(document);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("ours.json\" is black"), std::string::npos) << told[0];
}

}  // namespace
}  // namespace livery
