// What is suggested for a mesh, what the answers come to, and the session made of them.
#include "studio/product/new_session.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <thread>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "mesh/scan_writer.h"
#include "scene/library.h"
#include "studio/box_mesh.h"
#include "studio/product/mesh_picture.h"
#include "studio/studio.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

TEST(SuggestedAnswers, AScanOfACarInMetresWithZUpIsSeenThrough) {
    const MeshFacts facts = facts_of(box({4.6f, 1.9f, 1.45f}, {12, -3, 0.7f}), "car.ply");
    const auto [answers, unit_why, up_why, scale_why] = suggested_answers(facts);
    EXPECT_EQ(answers.unit, LengthUnit::m);
    EXPECT_NE(unit_why.find("4.6"), std::string::npos) << unit_why;
    EXPECT_EQ(answers.up, UpAxis::plus_z);
    EXPECT_TRUE(answers.mesh_is_product);
    EXPECT_EQ(answers.product_scale, 25.0);
    EXPECT_EQ(size_text(product_size_mm(facts, answers)), "4,600 x 1,450 x 1,900 mm");
    EXPECT_EQ(size_text(mock_up_size_mm(facts, answers)), "184 x 58 x 76 mm");
    EXPECT_FALSE(up_why.empty() || scale_why.empty());
}

TEST(SuggestedAnswers, WhatIsSmallIsTheModelItself) {
    const MeshFacts facts = facts_of(box({180, 60, 75}), "car.obj");
    const ProductAnswers answers = suggested_answers(facts).answers;
    EXPECT_EQ(answers.unit, LengthUnit::mm);
    EXPECT_EQ(answers.up, UpAxis::plus_y);
    EXPECT_FALSE(answers.mesh_is_product);
    EXPECT_EQ(answers.product_scale, 1.0);
    EXPECT_EQ(mock_up_size_mm(facts, answers), glm::dvec3(180, 60, 75));
    ProductAnswers model = answers;
    model.product_scale = 25.0;
    EXPECT_EQ(mock_up_size_mm(facts, model), glm::dvec3(180, 60, 75));
    EXPECT_EQ(product_size_mm(facts, model), glm::dvec3(4500, 1500, 1875));
}

TEST(SuggestedAnswers, GltfSaysItsUnitAndWhatIsUp) {
    const MeshFacts facts = facts_of(box({30, 1, 0.5f}), "bus.GLB");
    EXPECT_EQ(suggested_answers(facts).answers.unit, LengthUnit::m);
    EXPECT_EQ(suggested_answers(facts).answers.up, UpAxis::plus_y);
}

TEST(SuggestedAnswers, AUnitThatWasSaidStands) {
    const MeshFacts facts = facts_of(box({180, 60, 75}), "car.obj");
    const SuggestedAnswers suggested = suggested_answers(facts, LengthUnit::cm);
    EXPECT_EQ(suggested.answers.unit, LengthUnit::cm);
    EXPECT_NE(suggested.unit_why.find("cm"), std::string::npos) << suggested.unit_why;
    EXPECT_TRUE(suggested.answers.mesh_is_product) << "1.8 m";
    EXPECT_EQ(
        suggested_answers(facts_of(box({180, 60, 75}), "car.glb"), LengthUnit::mm).answers.unit,
        LengthUnit::mm);
}

TEST(ProductAnswers, ScalesHaveWords) {
    EXPECT_EQ(scale_text(1.0), "real size");
    EXPECT_EQ(scale_text(25.0), "1:25 model");
    EXPECT_EQ(scale_text(0.1), "10:1 model");
}

TEST(ProductAnswers, NamesAndScalesThatCannotBeAreRefusedInWords) {
    ProductAnswers answers;
    answers.part_names = {"body", "glass"};
    EXPECT_EQ(problem_of(answers), "");
    answers.part_names = {"body", "body"};
    EXPECT_NE(problem_of(answers).find("\"body\""), std::string::npos);
    answers.part_names = {"body", "  "};
    EXPECT_EQ(problem_of(answers), "Each part needs a name.");
    answers.part_names = {"body"};
    for (const double scale : {0.0, -1.0, 1e7, std::nan("")}) {
        answers.product_scale = scale;
        EXPECT_NE(problem_of(answers), "") << scale;
    }
}

/// Where +x of a mesh whose y is up ends up, and what is said of its front.
TEST(ProductAnswers, TheFrontTurnsWithTheProduct) {
    const std::map<std::string, glm::dvec3> directions{
        {"+x", {1, 0, 0}}, {"-x", {-1, 0, 0}}, {"+z", {0, 0, 1}}, {"-z", {0, 0, -1}}};
    ProductAnswers answers;
    answers.front = "+x";
    for (int k = 0; k < 5; ++k, turn(answers)) {
        const glm::dvec3 there =
            upright_rotation(answers.up, answers.quarter_turns) * glm::dvec3(1, 0, 0);
        EXPECT_LT(glm::distance(there, directions.at(answers.front)), 1e-12) << k;
    }
    EXPECT_EQ(answers.quarter_turns, 1);
    set_up(answers, answers.up);
    EXPECT_EQ(answers.front, "-z");
    const MeshFacts facts = facts_of(box({180, 60, 75}), "car.obj");
    EXPECT_EQ(product_file_of(facts, answers, "car").front, "-z");
    set_up(answers, UpAxis::plus_z);
    EXPECT_EQ(answers.front, "");
    turn(answers);
    EXPECT_EQ(answers.front, "");
}

struct Seen {
    double filled = 0.0;  ///< share of the picture
    int brightest = 0;
};
Seen seen_in(const Image8& picture) {
    Seen seen;
    for (std::size_t k = 0; k < picture.pixel_count(); ++k) {
        seen.filled += picture.values[4 * k + 3] > 127 ? 1.0 : 0.0;
        seen.brightest = std::max<int>(seen.brightest, picture.values[4 * k]);
    }
    seen.filled /= static_cast<double>(picture.pixel_count());
    return seen;
}

TEST(MeshPicture, ShowsTheProductAsItWouldStand) {
    const Mesh mesh = box({4.6f, 1.9f, 1.45f}, {12, -3, 0.7f});
    const glm::ivec2 size{220, 150};
    const Image8 lying = mesh_picture(mesh, upright_rotation(UpAxis::plus_z, 0), size);
    EXPECT_EQ(glm::ivec2(lying.width, lying.height), size);
    const Seen seen = seen_in(lying);
    EXPECT_GT(seen.filled, 0.2);
    EXPECT_LT(seen.filled, 0.9);
    EXPECT_GT(seen.brightest, 120);
    // On its end it is narrow, and the corners of the picture stay empty.
    const Seen upright = seen_in(mesh_picture(mesh, upright_rotation(UpAxis::plus_x, 0), size));
    EXPECT_LT(upright.filled, seen.filled);
    EXPECT_GT(upright.filled, 0.05);
    EXPECT_THROW(mesh_picture(mesh, glm::dmat3(1.0), {0, 10}), std::invalid_argument);
    // From its long side and from its end
    const auto seen_from = [&](double azimuth_rad) {
        return seen_in(
            mesh_picture(mesh, upright_rotation(UpAxis::plus_z, 0), {300, 300}, azimuth_rad));
    };
    EXPECT_GT(seen_from(0.5 * std::numbers::pi).filled, 1.2 * seen_from(0.0).filled);
}

/// The window's state without a window, on a session in a file.
class OneWindow : public ::testing::Test {
  protected:
    OneWindow() : studio_(first_session()) {
        studio_.background = std::make_unique<Background>([] {});
        studio_.file_dialog = std::make_unique<FileDialog>(studio_.settings);
    }
    ~OneWindow() override { unsetenv("LIVERY_HOME"); }

    Session first_session() {
        setenv("LIVERY_HOME", (folder_ / "home").c_str(), 1);
        return Session::open(folder_ / "first.livery", "sphere");
    }
    std::filesystem::path write_box(const std::string& name) {
        ScanWriter scan = box_scan({2.3f, 0.95f, 0.725f});
        return folder_.write(name, scan.binary_ply(std::endian::little));
    }
    void finish_work() {
        while (studio_.background->is_busy()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        studio_.background->take_results();
    }
    NewSession asked_of(const std::filesystem::path& mesh) {
        NewSession asked;
        asked.given = mesh;
        asked.facts = facts_of(load_mesh(mesh, nullptr, LengthUnit::mm), mesh);
        asked.answers = suggested_answers(asked.facts).answers;
        asked.answers.part_names = {"body"};
        asked.session = folder_ / "made" / "car.livery";
        return asked;
    }
    std::string only_notice() {
        const auto& notices = studio_.notices;
        EXPECT_EQ(notices.size(), 1u);
        return notices.empty() ? "" : notices[0].what + " " + notices[0].cause;
    }

    TemporaryFolder folder_;
    Studio studio_;
};

TEST_F(OneWindow, ASessionOfAMeshHasItsProductBesideIt) {
    const NewSession asked = asked_of(write_box("car.ply"));
    {
        const OpenedSession made = create_session(asked);
        EXPECT_EQ(made.product->product_scale, 25.0);
        EXPECT_EQ(made.product->mesh.parts.at(0).name, "body");
        const Bounds bounds = bounds_of(made.product->mesh);
        EXPECT_LT(glm::distance(bounds.low, glm::dvec3(-92, 0, -38)), 1e-3);
        EXPECT_LT(glm::distance(bounds.high, glm::dvec3(92, 58, 38)), 1e-3);
        EXPECT_EQ(made.session.document().product, (folder_ / "made/car.product.json").string());
    }
    // Nothing is written over.
    EXPECT_THROW(create_session(asked), Refused);
    std::filesystem::remove(asked.session);
    EXPECT_THROW(create_session(asked), Refused);
    EXPECT_EQ(unused_session_file(folder_ / "made", "car"), folder_ / "made/car-2.livery");
}

TEST_F(OneWindow, ASessionThatCannotBeMadeLeavesNothingBehind) {
    NewSession asked = asked_of(write_box("car.ply"));
    std::filesystem::remove(asked.given);
    EXPECT_TRUE(fails_with([&] { create_session(asked); }, {"car.ply: found no such file"}));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "made/car.product.json"));
    EXPECT_FALSE(std::filesystem::exists(asked.session));
}

TEST_F(OneWindow, AMeshThatIsDroppedIsAskedAbout) {
    take_dropped_files(studio_, {write_box("my car.ply")});
    ASSERT_TRUE(page(studio_));
    EXPECT_EQ(page(studio_)->stage, NewSession::Stage::reading);
    finish_work();
    const NewSession& asked = *page(studio_);
    ASSERT_EQ(asked.stage, NewSession::Stage::asking) << asked.problem;
    EXPECT_EQ(asked.facts.triangles, 12u);
    EXPECT_EQ(asked.answers.unit, LengthUnit::m);
    EXPECT_EQ(asked.session.filename(), "my-car.livery");
    const auto share_at = [&](double product_scale) {
        ProductAnswers answers = asked.answers;
        answers.product_scale = product_scale;
        return lit_share(asked.samples, product_file_of(asked.facts, answers, ""), asked.projector);
    };
    EXPECT_GT(share_at(25.0).value(), 0.98);
    EXPECT_LT(share_at(10.0).value(), 0.7);
    start_creating(studio_);
    finish_work();
    ASSERT_TRUE(studio_.next_session);
    EXPECT_EQ(studio_.next_session->session.file(), asked.session);
}

TEST_F(OneWindow, AProductFileHasAnsweredAll) {
    write_box("car.ply");
    const auto file = folder_.write(
        "car.product.json",
        R"({"format_version": 1, "mesh": "car.ply", "unit": "cm", "product_scale": 4})");
    take_dropped_files(studio_, {file});
    finish_work();
    ASSERT_TRUE(page(studio_) && page(studio_)->is_product_file);
    EXPECT_EQ(page(studio_)->session.filename(), "car.livery");
    EXPECT_EQ(size_text(mock_up_size_mm(page(studio_)->facts, page(studio_)->answers)),
              "46 x 19 x 15 mm");
    start_creating(studio_);
    finish_work();
    ASSERT_TRUE(studio_.next_session);
    EXPECT_EQ(studio_.next_session->session.document().product, file.string());
    EXPECT_EQ(studio_.next_session->product->product_scale, 4.0);
}

TEST_F(OneWindow, AUnitThatIsGivenWithAFileIsItsWhateverItSays) {
    write_box("car.ply");
    const auto file = folder_.write(
        "car.product.json",
        R"({"format_version": 1, "mesh": "car.ply", "unit": "cm", "product_scale": 4})");
    begin_new_session(studio_, file, {}, LengthUnit::in);
    finish_work();
    start_creating(studio_);
    finish_work();
    ASSERT_TRUE(studio_.next_session) << page(studio_)->problem;
    EXPECT_EQ(studio_.next_session->session.document().product_unit, LengthUnit::in);
    const Bounds bounds = bounds_of(studio_.next_session->product->mesh);
    EXPECT_NEAR(bounds.high.x - bounds.low.x, 4.6 * 25.4, 1e-3);

    begin_new_session(studio_, folder_ / "car.ply", {}, LengthUnit::mm);
    finish_work();
    EXPECT_EQ(page(studio_)->answers.unit, LengthUnit::mm);
}

TEST_F(OneWindow, WhatCannotBeReadSaysSoOnThePage) {
    begin_new_session(studio_, folder_.write("broken.ply", "ply\nformat nonsense\n"));
    finish_work();
    ASSERT_TRUE(page(studio_));
    EXPECT_EQ(page(studio_)->stage, NewSession::Stage::unreadable);
    EXPECT_NE(page(studio_)->problem.find("broken.ply"), std::string::npos);
    EXPECT_TRUE(studio_.notices.empty());
}

TEST_F(OneWindow, ThePageKeepsWhatWasAnsweredWhenTheSessionCannotBeMade) {
    begin_new_session(studio_, write_box("car.ply"));
    finish_work();
    page(studio_)->answers.product_scale = 10.0;
    page(studio_)->session = folder_ / "first.livery";
    start_creating(studio_);
    finish_work();
    ASSERT_TRUE(page(studio_) && !studio_.next_session);
    EXPECT_EQ(page(studio_)->stage, NewSession::Stage::asking);
    EXPECT_EQ(page(studio_)->answers.product_scale, 10.0);
    EXPECT_NE(page(studio_)->problem.find("is there already"), std::string::npos)
        << page(studio_)->problem;
    page(studio_)->answers.part_names = {""};
    start_creating(studio_);
    EXPECT_EQ(page(studio_)->problem, "Each part needs a name.");
    page(studio_)->answers.part_names = {"body"};
    page(studio_)->session = " ";
    start_creating(studio_);
    EXPECT_EQ(page(studio_)->problem, "Say where the session is saved.");
    // A bare name is one in the folder of sessions.
    page(studio_)->session = "my v1.2";
    start_creating(studio_);
    finish_work();
    ASSERT_TRUE(studio_.next_session) << page(studio_)->problem;
    EXPECT_EQ(studio_.next_session->session.file(), folder_ / "home/sessions/my v1.2.livery");
}

TEST_F(OneWindow, APageThatWasClosedHearsNothingMore) {
    begin_new_session(studio_, write_box("car.ply"));
    page(studio_).reset();
    finish_work();
    EXPECT_FALSE(page(studio_));
    begin_new_session(studio_, write_box("car.ply"));
    begin_new_session(studio_, write_box("van.ply"));
    finish_work();
    EXPECT_EQ(page(studio_)->facts.file.filename(), "van.ply");
}

TEST_F(OneWindow, OtherThingsThatAreDroppedAreSaidNotToBeFor) {
    const auto look =
        folder_.write("look.json", R"({"format_version": 1, "name": "x", "parts": {}})");
    for (const std::vector<std::filesystem::path>& files :
         {std::vector{folder_.write("notes.txt", "x")},
          {look},
          {folder_.path()},
          {write_box("a.ply"), write_box("b.ply")}}) {
        studio_.notices.clear();
        take_dropped_files(studio_, files);
        finish_work();
        EXPECT_NE(only_notice().find(".glb"), std::string::npos) << files[0];
        EXPECT_FALSE(page(studio_) || studio_.next_session) << files[0];
    }
}

TEST_F(OneWindow, ASessionThatIsDroppedIsNext) {
    Session::open(folder_ / "second.livery", "sphere");
    take_dropped_files(studio_, {folder_ / "second.livery"});
    finish_work();
    ASSERT_TRUE(studio_.next_session);
    EXPECT_EQ(studio_.next_session->session.file(), folder_ / "second.livery");
    EXPECT_EQ(studio_.next_session->product->name, "Sphere");
}

TEST_F(OneWindow, WhatCannotBeOpenedLeavesTheSessionThatIs) {
    const auto refused_with = [&](const std::filesystem::path& file, const std::string& words) {
        studio_.notices.clear();
        open_other_session(studio_, file);
        finish_work();
        EXPECT_FALSE(studio_.next_session) << file;
        const std::string notice = only_notice();
        EXPECT_NE(notice.find(words), std::string::npos) << notice;
    };
    refused_with(folder_ / "gone.livery", "no such file");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "gone.livery"));
    refused_with(folder_.write("broken.livery", "not a session"), "broken.livery");
    refused_with(folder_ / "first.livery", "This session is open already.");
    {
        const Session elsewhere = Session::open(folder_ / "elsewhere.livery", "sphere");
        refused_with(folder_ / "elsewhere.livery", "is open in another Livery");
    }
    const auto mesh = write_box("car.ply");
    Session::open(folder_ / "of mesh.livery", mesh.string());
    std::filesystem::remove(mesh);
    refused_with(folder_ / "of mesh.livery", "car.ply");
    studio_.session = Session::unsaved(studio_.session.document(), "a test");
    refused_with(folder_ / "second.livery", "not saved yet");
}

TEST_F(OneWindow, TheLastTenSessionsAreKnownTheNewestFirst) {
    UserSettings settings;
    settings.file = folder_ / "desktop.json";
    for (int k = 0; k < 12; ++k) {
        remember_recent_session(settings, folder_ / ("s" + std::to_string(k) + ".livery"));
    }
    remember_recent_session(settings, folder_ / "s5.livery");
    const auto files = recent_sessions(settings);
    ASSERT_EQ(files.size(), kMostRecentSessions);
    EXPECT_EQ(files[0], folder_ / "s5.livery");
    EXPECT_EQ(files[1], folder_ / "s11.livery");
    EXPECT_EQ(files[9], folder_ / "s2.livery");
    EXPECT_TRUE(recent_sessions({}).empty());
}

}  // namespace
}  // namespace livery
