// Votes on looks: a round is opened, people vote one after another, and nothing is told before it
// is closed.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/error.h"
#include "core/paths.h"
#include "evaluation/tally.h"
#include "studio/studio.h"
#include "studio/theme.h"
#include "studio/widgets.h"
#include "studio/words.h"

namespace livery {

namespace {

constexpr const char* kTitle = "Ballots";
using Page = BallotDialogState::Page;

/// "(a)", "(b)", ..., "(z)", "(27)".
std::string letter(std::size_t design) {
    return design < 26 ? fmt::format("({})", static_cast<char>('a' + design))
                       : fmt::format("({})", design + 1);
}

float big_height() { return em(2.4f); }

/// Runs what the store may refuse and keeps the reason for the operator.
template <typename Work>
bool attempted(BallotDialogState& state, Work&& work) {
    state.problem.clear();
    try {
        work();
        return true;
    } catch (const Refused& refused) {
        state.problem = fmt::format("{}. {}.", refused.why(), refused.fix());
    } catch (const std::exception& error) {
        state.problem = error.what();
    }
    return false;
}

void read_rounds(Studio& studio) {
    BallotDialogState& state = studio.panels.ballot;
    attempted(state, [&] { state.rounds = studio.ballots->rounds(); });
}

const Round* open_round(const BallotDialogState& state) {
    const auto found = std::find_if(
        state.rounds.begin(), state.rounds.end(), [](const Round& round) { return !round.closed; });
    return found == state.rounds.end() ? nullptr : &*found;
}

void go_to(BallotDialogState& state, Page page) {
    state.page = page;
    state.problem.clear();
    state.asking_to_close = false;
    if (page == Page::vote) {
        state.evaluator.clear();
        state.best.reset();
        state.second.reset();
        state.focus_name = true;
    }
}

std::string count_of(int ballots) {
    return ballots == 1 ? "1 ballot" : fmt::format("{} ballots", ballots);
}

// --- starting a round ---

void draw_looks_to_choose(Studio& studio) {
    BallotDialogState& state = studio.panels.ballot;
    for (const SessionLook& look : studio.session.document().looks) {
        bool& chosen = state.chosen_looks.try_emplace(look.id, true).first->second;
        ImGui::PushID(look.id);
        ImGui::Checkbox(look.look.name.c_str(), &chosen);
        name_last_item(fmt::format("ballot:look:{}", look.id));
        ImGui::PopID();
    }
}

std::vector<std::string> chosen_names(const Studio& studio) {
    std::vector<std::string> names;
    for (const SessionLook& look : studio.session.document().looks) {
        const auto chosen = studio.panels.ballot.chosen_looks.find(look.id);
        if (chosen != studio.panels.ballot.chosen_looks.end() && chosen->second) {
            names.push_back(look.look.name);
        }
    }
    return names;
}

void draw_earlier_rounds(Studio& studio) {
    BallotDialogState& state = studio.panels.ballot;
    heading("Earlier rounds");
    const bool any = std::any_of(
        state.rounds.begin(), state.rounds.end(), [](const Round& round) { return round.closed; });
    if (!any) dim_text("None yet.");
    for (auto round = state.rounds.rbegin(); round != state.rounds.rend(); ++round) {
        if (!round->closed) continue;
        const std::string label = fmt::format("Round {} · {} · {} looks · {}",
                                              round->id,
                                              readable_time(round->created),
                                              round->designs.size(),
                                              count_of(round->ballots));
        if (ImGui::Selectable(label.c_str())) {
            go_to(state, Page::result);
            state.shown_round = round->id;
        }
        name_last_item(fmt::format("ballot:round:{}", round->id));
    }
}

void draw_start(Studio& studio) {
    BallotDialogState& state = studio.panels.ballot;
    heading("Looks under vote");
    draw_looks_to_choose(studio);
    const auto names = chosen_names(studio);
    if (names.size() < 2) dim_text("A vote needs at least two looks.");
    if (!studio.setup || !studio.setup->table) {
        warning_text("No calibration is in use: people would judge colours that are not right.");
    }
    begin_disabled(names.size() < 2);
    if (ImGui::Button("Start the round", {-FLT_MIN, big_height()})) {
        const std::string calibration = studio.setup && studio.setup->calibration
                                            ? studio.setup->calibration->id
                                            : std::string();
        if (attempted(state, [&] { studio.ballots->open_round(names, calibration); })) {
            read_rounds(studio);
            go_to(state, Page::vote);
        }
    }
    name_last_item("ballot:start");
    end_disabled();
    ImGui::Spacing();
    draw_earlier_rounds(studio);
}

// --- voting ---

/// Keys 1, 2, ... choose the best, then the second best; Backspace takes back.
void follow_number_keys(BallotDialogState& state, std::size_t designs) {
    if (ImGui::GetIO().WantTextInput) return;
    for (const ImWchar typed : ImGui::GetIO().InputQueueCharacters) {
        if (typed < '1' || typed > '9') continue;
        const int design = static_cast<int>(typed) - '1';
        if (static_cast<std::size_t>(design) >= designs) continue;
        if (!state.best) {
            state.best = design;
        } else if (state.best != design) {
            state.second = design;
        }
    }
    if (was_pressed(ImGuiKey_Backspace)) (state.second ? state.second : state.best).reset();
}

void draw_choice(std::optional<int>& choice,
                 std::optional<int>& other,
                 std::size_t design,
                 const char* label,
                 const char* name,
                 float width) {
    const int index = static_cast<int>(design);
    const bool on = choice == index;
    ImGui::PushID(name);
    ImGui::PushStyleVar(
        ImGuiStyleVar_FramePadding,
        {ImGui::GetStyle().FramePadding.x, 0.5f * (big_height() - ImGui::GetFontSize())});
    if (toggle_button(label, on, width)) {
        if (on) {
            choice.reset();
        } else {
            choice = index;
            // One look cannot be both.
            if (other == index) other.reset();
        }
    }
    name_last_item(fmt::format("ballot:{}:{}", name, design));
    ImGui::PopStyleVar();
    ImGui::PopID();
}

void draw_designs(BallotDialogState& state, const Round& round) {
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float button = std::max(em(6.5f), button_width("Second best"));
    const float text = ImGui::GetContentRegionAvail().x - 2.0f * (button + gap);
    for (std::size_t i = 0; i < round.designs.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const auto lines =
            fitted_lines(fmt::format("{} {}", letter(i), round.designs[i]), text - gap, 2);
        float y = corner.y + 0.5f * (big_height() - ImGui::GetFontSize() * 1.15f *
                                                        static_cast<float>(lines.size()));
        for (const std::string& line : lines) {
            ImGui::GetWindowDrawList()->AddText(
                {corner.x, y}, ImGui::GetColorU32(colours::text), line.c_str());
            y += ImGui::GetFontSize() * 1.15f;
        }
        ImGui::Dummy({text, big_height()});
        tooltip(round.designs[i]);
        ImGui::SameLine(0.0f, gap);
        draw_choice(state.best, state.second, i, "Best", "best", button);
        ImGui::SameLine(0.0f, gap);
        draw_choice(state.second, state.best, i, "Second best", "second", button);
        ImGui::PopID();
    }
}

void draw_closing(Studio& studio, const Round& round) {
    BallotDialogState& state = studio.panels.ballot;
    if (!state.asking_to_close) {
        if (ImGui::Button("Close the round…")) state.asking_to_close = true;
        name_last_item("ballot:close");
        tooltip("Ends the vote and shows the result.");
        return;
    }
    warning_text(
        fmt::format("Close round {} for good? Nobody can vote in it afterwards; then the "
                    "result shows.",
                    round.id));
    const int id = round.id;
    if (ImGui::Button("Close the round")) {
        if (attempted(state, [&] { studio.ballots->close_round(id); })) {
            read_rounds(studio);
            go_to(state, Page::result);
            state.shown_round = id;
        }
    }
    name_last_item("ballot:close-confirmed");
    ImGui::SameLine();
    if (ImGui::Button("Keep it open")) state.asking_to_close = false;
    name_last_item("ballot:keep-open");
}

void confirm(Studio& studio, const Round& round) {
    BallotDialogState& state = studio.panels.ballot;
    const int id = round.id;
    const Ballot ballot{state.evaluator, *state.best, *state.second};
    if (!attempted(state, [&] { studio.ballots->vote(id, ballot); })) return;
    read_rounds(studio);
    state.thanked = state.evaluator;
    go_to(state, Page::thanks);
}

void draw_vote(Studio& studio, const Round& round) {
    BallotDialogState& state = studio.panels.ballot;
    heading(fmt::format("Round {}: your ballot", round.id).c_str());
    row_label("Your name", 0.25f);
    if (std::exchange(state.focus_name, false)) ImGui::SetKeyboardFocusHere();
    ImGui::InputText("##name", &state.evaluator);
    name_last_item("ballot:name");
    tooltip("One ballot a person: a second one under the same name replaces the first.");
    ImGui::Spacing();
    draw_designs(state, round);
    follow_number_keys(state, round.designs.size());
    dim_text("Keys 1, 2, 3 … choose the best, then the second best; Backspace takes back.");

    const bool named = state.evaluator.find_first_not_of(' ') != std::string::npos;
    const bool complete = named && state.best && state.second;
    begin_disabled(!complete);
    const bool pressed = ImGui::Button("Confirm the ballot", {-FLT_MIN, big_height()});
    name_last_item("ballot:confirm");
    end_disabled();
    if (!complete) {
        dim_text(!named          ? "Missing: your name."
                 : !state.best   ? "Missing: the best look."
                 : !state.second ? "Missing: the second best look."
                                 : "");
    }
    ImGui::Spacing();
    ImGui::Separator();
    // Nothing is drawn from `round` after these: both read the rounds anew.
    const bool enter = was_pressed(ImGuiKey_Enter) && !ImGui::GetIO().WantTextInput;
    if (complete && (pressed || enter)) {
        confirm(studio, round);
    } else {
        draw_closing(studio, round);
    }
}

void draw_thanks(Studio& studio, const Round& round) {
    BallotDialogState& state = studio.panels.ballot;
    ImGui::PushFont(large_font());
    ImGui::TextWrapped("Thank you, %s.", state.thanked.c_str());
    ImGui::PopFont();
    name_last_item("ballot:thanks");
    ImGui::Text("%s in round %d.", count_of(round.ballots).c_str(), round.id);
    ImGui::Spacing();
    if (ImGui::Button("Next ballot", {-FLT_MIN, big_height()}) || was_pressed(ImGuiKey_Enter)) {
        go_to(state, Page::vote);
        return;
    }
    name_last_item("ballot:next");
    ImGui::Spacing();
    ImGui::Separator();
    draw_closing(studio, round);
}

// --- the result ---

void draw_table(const Tally& tally) {
    // As many columns as fit share the width; more are scrolled to.
    constexpr std::size_t shared = 10, most = 62;
    const std::size_t designs = std::min(tally.designs.size(), most);
    const bool scrolls = designs > shared;
    const float row_height = ImGui::GetTextLineHeight() + 2.0f * ImGui::GetStyle().CellPadding.y;
    const float height =
        scrolls ? 3.0f * row_height + ImGui::GetStyle().ScrollbarSize + em(0.4f) : 0.0f;
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
    row("", [](std::size_t i) { return letter(i); });
    row("Best", [&](std::size_t i) { return fmt::format("{}", tally.best[i]); });
    row("Second best", [&](std::size_t i) { return fmt::format("{}", tally.second[i]); });
    ImGui::EndTable();
    for (std::size_t i = 0; i < tally.designs.size(); ++i) {
        ImGui::TextWrapped("%s %s", letter(i).c_str(), tally.designs[i].c_str());
    }
}

void ask_where_to_export(Studio& studio, const Tally& tally, int round) {
    if (!studio.file_dialog) return;
    FileQuestion question;
    question.kind = FileQuestion::Kind::save;
    question.title = "Export the result";
    question.action = "Export";
    question.suffixes = {".csv"};
    question.suggested = fmt::format("round-{}.csv", round);
    question.then = [&studio, tally](const std::filesystem::path& file) {
        try {
            write_text_file(file, tally_csv(tally));
            notify(studio,
                   {Notice::Level::info, "The result was exported.", "", file.string() + "."});
        } catch (const FileError& error) {
            notify(studio,
                   {Notice::Level::error, "The result was not exported.", error.what(), ""});
        }
    };
    studio.file_dialog->ask(std::move(question));
}

void draw_result(Studio& studio, const Round& round) {
    BallotDialogState& state = studio.panels.ballot;
    heading(fmt::format("Round {}: {}", round.id, count_of(round.ballots)).c_str());
    name_last_item("ballot:result");
    dim_text(fmt::format("Started {}, {}.",
                         readable_time(round.created),
                         round.calibration_id.empty()
                             ? std::string("shown uncorrected")
                             : "shown under calibration " + round.calibration_id.substr(0, 8)));
    Tally tally;
    if (!attempted(state, [&] { tally = studio.ballots->tally(round.id); })) return;
    draw_table(tally);
    ImGui::Spacing();
    if (ImGui::Button("Export as CSV…")) ask_where_to_export(studio, tally, round.id);
    name_last_item("ballot:export");
    ImGui::SameLine();
    if (ImGui::Button("All rounds")) go_to(state, open_round(state) ? Page::vote : Page::start);
    name_last_item("ballot:rounds");
}

void draw_page(Studio& studio) {
    BallotDialogState& state = studio.panels.ballot;
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

void draw_ballot_dialog(Studio& studio, bool& open) {
    BallotDialogState& state = studio.panels.ballot;
    if (!open) {
        state.was_open = false;
        return;
    }
    if (!std::exchange(state.was_open, true)) {
        if (studio.ballots) read_rounds(studio);
        go_to(state, Page::start);
    }
    // Asking for a file closes this one; it comes back afterwards, as it was.
    if (studio.file_dialog && studio.file_dialog->is_open()) return;
    if (!ImGui::IsPopupOpen(kTitle)) ImGui::OpenPopup(kTitle);
    const ImVec2 screen = ImGui::GetMainViewport()->WorkSize;
    const float width = std::min(em(34.0f), 0.96f * screen.x);
    ImGui::SetNextWindowSizeConstraints({width, 0.0f}, {width, 0.94f * screen.y});
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(kTitle,
                                &open,
                                ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings)) {
        return;
    }
    if (!studio.ballots) {
        warning_text("Ballots cannot be kept: the ballot file could not be opened.");
    } else {
        draw_page(studio);
    }
    if (!state.problem.empty()) {
        warning_text(state.problem);
        name_last_item("ballot:problem");
    }
    const bool typing = ImGui::GetIO().WantTextInput;
    if (was_pressed(ImGuiKey_Escape) && !typing) open = false;
    if (!open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace livery
