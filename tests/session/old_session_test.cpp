// A session that an older Livery wrote: it opens, and nothing of it is lost when it is saved again.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene/library.h"
#include "session/session.h"
#include "session/session_file.h"
#include "support/old_files.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// Of each step, from the beginning on: its label and the document after it.
using History = std::vector<std::pair<std::string, std::string>>;

/// Leaves the session where it was.
History history_of(Session& session) {
    int back = 0, forth = 0;
    for (; session.can_undo(); ++back) session.undo();
    History history = {{"", text_of(session.document())}};
    for (; session.can_redo(); ++forth) {
        const std::string label = session.redo_label();
        session.redo();
        history.emplace_back(label, text_of(session.document()));
    }
    for (; forth > back; --forth) session.undo();
    return history;
}

TEST(OldSession, HoldsItsLooksPaintsAndSeats) {
    const TemporaryFolder folder;
    const Session session = Session::open(testing::unpacked_old_files(folder) / "session.livery");
    const Document& document = session.document();
    std::vector<std::pair<int, std::string>> looks;
    for (const SessionLook& look : document.looks) looks.emplace_back(look.id, look.look.name);
    EXPECT_EQ(looks,
              (std::vector<std::pair<int, std::string>>{{5, "nachtblau über alles 2"},
                                                        {1, "blue metallic"},
                                                        {6, "solid red 2"},
                                                        {2, "nachtblau über alles"},
                                                        {3, "solid ivory"}}));
    EXPECT_EQ(document.next_look_id, 7);

    const Look& edited = find_look(document, 1)->look;
    EXPECT_EQ(edited.parts,
              (std::map<std::string, std::string>{{"body", "solid red"},
                                                  {"glass", "dark glass"},
                                                  {"lights", "lamp glass"},
                                                  {"rims", "Monza gold"},
                                                  {"trim", "black trim"},
                                                  {"tyres", "tyre rubber"}}));
    Artwork stripes, number;
    stripes.name = "Streifen quer";
    stripes.part = number.part = "body";
    stripes.paint = "solid ivory";
    stripes.size_mm = 12.5;
    stripes.share = 0.25;
    stripes.place.centre_mm = {1.5, 30.0, -40.0};
    number.name = "number";
    number.paint = "solid white";
    number.shape = ArtworkShape::picture;
    number.picture = "assets/patterns/roundel.png";
    number.size_mm = 21.0;
    number.place.through = false;
    EXPECT_EQ(edited.artwork, (std::vector<Artwork>{stripes, number}));
    EXPECT_EQ(edited.lights.size(), 2u);
    EXPECT_EQ(find_look(document, 5)->look.parts,
              (std::map<std::string, std::string>{{"*", "matte grey"}}));
    const Look& added = find_look(document, 6)->look;
    EXPECT_EQ(added.parts,
              (std::map<std::string, std::string>{{"*", "matte grey"}, {"glass", "dark glass"}}));
    EXPECT_EQ(added.environment.file, "assets/environments/studio.hdr");
    EXPECT_EQ(added.environment.rotation_rad, 0.5);
    EXPECT_EQ(added.environment.scale, 1.25);
    const Look& lit = find_look(document, 3)->look;
    EXPECT_EQ(lit.lights,
              (std::vector<DirectionalLight>{{{0.6, 0.8, 0.0}, {1.0, 0.5, 0.25}, 0.05}}));
    EXPECT_EQ(lit.environment.file, "");

    ASSERT_EQ(document.paints.size(), 1u);
    const Material& paint = document.paints[0];
    EXPECT_EQ(paint.name, "Monza gold");
    EXPECT_EQ(paint.family, "solid");
    EXPECT_EQ(paint.model, ReflectanceModel::clearcoat);
    EXPECT_EQ(paint.diffuse, glm::dvec3(0.5, 0.25, 0.125));
    EXPECT_EQ(paint.f0, glm::dvec3(0.5, 0.375, 0.25));
    EXPECT_EQ(paint.alpha, glm::dvec2(0.25, 0.125));
    EXPECT_EQ(paint.coat_alpha, 0.03125);
    EXPECT_EQ(paint.coat_f0, 0.0625);
    EXPECT_EQ(paint.coat_transmittance, glm::dvec3(1.0, 1.0, 0.75));
    EXPECT_EQ(paint.provenance, "edited in a session, from rim gold");

    EXPECT_EQ(
        document.seats,
        (std::vector<EyeSeat>{{1, {-400.0, 480.0, 900.0}}, {7, {0.5, 480.0, 1000.0}, false}}));
    EXPECT_EQ(document.eye_choice, (EyeChoice{EyeSource::seat, 7}));
    EXPECT_EQ(document.eye_mm, glm::dvec3(281.5, 425.0, 696.0));
}

TEST(OldSession, HoldsItsSettings) {
    const TemporaryFolder folder;
    const Session session = Session::open(testing::unpacked_old_files(folder) / "session.livery");
    const Document& document = session.document();
    EXPECT_EQ(document.product, "car");
    EXPECT_EQ(document.exposure_ev, -0.375);
    EXPECT_EQ(document.quality, Quality::draft);
    ASSERT_TRUE(document.levels);
    EXPECT_EQ(*document.levels,
              parse_levels("sub-samples=16,shadows=sharp,environment=filtered,occlusion=16 rays,"
                           "mirrored-environment=320 nodes,reflected-occlusion=rays,"
                           "interreflection=none,glints=counted,film=interference,relief=tilted,"
                           "subsurface=gather",
                           *document.levels));
    EXPECT_EQ(document.bench, "led");
    EXPECT_EQ(document.calibration, "/srv/livery/calibration");
    EXPECT_EQ(document.design_white_percentile, 35.5);
    EXPECT_EQ(document.gamut_mapping, GamutMapping::preserve);
    EXPECT_EQ(session.workspace(),
              (Workspace{{"left-width", "15.50"},
                         {"projector-monitor", "DUMMY1"},
                         {"right-width", "26.50"},
                         {"shown-look", "6"},
                         {"view", "preview"},
                         {"window", "1280x1200+0+0"}}));
}

TEST(OldSession, CanStillBeDrawn) {
    const TemporaryFolder folder;
    const Session session = Session::open(testing::unpacked_old_files(folder) / "session.livery");
    const Document& document = session.document();
    EXPECT_EQ(drawing_problems(document), std::vector<std::string>{});
    const auto product = find_product(document.product);
    for (const SessionLook& look : document.looks) {
        const Scene scene = scene_of(document, look.id, product);
        EXPECT_EQ(scene.exposure_ev, -0.375) << look.look.name;
    }
}

TEST(OldSession, KeepsItsWholeHistoryWhenItIsSavedAgain) {
    const TemporaryFolder folder;
    const auto file = testing::unpacked_old_files(folder) / "session.livery",
               again = folder / "again.livery";
    History before;
    std::string document;
    Workspace workspace;
    {
        Session session = Session::open(file);
        document = text_of(session.document());
        workspace = session.workspace();
        EXPECT_EQ(session.undo_label(), "Set design white to 35.5 %");
        EXPECT_EQ(session.redo_label(), "Set exposure to 1.5 EV");
        before = history_of(session);
        EXPECT_EQ(text_of(session.document()), document);
        session.save_as(again);
    }
    ASSERT_EQ(before.size(), 26u);
    EXPECT_EQ(before[1].first, "Use calibration calibration");
    EXPECT_EQ(before[4].first, "Rename paint rim gold to Monza gold");
    EXPECT_EQ(before[25].first, "Delete look blue metallic");
    for (const auto& saved : {file, again}) {
        Session session = Session::open(saved);
        EXPECT_EQ(text_of(session.document()), document) << saved;
        EXPECT_EQ(session.workspace(), workspace) << saved;
        EXPECT_EQ(history_of(session), before) << saved;
        // It goes on.
        session.execute(RenameLook{1, "newer"});
    }
    for (const auto& saved : {file, again}) {
        SessionFile(saved, SessionFile::Access::read).check_all();
        Session session = Session::open(saved);
        EXPECT_EQ(find_look(session.document(), 1)->look.name, "newer");
        session.undo();
        EXPECT_EQ(text_of(session.document()), document) << saved;
    }
}

}  // namespace
}  // namespace livery
