// The bar over the whole width, and what the audience sees.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "studio/presenting/ballot_panel.h"
#include "studio/presenting/presenting.h"
#include "studio/studio.h"

namespace livery {

namespace {

using Phase = PresentationPhase;
using Event = PresentationEvent;

constexpr std::array<const char*, 4> kSegments = {"EDIT", "PRESENTING", "VOTING", "LOCKED"};

std::size_t segment_of(const Studio& studio) {
    if (presenting(studio).freezing) return 1;
    switch (phase_of(studio)) {
        case Phase::edit:
            return open_round(studio.panels.of<BallotPanelState>()) ? 2 : 0;
        case Phase::adapting:
        case Phase::presenting:
            return 1;
        case Phase::voting:
            return 2;
        case Phase::locked:
            return 3;
    }
    return 0;
}

ImVec4 colour_of(std::size_t segment) {
    if (segment == 1) return colours::accent;
    if (segment == 2) return {0.22f, 0.52f, 0.28f, 1.0f};
    if (segment == 3) return {0.62f, 0.44f, 0.12f, 1.0f};
    return {0.36f, 0.36f, 0.36f, 1.0f};
}

void centred_text(ImFont& font,
                  const std::string& text,
                  const ImVec2& low,
                  const ImVec2& high,
                  const ImVec4& colour) {
    const ImVec2 size = font.CalcTextSizeA(font.FontSize, FLT_MAX, 0.0f, text.c_str());
    ImGui::GetWindowDrawList()->AddText(&font,
                                        font.FontSize,
                                        {std::round(0.5f * (low.x + high.x - size.x)),
                                         std::round(0.5f * (low.y + high.y - size.y))},
                                        ImGui::GetColorU32(colour),
                                        text.c_str());
}

/// Arrows from left to right; the one that holds is filled. Returns where they end.
float draw_segments(const Studio& studio, const ImVec2& corner, float height) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float width = em(8.2f), tip = em(0.9f);
    const std::size_t now = segment_of(studio);
    for (std::size_t k = kSegments.size(); k-- > 0;) {
        const float left = corner.x + static_cast<float>(k) * width, right = left + width;
        const bool on = k == now;
        const ImU32 fill = ImGui::GetColorU32(on ? colour_of(k) : colours::raised);
        const std::array<ImVec2, 5> shape = {ImVec2(left, corner.y),
                                             ImVec2(right, corner.y),
                                             ImVec2(right + tip, corner.y + 0.5f * height),
                                             ImVec2(right, corner.y + height),
                                             ImVec2(left, corner.y + height)};
        list.AddConvexPolyFilled(shape.data(), static_cast<int>(shape.size()), fill);
        list.AddPolyline(shape.data(),
                         static_cast<int>(shape.size()),
                         ImGui::GetColorU32(colours::line),
                         ImDrawFlags_Closed,
                         1.0f);
        const ImVec2 low(left + (k > 0 ? tip : 0.0f), corner.y), high(right, corner.y + height);
        centred_text(on ? *large_font() : *heading_font(),
                     k == 1 && phase_of(studio) == Phase::adapting ? "ADAPTING" : kSegments[k],
                     low,
                     high,
                     on ? ImVec4(1.0f, 1.0f, 1.0f, 1.0f) : colours::dim_text);
        if (on) {
            name_rectangle("vote-segment", left, corner.y, width, height);
        }
    }
    return corner.x + static_cast<float>(kSegments.size()) * width + tip;
}

std::string headline(const Studio& studio) {
    const PresentingState& state = presenting(studio);
    if (state.freezing) return "Freezing…";
    if (!state.presented) return "";
    const PresentationState& step = state.presented->state;
    if (step.paused) return step.blank ? "PAUSED, GREY" : "PAUSED";
    if (step.blank) return "GREY";
    if (const auto code = code_on_show(studio)) return fmt::format("{}", *code);
    switch (step.phase) {
        case Phase::adapting:
            return "white";
        case Phase::presenting:
            return "grey";
        case Phase::voting: {
            const VotesSoFar so_far = votes_so_far(state);
            return fmt::format("{} of {}", so_far.voted, so_far.awaited);
        }
        default:
            return "";
    }
}

std::string details(const Studio& studio) {
    const PresentingState& state = presenting(studio);
    if (state.freezing) {
        return state.freezing->writing ? std::string("keeping the frames")
                                       : fmt::format("look {} of {}",
                                                     state.freezing->frames.size() + 1,
                                                     state.freezing->looks.size());
    }
    if (!state.presented) {
        const Round* open = open_round(studio.panels.of<BallotPanelState>());
        return open ? fmt::format("Round {} takes votes, unpresented: close it in the panel.",
                                  open->id)
                    : "Choose looks in the panel, then Present.";
    }
    const PresentedRound& presented = *state.presented;
    const PresentationState& step = presented.state;
    if (!state.problem.empty()) return state.problem;
    if (const std::string question = question_in_words(state); !question.empty()) return question;
    if (presented.frames.empty() && step.phase != Phase::locked) return "reading the frozen frames";
    const double left = left_s(step, studio.now_s);
    const std::string time = left < kWaits ? ", " + time_in_words(left) : std::string();
    const std::string sitting =
        presented.plan.sittings.size() > 1
            ? fmt::format("wave {} of {}, ", step.sitting + 1, presented.plan.sittings.size())
            : std::string();
    const auto looks = presented.plan.sittings[static_cast<std::size_t>(step.sitting)].size();
    switch (step.phase) {
        case Phase::adapting:
            return sitting + "eyes adapt" + time;
        case Phase::presenting: {
            const std::string place =
                fmt::format("{}look {} of {}", sitting, step.place + 1, looks);
            if (!step.grey) return place + time;
            if (left < kWaits) return "grey after " + place + time;
            return presented.round.voting() ? "all seen: Next goes back to the votes"
                                            : "all seen: Next lets people vote";
        }
        case Phase::voting:
            return sitting + "have voted";
        case Phase::locked:
            return fmt::format("round {} is closed for good", presented.round.id);
        case Phase::edit:
            break;
    }
    return "";
}

void draw_words(const Studio& studio, float left, float right, const ImVec2& corner, float height) {
    const std::string large = headline(studio);
    ImFont& font = *large_font();
    const float x = left + em(0.8f), room = right - x - em(0.5f);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const bool warns =
        large.starts_with("PAUSED") || large == "GREY" || !presenting(studio).problem.empty();
    const auto lines = fitted_lines(details(studio), std::max(room, em(2.0f)), 2);
    const float line = ImGui::GetTextLineHeight();
    const float block =
        (large.empty() ? 0.0f : font.FontSize) + line * static_cast<float>(lines.size());
    float y = corner.y + 0.5f * (height - block);
    if (!large.empty()) {
        list.AddText(&font,
                     font.FontSize,
                     {x, y},
                     ImGui::GetColorU32(warns ? colours::warning : colours::text),
                     large.c_str());
        y += font.FontSize;
    }
    for (const std::string& text : lines) {
        list.AddText({x, y}, ImGui::GetColorU32(colours::text), text.c_str());
        y += line;
    }
    name_rectangle("vote-words", x, corner.y, std::max(room, 1.0f), height);
}

struct Button {
    const char *label, *name, *help;
    Event event;
};

constexpr std::array<Button, 5> kShowing = {{
    {"Back", "vote:back", "The look before this one (arrow left, PgUp).", Event::back},
    {"Pause", "vote:pause", "Time stands still, and goes on (space bar).", Event::pause},
    {"Repeat", "vote:repeat", "This look anew, for all of its time (R).", Event::repeat},
    {"Next", "vote:next", "The grey, then the next look (arrow right, PgDn).", Event::next},
    {"Grey",
     "vote:blank",
     "Grey instead, until it is pressed again (B, or the full stop).",
     Event::blank},
}};

float row_width(std::size_t buttons, float each) {
    return static_cast<float>(buttons) * (each + ImGui::GetStyle().ItemInnerSpacing.x);
}

bool bar_button(const char* label,
                const char* name,
                const std::string& help,
                float width,
                float height,
                bool on = false) {
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, colours::accent);
    const bool pressed = ImGui::Button(label, {width, height});
    if (on) ImGui::PopStyleColor();
    name_last_item(name);
    tooltip(help);
    ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
    return pressed;
}

/// Where the buttons begin.
float draw_buttons(Studio& studio, float right, float top, float height) {
    PresentingState& state = presenting(studio);
    const float each = em(5.0f), wide = em(9.5f), button = em(2.6f);
    const float y = top + 0.5f * (height - button);
    const auto begin = [&](float width) {
        const float left = right - width - em(0.4f);
        ImGui::SetCursorScreenPos({left, y});
        return left;
    };
    if (state.freezing) {
        const float left = begin(row_width(1, each));
        if (bar_button("Cancel", "vote:cancel", "Nothing is presented.", each, button)) {
            state.give_up_wanted = true;
        }
        return left;
    }
    if (!state.presented) return right;
    const PresentationState step = state.presented->state;
    const PresentationPlan& plan = state.presented->plan;
    if (state.asking_to_abort || state.asking_to_lock) {
        const bool aborts = state.asking_to_abort;
        const float left = begin(row_width(2, wide));
        const bool sure = bar_button(aborts ? "Abort the round" : "Lock the round",
                                     "vote:confirm",
                                     aborts ? "Nobody votes on it; present the looks anew."
                                            : "Nobody can vote afterwards; the result shows.",
                                     wide,
                                     button,
                                     true);
        const bool keep = bar_button("Go on", "vote:keep", "As it was.", wide, button);
        if (sure) send(studio, aborts ? Event::abort : Event::lock);
        if (keep) state.asking_to_abort = state.asking_to_lock = false;
        return left;
    }
    if (step.phase == Phase::locked) {
        const float left = begin(row_width(1, wide));
        if (bar_button("Back to editing",
                       "vote:done",
                       "The mock-up shows the looks again.",
                       wide,
                       button)) {
            send(studio, Event::done);
        }
        return left;
    }
    if (step.phase == Phase::voting) {
        const bool more = is_allowed(plan, step, Event::next);
        const float left = begin(row_width(1, each) + row_width(more ? 2 : 1, wide));
        if (bar_button("Back",
                       "vote:back",
                       "The looks once more: votes that are in stay and can be changed.",
                       each,
                       button)) {
            send(studio, Event::back);
            return left;
        }
        if (more && bar_button("Next wave",
                               "vote:next-wave",
                               "The next people sit down: eyes adapt.",
                               wide,
                               button)) {
            send(studio, Event::next);
        }
        if (bar_button("Lock the round…",
                       "vote:lock",
                       "Ends the vote and shows the result.",
                       wide,
                       button)) {
            state.asking_to_lock = true;
        }
        return left;
    }
    // Once people vote the round is locked, not aborted.
    const bool may_abort = !state.presented->round.voting();
    const float left = begin(row_width(kShowing.size() + (may_abort ? 1 : 0), each));
    for (const Button& one : kShowing) {
        const bool on =
            (one.event == Event::pause && step.paused) || (one.event == Event::blank && step.blank);
        const char* label = !on ? one.label : one.event == Event::blank ? "Show" : "Go on";
        // Its place stays; its words change.
        ImGui::PushID(one.name);
        const bool pressed = bar_button(label, one.name, one.help, each, button, on);
        ImGui::PopID();
        if (pressed) {
            send(studio, one.event);
            if (!state.presented) return left;
        }
    }
    if (may_abort &&
        bar_button("Abort…", "vote:abort", "Nobody votes on this round.", each, button)) {
        state.asking_to_abort = true;
    }
    return left;
}

}  // namespace

bool has_vote_bar(const Studio& studio) {
    return studio.panels.of<BallotPanelState>().open || is_presenting(studio);
}

void draw_vote_bar(Studio& studio) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size = ImGui::GetContentRegionAvail();
    ImGui::GetWindowDrawList()->AddRectFilled(
        corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(colours::panel));
    const float left = draw_segments(studio, corner, size.y);
    const float right = draw_buttons(studio, corner.x + size.x, corner.y, size.y);
    draw_words(studio, left, right, corner, size.y);
}

bool draw_vote_stage(Studio& studio) {
    if (!is_presenting(studio)) return false;
    const PresentingState& state = presenting(studio);
    const ImVec2 from = ImGui::GetCursorScreenPos(), space = ImGui::GetContentRegionAvail();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    studio.stage_x = from.x;
    studio.stage_y = from.y;
    const float caption = 1.6f * ImGui::GetTextLineHeight();
    const ImVec2 room(std::max(16.0f, space.x), std::max(16.0f, space.y - caption));
    list.AddRectFilled(
        from, {from.x + room.x, from.y + room.y}, IM_COL32(18, 18, 18, 255), em(0.25f));
    std::string words =
        studio.black ? "The audience sees nothing now: the projector is black (Ctrl+B)."
        : studio.projector_monitor.empty() ? "Nobody sees it: no projector is chosen."
                                           : "What the audience sees: the projector's picture";
    if (state.freezing) words = "Each look is rendered once; the projector keeps its picture.";
    if (state.picture && !state.freezing) {
        const auto width = static_cast<float>(state.picture->size_px.x);
        const auto height = static_cast<float>(state.picture->size_px.y);
        const float scale = std::min(room.x / width, room.y / height);
        const ImVec2 low(std::round(from.x + 0.5f * (room.x - scale * width)),
                         std::round(from.y + 0.5f * (room.y - scale * height)));
        state.picture->ready->wait_on_device();
        list.AddImage(imgui_texture(state.picture->texture),
                      low,
                      {low.x + scale * width, low.y + scale * height});
        name_rectangle("vote-picture", low.x, low.y, scale * width, scale * height);
        if (state.presented && !state.presented->place && !state.presented->frames.empty()) {
            words += ". There is no room beside the mock-up for codes: call them out.";
        }
    }
    ImGui::SetCursorScreenPos(
        {from.x + em(0.3f), from.y + room.y + 0.3f * ImGui::GetTextLineHeight()});
    ImGui::TextColored(colours::dim_text, "%s", words.c_str());
    return true;
}

}  // namespace livery
