#include <algorithm>
#include <cfloat>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include "core/log.h"
#include "jobs/comparison.h"
#include "studio/drawing.h"
#include "studio/seats/seats_panel.h"
#include "studio/studio.h"

namespace livery {

namespace {

constexpr int kLegendSteps = 64;

const SeatsPanelState& state_of(const Studio& studio) {
    return studio.panels.of<SeatsPanelState>();
}
SeatsPanelState& state_of(Studio& studio) { return studio.panels.of<SeatsPanelState>(); }

/// What somebody looks at now; the first is found first.
std::vector<int> looks_wanted(const Studio& studio) {
    const SeatsPanelState& state = state_of(studio);
    std::vector<int> looks;
    if (!is_editing_locked(studio) && (state.open || state.map_on_stage))
        looks.push_back(studio.shown_look);
    for (const int look : state.judged_looks) {
        if (std::find(looks.begin(), looks.end(), look) == looks.end()) looks.push_back(look);
    }
    return looks;
}

/// Nothing while files that the looks' paints need are being read: asked again.
std::optional<SeatErrorRequest> request_for(Studio& studio, const std::vector<int>& looks) {
    const Document& document = studio.session.document();
    SeatErrorRequest request;
    for (const int look : looks) {
        if (!find_look(document, look)) continue;
        SeatErrorRequest::Of of{look, scene_for(studio, document, look)};
        if (!unread_files(of.scene).empty()) return std::nullopt;
        request.looks.push_back(std::move(of));
    }
    request.seats = document.seats;
    request.view = seat_error_view(studio.setup->view);
    request.levels = seat_error_levels(document.quality, document.levels);
    return request;
}

void draw_legend(const StageFrame& stage) {
    const Image8 ramp = difference_legend(kLegendSteps, 1);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float width = std::min(em(16.0f), 0.5f * stage.width), height = em(0.8f);
    const float pad = em(0.5f);
    const ImVec2 low(stage.x + stage.width - width - 2.0f * pad,
                     stage.y + stage.height - height - ImGui::GetTextLineHeight() - 3.0f * pad);
    ImFont* font = small_font();
    list.AddRectFilled({low.x - pad, low.y - font->FontSize - 1.5f * pad},
                       {low.x + width + pad, stage.y + stage.height - pad},
                       IM_COL32(0, 0, 0, 190),
                       em(0.25f));
    const ImU32 text = ImGui::GetColorU32(colours::text);
    list.AddText(font,
                 font->FontSize,
                 {low.x, low.y - font->FontSize - 0.5f * pad},
                 text,
                 "CIEDE2000 to what this seat should see");
    for (int k = 0; k < kLegendSteps; ++k) {
        const std::uint8_t* colour = ramp.pixel(k, 0);
        const float step = width / static_cast<float>(kLegendSteps);
        list.AddRectFilled({low.x + static_cast<float>(k) * step, low.y},
                           {low.x + static_cast<float>(k + 1) * step, low.y + height},
                           IM_COL32(colour[0], colour[1], colour[2], 255));
    }
    const auto mark = [&](double value, const std::string& words, float align) {
        const float x = low.x + static_cast<float>(value / kSeatMapScale) * width;
        const float wide = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0f, words.c_str()).x;
        list.AddLine({x, low.y}, {x, low.y + height + 0.3f * pad}, text);
        list.AddText(font,
                     font->FontSize,
                     {x - align * wide, low.y + height + 0.3f * pad},
                     text,
                     words.c_str());
    };
    mark(0.0, "0", 0.0f);
    mark(kFairSeatDe00, fmt::format("{:g}", kFairSeatDe00), 0.5f);
    mark(kSeatMapScale, fmt::format("{:g} and more", kSeatMapScale), 1.0f);
    name_rectangle("seat-map:legend", low.x, low.y, width, height);
}

/// What is beside the mock-up is clear.
Image8 coloured(const Image8& steps) {
    ImageF de00(steps.width, steps.height, 1);
    for (std::size_t i = 0; i < steps.pixel_count(); ++i) {
        de00.values[i] =
            static_cast<float>(kSeatMapScale * (std::max<int>(steps.values[i], 1) - 1) / 254.0);
    }
    Image8 rgba = opaque(difference_map(de00, kSeatMapScale));
    for (std::size_t i = 0; i < steps.pixel_count(); ++i) {
        if (!steps.values[i]) rgba.values[4 * i + 3] = 0;
    }
    return rgba;
}

void upload(SeatsPanelState& state, const std::shared_ptr<const Image8>& steps) {
    if (state.map_in_texture == steps) return;
    state.map_texture = texture_of(coloured(*steps));
    state.map_in_texture = steps;
}

/// What is there is of the session as it is.
bool stand(const Studio& studio) {
    const SeatsPanelState& state = state_of(studio);
    return state.results && state.asked && state.results->number == state.number &&
           state.asked->revision == studio.session.revision();
}

/// Whose map: the chosen seat's, else the first.
int mapped_seat(const Studio& studio) {
    const auto& seats = studio.session.document().seats;
    const int selected = state_of(studio).selected;
    if (find_seat(seats, selected) || seats.empty()) return selected;
    return seats.front().number;
}

}  // namespace

void step_seat_errors(Studio& studio) {
    SeatsPanelState& state = state_of(studio);
    if (studio.session.document().seats.empty()) {
        // Nothing of it is kept for those who have no seats.
        state.map_on_stage = false;
        if (state.thread) stop_seat_errors(studio);
        return;
    }
    if (state.thread) state.results = state.thread->newest();
    if (!studio.setup || studio.opening) return;
    SeatErrorKey key{studio.session.revision(), looks_wanted(studio), studio.setup};
    if (key.looks.empty() || state.asked == key) return;
    try {
        auto request = request_for(studio, key.looks);
        if (!request || request->looks.empty()) return;
        state.asked = std::move(key);
        request->number = ++state.number;
        if (!state.thread) state.thread = std::make_unique<SeatErrorThread>(wake_main_thread);
        state.thread->ask(std::move(*request));
    } catch (const std::exception& error) {
        state.asked = std::move(key);
        log_line(LogLevel::warning, std::string("seats: ") + error.what());
    }
}

void stop_seat_errors(Studio& studio) {
    SeatsPanelState& state = state_of(studio);
    state.thread.reset();
    state.results.reset();
    state.asked.reset();
    state.map_texture = {};
    state.map_in_texture.reset();
}

const SeatErrorMap* seat_error_of(const Studio& studio, int look, int seat) {
    const SeatsPanelState& state = state_of(studio);
    if (!stand(studio)) return nullptr;
    const auto of_look = state.results->looks.find(look);
    if (of_look == state.results->looks.end()) return nullptr;
    const auto found = of_look->second.find(seat);
    return found == of_look->second.end() ? nullptr : &found->second;
}

bool seat_errors_found(const Studio& studio) {
    return stand(studio) && state_of(studio).results->complete();
}

std::optional<double> seat_errors_progress(const Studio& studio) {
    const SeatsPanelState& state = state_of(studio);
    if (!state.thread || !state.asked) return std::nullopt;
    if (!state.results || state.results->number != state.number) return 0.0;
    if (state.results->complete() || !state.results->problem.empty()) return std::nullopt;
    return static_cast<double>(state.results->done) / static_cast<double>(state.results->wanted);
}

bool shows_seat_map(const Studio& studio) { return state_of(studio).map_on_stage; }
void show_seat_map(Studio& studio, bool shown) { state_of(studio).map_on_stage = shown; }

glm::ivec2 seat_map_size(const Studio& studio) {
    const SeatErrorMap* map = seat_error_of(studio, studio.shown_look, mapped_seat(studio));
    return map ? glm::ivec2(map->steps->width, map->steps->height) : glm::ivec2(0);
}

void draw_seat_map(Studio& studio, const StageFrame& picture, const StageFrame& stage) {
    SeatsPanelState& state = state_of(studio);
    const int seat = mapped_seat(studio);
    const SeatErrorMap* map = seat_error_of(studio, studio.shown_look, seat);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    std::string words;
    if (map) {
        upload(state, map->steps);
        list.AddImage(imgui_texture(state.map_texture.name()),
                      {picture.x, picture.y},
                      {picture.x + picture.width, picture.y + picture.height});
        draw_legend(stage);
        words = in_words(SeatSees{seat, studio.shown_look, map->error});
    } else if (state.results && !state.results->problem.empty()) {
        words = "What the seats miss is not known: " + state.results->problem;
    } else {
        words = fmt::format("Shading the look for the eye of seat {}…", seat);
    }
    const float pad = em(0.5f);
    const float wrap = stage.width - 4.0f * pad;
    const ImVec2 size = ImGui::CalcTextSize(words.c_str(), nullptr, false, wrap);
    const ImVec2 at(stage.x + 2.0f * pad, stage.y + 2.0f * pad);
    list.AddRectFilled({at.x - pad, at.y - 0.5f * pad},
                       {at.x + size.x + pad, at.y + size.y + 0.5f * pad},
                       IM_COL32(0, 0, 0, 190),
                       em(0.25f));
    list.AddText(ImGui::GetFont(),
                 ImGui::GetFontSize(),
                 at,
                 ImGui::GetColorU32(colours::text),
                 words.c_str(),
                 nullptr,
                 wrap);
    name_rectangle("seat-map", picture.x, picture.y, picture.width, picture.height);
}

void draw_seats_before_vote(Studio& studio, const std::vector<int>& looks) {
    const Document& document = studio.session.document();
    const std::string whose = in_words(document.seats, document.eye_choice);
    if (document.seats.empty()) {
        // One line: the panel is full of other things
        row_label(("Eye: " + whose).c_str());
    } else {
        heading("Seats");
        ImGui::TextWrapped("%s", ("The eye is " + whose + ".").c_str());
        name_last_item("ballot:eye");
    }
    if (ImGui::Button("Seats in the room…", {-FLT_MIN, 0.0f})) show_panel(studio, "seats");
    name_last_item("ballot:seats");
    tooltip("Where people sit, whose eye highlights are drawn for, and what the others miss.");
    if (document.seats.empty()) return;
    if (const auto progress = seat_errors_progress(studio)) {
        progress_bar(*progress, "What each seat misses…");
    }
    const SeatsPanelState& state = state_of(studio);
    if (!state.results || state.results->number != state.number) return;
    const auto all = worst_looks(*state.results, document.seats, looks);
    for (const SeatSees& sees : all) {
        const std::string words = in_words(sees);
        is_fair(sees.error) ? dim_text(words) : warning_text(words);
        name_last_item(fmt::format("ballot:seat:{}", sees.seat));
        if (const SessionLook* look = find_look(document, sees.look)) {
            tooltip(fmt::format("Most of all in {}: median {:.1f}, {:.0f}% of it over 3.",
                                look->look.name,
                                sees.error.de00_median,
                                100.0 * sees.error.share_over));
        }
    }
    if (const std::string unfair = unfair_in_words(all); !unfair.empty()) {
        warning_text(unfair + " Move the eye or those seats, or let them vote in waves.");
        name_last_item("ballot:seats-unfair");
    }
}

std::vector<SeatSees> worst_looks(const SeatErrorResults& results,
                                  const std::vector<EyeSeat>& seats,
                                  const std::vector<int>& looks) {
    std::vector<SeatSees> all;
    for (const EyeSeat& seat : seats) {
        SeatSees worst{seat.number, 0, {}};
        bool known = !looks.empty();
        for (const int look : looks) {
            const auto of_look = results.looks.find(look);
            if (of_look == results.looks.end()) {
                known = false;
                break;
            }
            const auto found = of_look->second.find(seat.number);
            if (found == of_look->second.end()) {
                known = false;
                break;
            }
            const SeatError& error = found->second.error;
            if (worst.look == 0 || error.share_over > worst.error.share_over ||
                (error.share_over == worst.error.share_over &&
                 error.de00_p95 > worst.error.de00_p95)) {
                worst = {seat.number, look, error};
            }
        }
        if (known) all.push_back(worst);
    }
    return all;
}

std::string in_words(const SeatSees& sees) {
    const SeatError& error = sees.error;
    if (error.de00_p95 <= kFairSeatDe00) {
        return fmt::format(
            "Seat {} sees what it should: 95% within {:.1f}.", sees.seat, error.de00_p95);
    }
    return fmt::format("Seat {} sees highlights where none should be: 95% within CIEDE2000 {:.1f}.",
                       sees.seat,
                       error.de00_p95);
}

std::string unfair_in_words(const std::vector<SeatSees>& all) {
    std::vector<int> seats;
    double most = 0.0;
    for (const SeatSees& sees : all) {
        if (is_fair(sees.error)) continue;
        seats.push_back(sees.seat);
        most = std::max(most, sees.error.share_over);
    }
    if (seats.empty()) return "";
    const bool one = seats.size() == 1;
    return fmt::format(
        "{} {} {} other looks than {} should: up to {:.0f}% of one is more than 3 (CIEDE2000) off.",
        one ? "Seat" : "Seats",
        fmt::join(seats, ", "),
        one ? "sees" : "see",
        one ? "it" : "they",
        100.0 * most);
}

}  // namespace livery
