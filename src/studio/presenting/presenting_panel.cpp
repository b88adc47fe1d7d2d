// The ballot panel's parts of a presented vote: how it will be shown, who has voted, the phones.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "evaluation/ballot.h"
#include "evaluation/phone_page.h"
#include "evaluation/presentation_order.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"
#include "studio/presenting/presenting.h"

namespace livery {

namespace {

void seconds_field(Studio& studio, const char* name, double& value, float width, const char* help) {
    ImGui::SetNextItemWidth(width);
    ImGui::PushID(name);
    double typed = value;
    ImGui::InputDouble("##s", &typed, 0.0, 0.0, "%.4g s");
    if (ImGui::IsItemDeactivatedAfterEdit()) {
        value = std::clamp(typed, 0.2, 3600.0);
        keep_presenting_settings(studio);
    }
    ImGui::PopID();
    name_last_item(name);
    tooltip(help);
}

void draw_order_choice(Studio& studio) {
    PresentingSettings& settings = presenting_settings(studio);
    struct Order {
        const char *label, *name;
        bool waves;
    };
    static constexpr std::array<Order, 2> kOrders = {
        {{"all see every pass", "passes", false}, {"waves of people", "waves", true}}};
    row_label("Order");
    ImGui::SetNextItemWidth(-1.0f);
    const bool open = ImGui::BeginCombo("##order", kOrders[settings.waves ? 1 : 0].label);
    name_last_item("present:order");
    tooltip("One projector shows everyone one order: fair orders come one after the other.");
    if (!open) return;
    for (const Order& order : kOrders) {
        if (ImGui::Selectable(order.label, order.waves == settings.waves)) {
            settings.waves = order.waves;
            keep_presenting_settings(studio);
        }
        name_last_item(std::string("present:order:") + order.name);
    }
    ImGui::EndCombo();
}

void times_row(Studio& studio, PresentationTimes& times) {
    row_label("White, look, grey");
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = std::floor((ImGui::GetContentRegionAvail().x - 2.0f * gap) / 3.0f);
    seconds_field(studio,
                  "present:adapt",
                  times.adapt_s,
                  width,
                  "Neutral white first: eyes get used to it in two minutes.");
    ImGui::SameLine(0.0f, gap);
    seconds_field(studio, "present:look", times.look_s, width, "How long each look is shown.");
    ImGui::SameLine(0.0f, gap);
    seconds_field(studio,
                  "present:grey",
                  times.grey_s,
                  width,
                  "Between two looks, as bright as they are in the mean. Four seconds let "
                  "an after-image fade; less is for trying out.");
}

void count_row(Studio& studio,
               const char* label,
               const char* name,
               int& value,
               int low,
               int high,
               const char* help) {
    row_label(label);
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::PushID(name);
    int typed = value;
    if (ImGui::InputInt("##n", &typed)) {
        value = std::clamp(typed, low, high);
        keep_presenting_settings(studio);
    }
    ImGui::PopID();
    name_last_item(name);
    tooltip(help);
}

void least_tick(Studio& studio) {
    PresentingSettings& settings = presenting_settings(studio);
    if (named(ImGui::Checkbox("Ask for the least liked", &settings.asks_least),
              "present:least",
              "Each evaluator may name the look that they like least, too. Nobody has to; the "
              "statistics use it where everybody does.")) {
        keep_presenting_settings(studio);
    }
}

/// How the looks would be shown, in words; empty where they could not.
std::string plan_in_words(const PresentingSettings& settings, int designs, int phones) {
    if (designs < 2 || designs > kMostDesigns) return "";
    PresentationPlan plan;
    plan.sittings = sittings_of(settings, designs, settings.seed.value_or(1), phones);
    plan.times = settings.times;
    std::size_t shown = 0;
    for (const auto& sitting : plan.sittings) shown += sitting.size();
    const auto rows = williams_rows(designs).size();
    const auto passes = shown / static_cast<std::size_t>(designs);
    const std::string fair = passes % rows == 0
                                 ? "each look as often in each place and after each other one"
                                 : fmt::format("a multiple of {} would be balanced", rows);
    return fmt::format(
        "{} looks shown, {} {}, {}: {}.",
        shown,
        passes,
        settings.waves ? (passes == 1 ? "wave" : "waves") : (passes == 1 ? "pass" : "passes"),
        time_in_words(duration_s(plan)),
        fair);
}

void draw_waves(const std::vector<std::vector<int>>& seats) {
    for (const std::string& line : waves_in_words(seats)) dim_text(line);
    name_last_item("vote:waves");
}

/// Who would sit in which wave if nobody else joined.
void draw_waves_to_come(const PresentingSettings& settings, const std::vector<int>& phones) {
    if (phones.empty()) return dim_text("No phone has joined; ballots on paper count at any time.");
    const int size = settings.wave_size, count = static_cast<int>(phones.size());
    draw_waves(deal_seats(phones, (count + size - 1) / size));
}

void draw_stop_phones(Studio& studio) {
    if (ImGui::Button("Stop", {-FLT_MIN, 0.0f})) serve_phones(studio, false);
    name_last_item("phones:stop");
    tooltip("Phones no longer reach the ballots; votes that were confirmed stay.");
}

void draw_qr_picture(const std::string& text) {
    const QrCode code = qr_code(text);
    const int modules = code.size + 2 * kQrQuietZone;
    // As large as the panel shows without scrolling, and never too small for a phone
    const float below =
        ImGui::GetWindowHeight() - ImGui::GetCursorPosY() - ImGui::GetStyle().WindowPadding.y;
    const float room =
        std::min({ImGui::GetContentRegionAvail().x, em(11.0f), std::max(below, em(9.0f))});
    const float scale = std::max(1.0f, std::floor(room / static_cast<float>(modules)));
    const float side = scale * static_cast<float>(modules);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 low(std::floor(corner.x), std::floor(corner.y));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, {low.x + side, low.y + side}, IM_COL32(235, 235, 235, 255));
    for (int y = 0; y < code.size; ++y) {
        for (int x = 0; x < code.size; ++x) {
            if (!code.at(x, y)) continue;
            const ImVec2 from(low.x + scale * static_cast<float>(x + kQrQuietZone),
                              low.y + scale * static_cast<float>(y + kQrQuietZone));
            list.AddRectFilled(from, {from.x + scale, from.y + scale}, IM_COL32(0, 0, 0, 255));
        }
    }
    ImGui::Dummy({side, side});
    name_last_item("phones:qr");
}

void draw_network_choice(Studio& studio) {
    PresentingSettings& settings = presenting_settings(studio);
    row_label("Network", 0.3f);
    ImGui::SetNextItemWidth(-1.0f);
    const bool open = ImGui::BeginCombo("##network", settings.network.c_str());
    name_last_item("phones:network");
    tooltip("Where phones reach the ballots; lo is this machine alone.");
    if (!open) return;
    std::vector<NetworkInterface> networks;
    try {
        networks = network_interfaces();
    } catch (const std::exception& error) {
        presenting(studio).phones_problem = error.what();
    }
    for (const NetworkInterface& network : networks) {
        const std::string label =
            fmt::format("{}   {}{}",
                        network.name,
                        network.address,
                        network.name == "lo" ? "   (this machine alone)" : "");
        if (ImGui::Selectable(label.c_str(), network.name == settings.network)) {
            settings.network = network.name;
            keep_presenting_settings(studio);
        }
        name_last_item("phones:network:" + network.name);
    }
    ImGui::EndCombo();
}

/// Where it listens and who can see votes, as the window's user can change it.
std::string words_of(const BallotServerPlace& place) {
    const std::string where = "It listens on " + place.interface + " (" + place.address + ").";
    if (place.address.starts_with("127.")) {
        return where + " Only this machine reaches it: choose a network for phones.";
    }
    return where + (place.tls ? " What is sent is encrypted."
                              : " This is plain HTTP: whoever can listen to that network can see "
                                "votes and take seats.");
}

/// A look may take a minute where light has to be solved for it.
void draw_freezing(const Studio& studio) {
    const Freezing& freezing = *presenting(studio).freezing;
    const std::size_t done = freezing.frames.size(), all = freezing.looks.size();
    if (freezing.writing || done >= all) return progress_bar(1.0, "keeping the frames");
    const auto solving = studio.frames->solving();
    const double within = solving ? solving->fraction : 0.0;
    progress_bar(
        (static_cast<double>(done) + within) / static_cast<double>(all),
        fmt::format(
            "look {} of {}{}", done + 1, all, solving ? ": " + solving->stage : std::string()));
    name_last_item("vote:freezing");
}

}  // namespace

void draw_presentation_setup(Studio& studio, const std::vector<int>& looks) {
    PresentingSettings& settings = presenting_settings(studio);
    if (settings.waves) read_seats(studio);
    heading("Presentation");
    draw_order_choice(studio);
    if (settings.waves) {
        count_row(studio,
                  "Evaluators",
                  "present:evaluators",
                  settings.evaluators,
                  1,
                  kMostEvaluators,
                  "All that will come. Once phones have joined, those that are in count instead.");
        count_row(studio,
                  "At once",
                  "present:wave",
                  settings.wave_size,
                  1,
                  kMostEvaluators,
                  "The most that sit before the mock-up together: two or three.");
    } else {
        count_row(studio,
                  "Passes (0: all)",
                  "present:passes",
                  settings.passes,
                  0,
                  52,
                  "How many orders everybody sees, one after the other.");
    }
    times_row(studio, settings.times);
    least_tick(studio);
    draw_scales_setup(studio);
    if (settings.asks_least && looks.size() == 2) {
        dim_text("Of two looks the least liked is not asked.");
    }
    const std::vector<int> phones = phones_in(presenting(studio).seats);
    const std::string words =
        plan_in_words(settings, static_cast<int>(looks.size()), static_cast<int>(phones.size()));
    if (!words.empty()) dim_text(words);
    if (settings.waves && !words.empty()) draw_waves_to_come(settings, phones);
    if (!settings.waves && presenting(studio).phones) {
        dim_text(phones.empty()       ? "No phone has joined yet."
                 : phones.size() == 1 ? "1 phone has joined."
                                      : fmt::format("{} phones have joined.", phones.size()));
        name_last_item("present:joined");
    }
    if (looks.size() > static_cast<std::size_t>(kMostDesigns)) {
        warning_text(fmt::format("At most {} looks can be presented.", kMostDesigns));
    }
    begin_disabled(words.empty());
    if (ImGui::Button("Present",
                      {std::floor(0.58f * ImGui::GetContentRegionAvail().x), em(2.4f)})) {
        presenting(studio).begin_wanted = true;
        presenting(studio).wanted_looks = looks;
    }
    name_last_item("ballot:present");
    end_disabled();
    tooltip(looks.size() < 2 ? "Tick two looks or more: a vote compares them."
            : words.empty()  ? fmt::format("Tick at most {} looks.", kMostDesigns)
                             : "Freezes the looks, then shows them under their codes. Nothing can "
                               "be changed until the round is locked or aborted.");
}

void draw_seats(Studio& studio) {
    const PresentingState& state = presenting(studio);
    const bool votes = state.presented &&
                       state.presented->state.phase != PresentationPhase::adapting &&
                       state.presented->state.phase != PresentationPhase::presenting;
    if (state.seats.empty()) return dim_text("Nobody has joined yet.");
    const VotesSoFar so_far = votes_so_far(state);
    std::string words = fmt::format("{} have joined", state.seats.size());
    if (votes) words = fmt::format("{} of {} have voted", so_far.voted, so_far.awaited);
    if (votes && so_far.later > 0) words += fmt::format("; {} sit later", so_far.later);
    ImGui::TextUnformatted(words.c_str());
    name_last_item("vote:seats");
    const float side = em(2.2f), gap = em(0.25f);
    const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImVec2 at = ImGui::GetCursorScreenPos();
    const float left = at.x;
    for (const Seat& seat : state.seats) {
        if (at.x + side > right) at = {left, at.y + side + gap};
        const bool voted = has_voted(state, seat.number);
        const ImVec2 high(at.x + side, at.y + side);
        list.AddRectFilled(
            at, high, ImGui::GetColorU32(voted ? colours::good : colours::raised), em(0.2f));
        const std::string number = fmt::format("{}", seat.number);
        const ImVec2 size = ImGui::CalcTextSize(number.c_str());
        list.AddText(
            {std::round(0.5f * (at.x + high.x - size.x)),
             std::round(0.5f * (at.y + high.y - size.y))},
            ImGui::GetColorU32(voted ? ImVec4(0.05f, 0.05f, 0.05f, 1.0f) : colours::dim_text),
            number.c_str());
        ImGui::SetCursorScreenPos(at);
        ImGui::Dummy({side, side});
        name_last_item(fmt::format("vote:seat:{}", seat.number));
        tooltip((seat.name.empty() ? fmt::format("Seat {}, a phone", seat.number) : seat.name) +
                (voted                            ? ": has voted."
                 : sits_later(state, seat.number) ? ": its wave is still to come."
                 : votes && !seat.name.empty()    ? ": typed in; no ballot in this round."
                 : votes                          ? ": has not voted yet."
                                                  : "."));
        at.x += side + gap;
    }
    ImGui::SetCursorScreenPos({left, at.y + side + gap});
    ImGui::Dummy({0.0f, 0.0f});
}

void draw_phones(Studio& studio) {
    PresentingState& state = presenting(studio);
    heading("Phones");
    if (!state.phones) {
        draw_network_choice(studio);
        if (ImGui::Button("Let phones vote", {-FLT_MIN, 0.0f})) {
            serve_phones(studio, true);
            state.phones_sought = !state.presented;
        }
        name_last_item("phones:start");
        tooltip("Starts the phones' page on that network. Off until it is pressed.");
    } else if (!state.phones->place()) {
        dim_text("Starting the phones' page…");
        draw_stop_phones(studio);
    } else {
        const BallotServerPlace& place = *state.phones->place();
        dim_text(words_of(place));
        name_last_item("phones:words");
        const bool joins = !state.presented;
        if (state.invitation && joins) {
            try {
                draw_qr_picture(join_url(place, state.invitation->token));
            } catch (const std::exception& error) {
                warning_text(error.what());
            }
            ImGui::SameLine();
            ImGui::BeginGroup();
            const std::string& code = state.invitation->code;
            const std::size_t half = code.size() / 2;
            ImGui::PushFont(large_font());
            ImGui::TextUnformatted((code.substr(0, half) + " " + code.substr(half)).c_str());
            ImGui::PopFont();
            name_last_item("phones:code");
            dim_text(url_of(place));
            ImGui::Checkbox("Project it", &state.qr_projected);
            name_last_item("phones:project-qr");
            tooltip("Shows the QR code beside the mock-up, which is grey meanwhile.");
            draw_stop_phones(studio);
            ImGui::EndGroup();
            // Half of a code is none: below the looks there may be no room for it
            if (std::exchange(state.phones_sought, false)) ImGui::SetScrollHereY(1.0f);
        } else if (!joins) {
            dim_text(
                "Joining is closed while a round is open: who came now would not have seen every "
                "look.");
        }
        if (!state.invitation || !joins) draw_stop_phones(studio);
    }
    if (!state.phones_problem.empty()) {
        warning_text(state.phones_problem);
        name_last_item("phones:problem");
        if (std::exchange(state.phones_sought, false)) ImGui::SetScrollHereY(1.0f);
    }
}

void draw_presented_round(Studio& studio) {
    const PresentingState& state = presenting(studio);
    if (state.freezing) {
        heading("Freezing the looks");
        draw_freezing(studio);
        return dim_text(
            "Each is rendered once and kept with its hash; these pictures and no others are "
            "shown.");
    }
    if (!state.presented) return;
    const PresentedRound& presented = *state.presented;
    heading(fmt::format("Round {}{}", presented.round.id, presented.repeat).c_str());
    dim_text(fmt::format("Seed {}. Frames in {}.", presented.round.seed, presented.plan.folder));
    if (!state.problem.empty()) {
        warning_text(state.problem);
        name_last_item("vote:problem");
    }
    if (!presented.round.closed()) {
        std::string order;
        const auto& sitting =
            presented.plan.sittings[static_cast<std::size_t>(presented.state.sitting)];
        for (const int design : sitting) {
            order += fmt::format("{}{}",
                                 order.empty() ? "" : "  ",
                                 presented.round.codes[static_cast<std::size_t>(design)]);
        }
        heading("Order");
        ImGui::TextWrapped("%s", order.c_str());
        name_last_item("vote:order");
    }
    if (!presented.details.looks.empty()) {
        heading("What can be shown");
        // By code: in the order of the designs they would say which is whose
        std::vector<LookDetails> looks = presented.details.looks;
        std::sort(looks.begin(), looks.end(), [](const LookDetails& a, const LookDetails& b) {
            return a.code < b.code;
        });
        for (const LookDetails& look : looks) {
            const bool fair = !look.reachability || is_fair(*look.reachability);
            const std::string words = reach_in_words(look);
            fair ? dim_text(words) : warning_text(words);
        }
        name_last_item("vote:reach");
    }
    heading("Evaluators");
    draw_seats(studio);
    if (!presented.round.closed()) draw_waves(presented.plan.seats);
}

}  // namespace livery
