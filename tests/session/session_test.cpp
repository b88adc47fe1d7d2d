// The session: its commands, its history, its file.

#include "session/session.h"

#include <cmath>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

const Document& car() {
    static const Document document = new_document("car");
    return document;
}

TEST(NewDocument, HoldsTheShippedLooksAsTheDefaultBenchSeesThem) {
    const Document& document = car();
    ASSERT_EQ(document.looks.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(document.looks[k].id, static_cast<int>(k) + 1);
        EXPECT_EQ(document.looks[k].look.exposure_ev, 0.0);
        EXPECT_TRUE(document.looks[k].look.file.empty());
    }
    EXPECT_EQ(document.next_look_id, 5);
    EXPECT_EQ(document.exposure_ev, -0.15);
    EXPECT_EQ(document.eye_mm, glm::dvec3(281, 425, 696));
}

TEST(Session, KeepsEverythingOverAReopening) {
    const TemporaryFolder folder;
    const auto file = folder / "Größe und Länge.livery";
    std::string last;
    {
        Session session = Session::open(file);
        EXPECT_FALSE(session.can_undo());
        session.execute(SetPaint{1, "body", "Solid-Red"});
        session.execute(DeleteLook{2});
        EXPECT_EQ(session.undo_label(), "Delete look silver metallic");
        EXPECT_EQ(session.undo(), 2);
        EXPECT_EQ(session.redo_label(), "Delete look silver metallic");
        session.set_workspace("look", "3");
        EXPECT_EQ(session.save_problem(), std::nullopt);
        last = text_of(session.document());
    }
    Session session = Session::open(file);
    EXPECT_EQ(text_of(session.document()), last);
    EXPECT_EQ(session.undo_label(), "Paint body solid red");
    EXPECT_EQ(session.redo_label(), "Delete look silver metallic");
    EXPECT_EQ(session.workspace().at("look"), "3");
    EXPECT_EQ(session.undo(), 1);
    EXPECT_EQ(text_of(session.document()), text_of(car()));
    EXPECT_FALSE(session.can_undo());
}

}  // namespace
}  // namespace livery
