#include "studio/ballot_result.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "core/paths.h"
#include "studio/kit/file_dialog.h"
#include "studio/kit/theme.h"
#include "studio/kit/widgets.h"

namespace livery {

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
    FileQuestion question;
    question.kind = FileQuestion::Kind::save;
    question.title = "Export the result";
    question.action = "Export";
    question.suffixes = {".csv"};
    question.suggested = fmt::format("round-{}.csv", round.id);
    question.then = [&studio, designs = round.designs, tally](const std::filesystem::path& file) {
        try {
            write_text_file(file, tally_csv(designs, tally));
            notify(studio,
                   {Notice::Level::info, "The result was exported.", "", file.string() + "."});
        } catch (const FileError& error) {
            notify(studio,
                   {Notice::Level::error, "The result was not exported.", error.what(), ""});
        }
    };
    studio.file_dialog->ask(std::move(question));
}

}  // namespace livery
