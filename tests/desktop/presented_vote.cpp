#include "desktop/presented_vote.h"

#include <algorithm>

#include "evaluation/phone_page.h"

namespace livery {

using namespace std::chrono_literals;

void PresentedVote::start_vote(const std::string& settings, std::size_t looks) {
    start_at_home(settings);
    pick_projector();
    program->click("menu:File");
    program->click("menu:ballot");
    bar_left_ = program->item("vote-segment").x;
    for (std::size_t place = looks; place < document.looks.size(); ++place) {
        program->click("ballot:look:" + std::to_string(look_at_place(place)));
    }
}

void PresentedVote::present_paused() {
    // What looks were ticked changes the sentences above the button, and where it is.
    const int frame = program->state("frame");
    wait_until([&] { return program->state("frame") >= frame + 3; }, 20s);
    const auto before = static_cast<std::ptrdiff_t>(program->trace().size());
    program->click("ballot:present");
    program->wait_for_state("vote", "adapting");
    // The look that was there went at once: nobody looks at it while all are frozen.
    const std::vector<TraceLine> trace = program->trace();
    const auto first = std::find_if(trace.begin() + before, trace.end(), [](const TraceLine& line) {
        return line.event == "vote-picture";
    });
    ASSERT_NE(first, trace.end());
    EXPECT_EQ(first->what, "grey");
    program->press_key("space");
    program->wait_for_state("vote_paused", true);
    program->wait_for_state("vote_loaded", true);
    load_frames();
}

void PresentedVote::load_frames() {
    const BallotStore store(home / "ballots.sqlite");
    const auto found = store.presented();
    ASSERT_TRUE(found);
    presented = *found;
    frames = read_vote_frames(home / presented.plan.folder, presented.plan.frames);
}

std::string PresentedVote::let_phones_vote() {
    program->click("phones:start");
    const BallotStore store(home / "ballots.sqlite");
    std::string url;
    wait_until(
        [&] {
            url = program->state("phones");
            return !url.empty() && store.session() && store.invitation(*store.session());
        },
        60s);
    EXPECT_TRUE(url.starts_with("http://127.0.0.1:")) << url;
    // The panel scrolls to the code when it comes: what is clicked next has moved.
    if (program->state("vote") == "edit") {
        program->item("phones:qr");
        const int frame = program->state("frame");
        wait_until([&] { return program->state("frame") >= frame + 3; }, 20s);
    }
    return url + "join/" + store.invitation(store.session().value()).value().token;
}

::testing::AssertionResult PresentedVote::projector_shows_frame(const std::string& name) {
    const Image8& frame = *frames.at(name);
    std::string why;
    const bool shown = wait_until(
        [&] {
            Image8 seen = projector_picture();
            int coloured = 0;
            for (std::size_t i = 0; i < seen.pixel_count(); ++i) {
                std::uint8_t* at = &seen.values[3 * i];
                const std::uint8_t* of = &frame.values[3 * i];
                if (of[0] != 0 || of[1] != 0 || of[2] != 0) continue;
                if (at[0] != at[1] || at[1] != at[2]) ++coloured;
                at[0] = at[1] = at[2] = 0;
            }
            why = coloured > 0 ? std::to_string(coloured) + " coloured pixels beside it" : "";
            return coloured == 0 && hash_of(seen) == presented.plan.frames.at(name);
        },
        20s);
    if (shown) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << name << " is not shown. " << why << " state: " << program->state("vote") << " "
           << program->state("vote_frame") << " seen: " << saved(projector_picture(), "seen");
}

int PresentedVote::lit_beside() {
    const Image8 seen = projector_picture();
    int lit = 0;
    for (std::size_t i = 0; i < seen.pixel_count(); ++i) {
        const auto is_lit = [&](const Image8& picture) {
            const std::uint8_t* at = &picture.values[3 * i];
            return at[0] != 0 || at[1] != 0 || at[2] != 0;
        };
        if (!is_lit(seen)) continue;
        const bool beside = std::none_of(
            frames.begin(), frames.end(), [&](const auto& frame) { return is_lit(*frame.second); });
        lit += beside ? 1 : 0;
    }
    return lit;
}

double PresentedVote::brightness(const std::string& name) const {
    double sum = 0.0, lit = 0.0;
    for (const std::uint8_t value : frames.at(name)->values) {
        sum += value;
        lit += value > 0 ? 1.0 : 0.0;
    }
    return sum / std::max(lit, 1.0);
}

PresentedVote::Segment PresentedVote::filled_segment() {
    const Rectangle at = program->item("vote-segment");
    // Above its word, where nothing but the fill is.
    const Rgb colour = desktop->pixel(at.x + at.width / 2, at.y + 4);
    return {(at.x - bar_left_.value() + at.width / 2) / at.width, colour};
}

}  // namespace livery
