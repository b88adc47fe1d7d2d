// Votes on looks: a round is opened, people vote one after another, and nothing is told before it
// is closed. A panel: the looks go on being shown on the mock-up meanwhile.
#include "studio/presenting/ballot_panel.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include <imgui.h>

#include "core/paths.h"
#include "evaluation/presentation_order.h"
#include "studio/looks/look_thumbnails.h"
#include "studio/presenting/presenting.h"
#include "studio/presenting/round_files.h"
#include "studio/seats/seats_panel.h"
#include "studio/studio.h"

namespace livery {

const Round* open_round(const BallotPanelState& state) {
    const auto found = std::find_if(state.rounds.begin(),
                                    state.rounds.end(),
                                    [](const Round& round) { return !round.closed(); });
    return found == state.rounds.end() ? nullptr : &*found;
}

namespace {

using Page = BallotPanelState::Page;

/// What phones and other programs have done to the file meanwhile.
void follow_others(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    try {
        if (studio.ballots->others_changes() != state.others_changes) read_rounds(studio);
    } catch (const FileError& error) {
        state.problem = error.what();
    }
}

// --- starting a round ---

void draw_looks_to_choose(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    for (const SessionLook& look : studio.session.document().looks) {
        bool& chosen = state.chosen_looks.try_emplace(look.id, true).first->second;
        ImGui::PushID(look.id);
        const ImVec2 size = ballot_thumbnail_size(0.45f);
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        draw_look_thumbnail(studio, look.look.name, corner, size);
        ImGui::Dummy(size);
        ImGui::SameLine();
        ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 0.5f * (size.y - ImGui::GetFrameHeight()));
        const float room = ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight() -
                           ImGui::GetStyle().ItemInnerSpacing.x;
        const auto lines = fitted_lines(look.look.name, room, 1);
        ImGui::Checkbox(((lines.empty() ? "" : lines[0]) + "###chosen").c_str(), &chosen);
        name_last_item(fmt::format("ballot:look:{}", look.id));
        tooltip(look.look.name);
        ImGui::PopID();
    }
}

/// At the heading's end.
void draw_all_or_none(Studio& studio) {
    const float width = ImGui::GetFrameHeight() * 2.2f;
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 2.0f * width - gap);
    for (const bool ticked : {true, false}) {
        if (ImGui::Button(ticked ? "All" : "None", {width, 0.0f})) {
            for (const SessionLook& look : studio.session.document().looks) {
                studio.panels.of<BallotPanelState>().chosen_looks[look.id] = ticked;
            }
        }
        name_last_item(ticked ? "ballot:all-looks" : "ballot:no-looks");
        if (ticked) ImGui::SameLine(0.0f, gap);
    }
}

/// The looks that are ticked, in their order.
std::vector<int> looks_under_vote(const Studio& studio) {
    const auto& chosen = studio.panels.of<BallotPanelState>().chosen_looks;
    std::vector<int> looks;
    for (const SessionLook& look : studio.session.document().looks) {
        const auto found = chosen.find(look.id);
        if (found == chosen.end() || found->second) looks.push_back(look.id);
    }
    return looks;
}

void draw_earlier_rounds(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    heading("Earlier rounds");
    const bool any = std::any_of(state.rounds.begin(), state.rounds.end(), [](const Round& round) {
        return round.closed();
    });
    if (!any) dim_text("None yet.");
    for (auto round = state.rounds.rbegin(); round != state.rounds.rend(); ++round) {
        if (!round->closed()) continue;
        const std::string label = fmt::format("Round {} · {} · {} looks · {}",
                                              round->id,
                                              readable_time(round->created),
                                              round->designs.size(),
                                              count_of(round->ballots));
        if (named(ImGui::Selectable(label.c_str()), fmt::format("ballot:round:{}", round->id))) {
            go_to(state, Page::result);
            state.shown_round = round->id;
        }
    }
}

void draw_start(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    heading("Looks under vote");
    draw_all_or_none(studio);
    draw_looks_to_choose(studio);
    const std::vector<int> ids = looks_under_vote(studio);
    std::vector<std::string> names;
    for (const int id : ids) names.push_back(find_look(studio.session.document(), id)->look.name);
    if (names.size() < 2) dim_text("A vote needs at least two looks.");
    const bool loading = !studio.setup;
    if (!loading && !studio.setup->table) {
        warning_text("No calibration is in use: people would judge colours that are not right.");
        name_last_item("ballot:uncorrected");
    }
    draw_seats_before_vote(studio, ids);
    draw_presentation_setup(studio, ids);
    ImGui::SameLine();
    // What is voted on must be known to be corrected or not.
    begin_disabled(names.size() < 2 || loading);
    if (named(ImGui::Button("Vote at once", {-FLT_MIN, em(2.4f)}), "ballot:start")) {
        const std::string calibration =
            studio.setup->calibration ? studio.setup->calibration->id : std::string();
        RoundSetup setup{names, calibration};
        setup.asks_least = presenting_settings(studio).asks_least && names.size() > 2;
        setup.scales = scales_asked(presenting_settings(studio));
        setup.seed = presenting_settings(studio).seed.value_or(random_seed());
        if (attempted(state, [&] { studio.ballots->open_round(setup); })) {
            read_rounds(studio);
            go_to(state, Page::vote);
        }
    }
    end_disabled();
    tooltip(loading ? "The calibration is being loaded."
                    : "In this window, without a presentation: whoever votes looks at what they "
                      "like.");
    draw_phones(studio);
    ImGui::Spacing();
    draw_earlier_rounds(studio);
}

// --- the result ---

void draw_back_to_rounds(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    if (is_presenting(studio)) return;  // Back to editing, in the bar
    if (button("All rounds", "ballot:rounds"))
        go_to(state, open_round(state) ? Page::vote : Page::start);
}

void draw_result(Studio& studio, const Round& round) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    heading(fmt::format("Round {}: {}", round.id, count_of(round.ballots)).c_str());
    name_last_item("ballot:result");
    dim_text(fmt::format("Started {}, {}.",
                         readable_time(round.created),
                         round.calibration_id.empty()
                             ? std::string("shown uncorrected")
                             : "shown under calibration " + round.calibration_id.substr(0, 8)));
    if (!draw_duel(studio, round)) return draw_back_to_rounds(studio);
    VoteCounts tally;
    if (!attempted(state, [&] { tally = studio.ballots->tally(round.id); })) return;
    draw_verdict(studio, round);
    draw_tally(round, tally);
    ImGui::Spacing();
    if (button("Export as CSV…", "ballot:export")) ask_where_to_export(studio, round, tally);
    ImGui::SameLine();
    if (ImGui::Button("Write the report")) write_round_report(studio, round);
    name_last_item("ballot:report");
    tooltip("Verdict, charts, looks and log as PDF and HTML, beside the ballots.");
    if (!is_presenting(studio)) ImGui::SameLine();
    draw_back_to_rounds(studio);
}

/// While the bar above leads through a round.
void draw_presented_page(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    const auto& presented = presenting(studio).presented;
    const PresentationPhase phase = phase_of(studio);
    if (presented && phase == PresentationPhase::locked) {
        return draw_result(studio, Round(presented->round));
    }
    if (presented && phase == PresentationPhase::voting) {
        if (state.page == Page::vote) return draw_vote(studio, Round(presented->round));
        if (state.page == Page::thanks) return draw_thanks(studio, Round(presented->round));
    }
    draw_presented_round(studio);
    if (phase == PresentationPhase::voting) {
        ImGui::Spacing();
        if (ImGui::Button("Type in a ballot", {-FLT_MIN, 0.0f})) go_to(state, Page::vote);
        name_last_item("ballot:type-in");
        tooltip("From paper, or for somebody without a phone.");
    }
    draw_phones(studio);
}

/// What another panel, the bar or time have done to the rounds.
void follow_presentation(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    const int phase = is_presenting(studio) ? 1 + static_cast<int>(phase_of(studio)) : 0;
    if (std::exchange(state.presented_phase, phase) == phase) return;
    read_rounds(studio);
    go_to(state, Page::start);
}

void draw_page(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    const Round* open = open_round(state);
    if (!open && (state.page == Page::vote || state.page == Page::thanks)) {
        go_to(state, Page::start);
    }
    if (open && state.page == Page::start) go_to(state, Page::vote);
    switch (state.page) {
        case Page::start:
            draw_start(studio);
            break;
        case Page::vote:
            draw_vote(studio, Round(*open));
            // One page after the other: a ballot that was just confirmed has left this one.
            if (state.page == Page::vote) draw_phones(studio);
            break;
        case Page::thanks:
            draw_thanks(studio, Round(*open));
            break;
        case Page::result: {
            const auto shown =
                std::find_if(state.rounds.begin(), state.rounds.end(), [&](const Round& round) {
                    return round.id == state.shown_round;
                });
            if (shown == state.rounds.end()) {
                go_to(state, Page::start);
            } else {
                draw_result(studio, Round(*shown));
            }
            break;
        }
    }
}

}  // namespace

void show_ballots(Studio& studio, bool shown) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    if (std::exchange(state.open, shown) || !shown) return;
    // What the tabs were trying is not what people vote on.
    stop_trying(studio);
    if (studio.ballots) read_rounds(studio);
    go_to(state, Page::start);
}

void draw_ballot_panel(Studio& studio) {
    BallotPanelState& state = studio.panels.of<BallotPanelState>();
    if (std::exchange(state.to_top, false)) ImGui::SetScrollY(0.0f);
    const float side = ImGui::GetFrameHeight();
    heading("Ballot");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - side);
    begin_disabled(is_presenting(studio));
    if (ImGui::Button("×##close-ballot", {side, 0.0f})) show_ballots(studio, false);
    end_disabled();
    name_last_item("ballot:close-panel");
    tooltip("Back to the paints. An open round stays open.");
    if (!studio.ballots) {
        warning_text("Ballots cannot be kept: the ballot file could not be opened.");
    } else {
        follow_others(studio);
        follow_presentation(studio);
        if (is_presenting(studio)) {
            draw_presented_page(studio);
        } else {
            draw_page(studio);
        }
    }
    if (!state.problem.empty()) {
        warning_text(state.problem);
        name_last_item("ballot:problem");
    }
}

std::size_t ballot_letters(const Studio& studio) {
    const BallotPanelState& state = studio.panels.of<BallotPanelState>();
    const Round* round = open_round(state);
    // Until the next voter begins, the last one's letters mean nothing else either.
    const bool votes =
        state.open && round && (state.page == Page::vote || state.page == Page::thanks);
    return votes ? std::min(round->designs.size(), kLetters) : 0;
}

// --- what a round of votes came to, and where it goes ---

std::string design_letter(std::size_t design) {
    return design < kLetters ? std::string(1, static_cast<char>('A' + design))
                             : fmt::format("{}", design + 1);
}

namespace {

/// Nothing of it is drawn where it is scrolled out of sight.
void draw_counts(const VoteCounts& tally) {
    // As many columns as fit share the width; more are scrolled to.
    constexpr std::size_t shared = 10, most = 62;
    const std::size_t designs = std::min(tally.best.size(), most);
    const bool scrolls = designs > shared;
    const float row_height = ImGui::GetTextLineHeight() + 2.0f * ImGui::GetStyle().CellPadding.y;
    const float height = scrolls ? (tally.least.empty() ? 3.0f : 4.0f) * row_height +
                                       ImGui::GetStyle().ScrollbarSize + em(0.4f)
                                 : 0.0f;
    const ImGuiTableFlags flags =
        ImGuiTableFlags_Borders | ImGuiTableFlags_RowBg |
        (scrolls ? ImGuiTableFlags_ScrollX | ImGuiTableFlags_SizingFixedFit
                 : ImGuiTableFlags_SizingStretchSame);
    if (!ImGui::BeginTable("result", static_cast<int>(designs) + 1, flags, {0.0f, height})) return;
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, em(6.0f));
    if (scrolls) ImGui::TableSetupScrollFreeze(1, 1);
    const auto row = [&](const char* label, auto&& cell) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(label);
        for (std::size_t i = 0; i < designs; ++i) {
            if (!ImGui::TableNextColumn()) continue;
            ImGui::TextUnformatted(cell(i).c_str());
        }
    };
    row("", [](std::size_t i) { return design_letter(i); });
    row("Best", [&](std::size_t i) { return fmt::format("{}", tally.best[i]); });
    row("Second best", [&](std::size_t i) { return fmt::format("{}", tally.second[i]); });
    if (!tally.least.empty()) {
        row("Least liked", [&](std::size_t i) { return fmt::format("{}", tally.least[i]); });
    }
    ImGui::EndTable();
}

}  // namespace

void draw_tally(const Round& round, const VoteCounts& tally) {
    draw_counts(tally);
    for (std::size_t i = 0; i < round.designs.size(); ++i) {
        ImGui::TextWrapped(
            "%s  %d  %s", design_letter(i).c_str(), round.codes[i], round.designs[i].c_str());
    }
}

void ask_where_to_export(Studio& studio, const Round& round, const VoteCounts& tally) {
    if (!studio.file_dialog) return;
    studio.file_dialog->ask(
        {.kind = FileQuestion::Kind::save,
         .title = "Export the result",
         .action = "Export",
         .suffixes = {".csv"},
         .suggested = fmt::format("round-{}.csv", round.id),
         .then = [&studio, designs = round.designs, tally](const std::filesystem::path& file) {
             try {
                 write_text_file(file, tally_csv(designs, tally));
                 tell_info(studio, "The result was exported.", "", file.string() + ".");
             } catch (const FileError& error) {
                 tell_error(studio, "The result was not exported.", error.what());
             }
         }});
}

namespace {

/// What seats miss is found out for the looks that are voted on.
void ask_for_seats(Studio& studio) {
    SeatsPanelState& seats = studio.panels.of<SeatsPanelState>();
    const bool chooses = studio.panels.of<BallotPanelState>().open && !seats.open;
    seats.judged_looks = is_presenting(studio) ? looks_to_record(studio)
                         : chooses             ? looks_under_vote(studio)
                                               : std::vector<int>();
    record_seat_errors(studio);
}

}  // namespace

Panel ballot_panel() {
    return {
        .name = "ballot",
        .place = PanelPlace::column,
        .draw = draw_ballot_panel,
        .is_open = [](const Studio& s) { return s.panels.of<BallotPanelState>().open; },
        .show = show_ballots,
        .step = ask_for_seats,
        .letters = ballot_letters,
        .actions = [] { return std::vector{panel_action("ballot", "ballot", "File", "Ballot")}; }};
}

}  // namespace livery
