// The ballot panel's page on which people vote, or the operator types their ballots in.
#include <algorithm>
#include <cctype>
#include <cfloat>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/utf8.h"
#include "studio/looks/look_thumbnails.h"
#include "studio/presenting/ballot_panel.h"
#include "studio/presenting/presenting.h"
#include "studio/studio.h"

namespace livery {

using Page = BallotPanelState::Page;

void read_rounds(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    attempted(state, [&] {
        state.others_changes = studio.ballots->others_changes();
        state.rounds = studio.ballots->rounds();
    });
}

void go_to(BallotPanelState& state, Page page) {
    state.page = page;
    state.problem.clear();
    state.asking_to_close = false;
    state.to_top = true;
    if (page == Page::vote) {
        state.evaluator.clear();
        state.ballot = {};
    }
}

std::string count_of(int ballots) {
    return ballots == 1 ? "1 ballot" : fmt::format("{} ballots", ballots);
}

ImVec2 ballot_thumbnail_size(float share) {
    return {std::floor(share * em(8.0f)), std::floor(share * em(5.0f))};
}

namespace {

/// Keys A, B, ... choose the best, then the second best and, where it is asked for, the least
/// liked; Backspace takes back.
void follow_letter_keys(Ballot& ballot, std::size_t designs, bool asks_least) {
    if (ImGui::GetIO().WantTextInput) return;
    for (const ImWchar typed : ImGui::GetIO().InputQueueCharacters) {
        const int lower = typed < 128 ? std::tolower(static_cast<int>(typed)) : 0;
        if (lower < 'a' || lower > 'z') continue;
        const int design = lower - 'a';
        if (static_cast<std::size_t>(design) >= designs) continue;
        if (ballot.best < 0) {
            ballot.best = design;
        } else if (ballot.best != design && (!asks_least || ballot.second < 0)) {
            ballot.second = design;
        } else if (asks_least && ballot.best != design && ballot.second != design) {
            ballot.least = design;
        }
    }
    if (was_pressed(ImGuiKey_Backspace)) {
        (ballot.least >= 0 ? ballot.least : ballot.second >= 0 ? ballot.second : ballot.best) = -1;
    }
}

void draw_choice(Ballot& ballot,
                 int& choice,
                 std::size_t design,
                 const char* label,
                 const char* name,
                 float width) {
    const int index = static_cast<int>(design);
    const bool on = choice == index;
    ImGui::PushID(name);
    if (named(toggle_button(label, on, width), fmt::format("ballot:{}:{}", name, design))) {
        if (on) {
            choice = -1;
        } else {
            // One look cannot be two of them.
            for (int* other : {&ballot.best, &ballot.second, &ballot.least}) {
                if (*other == index) *other = -1;
            }
            choice = index;
        }
    }
    ImGui::PopID();
}

/// The picture of a design; a click shows the look on the mock-up.
void draw_picture(Studio& studio, const std::string& name, std::size_t design) {
    const ImVec2 size = ballot_thumbnail_size(), corner = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::InvisibleButton("picture", size);
    name_last_item(fmt::format("ballot:picture:{}", design));
    const bool hovered = ImGui::IsItemHovered();
    draw_look_thumbnail(studio, name, corner, size);
    const SessionLook* look = look_named(studio.session.document(), name);
    const bool shown = look && look->id == studio.shown_look && !is_presenting(studio);
    tooltip(is_presenting(studio) ? "The projector is the presentation's."
            : !look               ? "The session has no look of this name any more."
            : shown               ? "On the mock-up now."
                                  : "Click to show it on the mock-up.");
    if (shown || (look && hovered)) {
        ImGui::GetWindowDrawList()->AddRect(
            corner,
            {corner.x + size.x, corner.y + size.y},
            ImGui::GetColorU32(shown ? colours::text : colours::dim_text),
            em(0.2f),
            0,
            std::max(1.5f, em(0.12f)));
    }
    if (clicked && look && !is_presenting(studio)) {
        stop_trying(studio);
        show_look(studio, look->id);
    }
}

/// Its letter, large, and its name.
void draw_title(const std::string& name, std::size_t design, float width) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImFont& font = *large_font();
    const std::string mark = design_letter(design);
    const float indent = std::max(
        em(1.7f), font.CalcTextSizeA(font.FontSize, FLT_MAX, 0.0f, mark.c_str()).x + em(0.5f));
    const float height = 2.0f * ImGui::GetTextLineHeight() + em(0.3f);
    const ImU32 colour = ImGui::GetColorU32(colours::text);
    list.AddText(&font, font.FontSize, corner, colour, mark.c_str());
    const auto lines = fitted_lines(name, width - indent, 2);
    float y = corner.y + (lines.size() < 2 ? 0.5f * (font.FontSize - ImGui::GetFontSize()) : 0.0f);
    for (const std::string& line : lines) {
        list.AddText({corner.x + indent, y}, colour, line.c_str());
        y += ImGui::GetTextLineHeight() + em(0.1f);
    }
    ImGui::Dummy({width, height});
    tooltip(name);
}

void draw_designs(Studio& studio, const Round& round) {
    Ballot& ballot = studio.panels.of<BallotPanelState>().ballot;
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    for (std::size_t i = 0; i < round.designs.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        draw_picture(studio, round.designs[i], i);
        ImGui::SameLine();
        ImGui::BeginGroup();
        const float width = ImGui::GetContentRegionAvail().x;
        // Who votes on what was presented knows codes, and so do phones.
        const std::string code = fmt::format("{}", round.codes[i]);
        const bool phones =
            presenting(studio).phones || !phones_in(presenting(studio).seats).empty();
        draw_title(is_presenting(studio) ? code
                   : phones              ? code + "  " + round.designs[i]
                                         : round.designs[i],
                   i,
                   width);
        const float places = round.asks_least ? 3.0f : 2.0f;
        const float each = std::floor((width - (places - 1.0f) * gap) / places);
        const bool room = each >= button_width("Second best");
        draw_choice(ballot, ballot.best, i, "Best", "best", each);
        ImGui::SameLine(0.0f, gap);
        draw_choice(ballot, ballot.second, i, room ? "Second best" : "Second", "second", each);
        if (round.asks_least) {
            ImGui::SameLine(0.0f, gap);
            draw_choice(ballot, ballot.least, i, "Least", "least", each);
        }
        ImGui::EndGroup();
        ImGui::Dummy({0.0f, em(0.1f)});
        ImGui::PopID();
    }
}

void draw_closing(Studio& studio, const Round& round) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    // What is presented is locked where it is presented, in the bar.
    if (is_presenting(studio)) {
        if (button("Who has voted", "ballot:overview")) go_to(state, Page::start);
        return;
    }
    if (!state.asking_to_close) {
        if (button("Close the round…", "ballot:close", "Ends the vote and shows the result."))
            state.asking_to_close = true;
        return;
    }
    warning_text(
        fmt::format("Close round {} for good? Nobody can vote in it afterwards; then the "
                    "result shows.",
                    round.id));
    const int id = round.id;
    if (button("Close the round", "ballot:close-confirmed")) {
        if (attempted(state, [&] { studio.ballots->close_round(id); })) {
            read_rounds(studio);
            go_to(state, Page::result);
            state.shown_round = id;
        }
    }
    ImGui::SameLine();
    if (button("Keep it open", "ballot:keep-open")) state.asking_to_close = false;
}

void confirm(Studio& studio, const Round& round) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    const int id = round.id;
    if (!attempted(state, [&] { studio.ballots->vote(id, state.evaluator, state.ballot); })) return;
    read_rounds(studio);
    state.thanked = trimmed(state.evaluator);
    go_to(state, Page::thanks);
}

}  // namespace

void draw_vote(Studio& studio, const Round& round) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    heading(fmt::format("Round {}: your ballot", round.id).c_str());
    row_label("Your name", 0.25f);
    if (std::exchange(state.focus_name, false)) focus_next_field("##name");
    ImGui::SetNextItemWidth(-1.0f);
    named(ImGui::InputTextWithHint("##name", "Enter to type it", &state.evaluator), "ballot:name");
    // Enter leaves the field, which is no confirmation yet.
    const bool was_typing = ImGui::IsItemActive() || ImGui::IsItemDeactivated();
    tooltip("One ballot a person: a second one under the same name replaces the first.");
    ImGui::Spacing();
    draw_designs(studio, round);
    follow_letter_keys(state.ballot, round.designs.size(), round.asks_least);
    dim_text(
        fmt::format("Keys A to {} choose the best, then the second best{}; Backspace takes "
                    "back.{}",
                    design_letter(std::min(round.designs.size(), kLetters) - 1),
                    round.asks_least ? ", then the least liked, which may be left out" : "",
                    is_presenting(studio) ? ""
                                          : " 1, 2, 3 … show looks on the mock-up; black is "
                                            "Ctrl+B, freeze Ctrl+F."));

    const bool named = state.evaluator.find_first_not_of(' ') != std::string::npos;
    const bool complete = named && state.ballot.best >= 0 && state.ballot.second >= 0;
    begin_disabled(!complete);
    const bool pressed = ImGui::Button("Confirm the ballot", {-FLT_MIN, em(2.4f)});
    name_last_item("ballot:confirm");
    end_disabled();
    if (!complete) {
        dim_text(!named                    ? "Missing: your name."
                 : state.ballot.best < 0   ? "Missing: the best look."
                 : state.ballot.second < 0 ? "Missing: the second best look."
                                           : "");
    }
    ImGui::Spacing();
    ImGui::Separator();
    // Nothing is drawn from `round` after these: both read the rounds anew.
    const bool enter = was_pressed(ImGuiKey_Enter) && !was_typing && !ImGui::GetIO().NavVisible;
    if (enter && !named) state.focus_name = true;
    if (complete && (pressed || enter)) {
        confirm(studio, round);
    } else {
        draw_closing(studio, round);
    }
}

void draw_thanks(Studio& studio, const Round& round) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    ImGui::PushFont(large_font());
    ImGui::TextWrapped("Thank you, %s.", state.thanked.c_str());
    ImGui::PopFont();
    name_last_item("ballot:thanks");
    // As it is now: `round` may be of when its phase began.
    const auto now = std::find_if(state.rounds.begin(), state.rounds.end(), [&](const Round& one) {
        return one.id == round.id;
    });
    ImGui::Text("%s in round %d.",
                count_of(now == state.rounds.end() ? round.ballots : now->ballots).c_str(),
                round.id);
    ImGui::Spacing();
    const bool next = named(ImGui::Button("Next ballot", {-FLT_MIN, em(2.4f)}), "ballot:next");
    if (next || was_pressed(ImGuiKey_Enter)) {
        go_to(state, Page::vote);
        return;
    }
    ImGui::Spacing();
    ImGui::Separator();
    draw_closing(studio, round);
}

}  // namespace livery
