#include "studio/studio.h"

#include <algorithm>
#include <utility>

#include <imgui.h>
#include <imgui_internal.h>

#include "core/log.h"
#include "studio/kit/imgui_versions.h"

namespace livery {

namespace {

constexpr double kInfoShown_s = 8.0;

std::string text_of(const Notice& notice) {
    std::string text = notice.what;
    if (!notice.cause.empty()) text += " " + notice.cause;
    if (!notice.fix.empty()) text += " " + notice.fix;
    return text;
}

/// Since the window's last frame. A pointer that left and came back where it was did not move, nor
/// did one that was there when the window came.
bool pointer_moved(const Studio& studio) {
    if (!ImGui::IsMousePosValid() || !studio.pointer_was_there) return false;
    const ImVec2 at = ImGui::GetIO().MousePos;
    return at.x != studio.pointer_x || at.y != studio.pointer_y;
}

/// An arrow key led to the item, as opposed to focus that was given back to it.
bool was_led_to(unsigned item) {
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    return g.NavJustMovedToId == item && (g.NavMoveFlags & kMovedByTabbing) == 0;
}

}  // namespace

void commit(Studio& studio, const SessionCommand& command) {
    if (refuse_editing(studio)) return;
    const std::string label = label_of(studio.session.document(), command);
    try {
        studio.session.execute(command);
    } catch (const std::exception& error) {
        tell_error(studio, label + " was not done.", error.what());
        return;
    }
    log_line(LogLevel::info, "command: " + text_of(command));
    studio.tried.reset();
    studio.trying.reset();
    if (const auto look = look_of(studio.session.document(), command)) show_look(studio, *look);
    keep_shown_looks_valid(studio);
}

void try_out(Studio& studio, const SessionCommand& command, bool by_arrow) {
    const unsigned item = ImGui::GetItemID();
    const bool goes_on = studio.tried && studio.tried_item == item;
    if (!goes_on && !by_arrow && !was_led_to(item) && !pointer_moved(studio)) return;
    try_held(studio, command);
}

void try_held(Studio& studio, const SessionCommand& command) {
    if (is_editing_locked(studio)) return;
    const unsigned item = ImGui::GetItemID();
    if (studio.untried_item == item) {
        studio.untried_item_still_there = true;
        return;
    }
    studio.trying = command;
    studio.trying_item = item;
}

void edit_with_last_item(Studio& studio, const SessionCommand& command) {
    if (ImGui::IsItemDeactivatedAfterEdit()) {
        if (!studio.gave_up) commit(studio, command);
    } else if (ImGui::IsItemActive() && !studio.gave_up) {
        try_held(studio, command);
    }
}

void stop_trying(Studio& studio) {
    if (studio.tried || studio.trying) {
        studio.untried_item = studio.trying_item;
        studio.untried_item_still_there = true;
    }
    studio.tried.reset();
    studio.trying.reset();
}

std::optional<Notice> editing_lock(const Studio& studio) {
    for (const Panel& panel : all_panels()) {
        if (!panel.locks_editing) continue;
        if (auto why = panel.locks_editing(studio)) return why;
    }
    return std::nullopt;
}

bool is_editing_locked(const Studio& studio) { return editing_lock(studio).has_value(); }

bool refuse_editing(Studio& studio) {
    auto why = editing_lock(studio);
    if (!why) return false;
    notify(studio, std::move(*why));
    return true;
}

void begin_trials(Studio& studio) {
    studio.trying.reset();
    studio.untried_item_still_there = false;
}

void end_trials(Studio& studio) {
    studio.tried = studio.trying;
    studio.tried_item = studio.trying_item;
    if (ImGui::IsMousePosValid()) {
        studio.pointer_was_there = true;
        studio.pointer_x = ImGui::GetIO().MousePos.x;
        studio.pointer_y = ImGui::GetIO().MousePos.y;
    }
    if (!studio.untried_item_still_there) studio.untried_item.reset();
    studio.gave_up = false;
}

Document shown_document(const Studio& studio) {
    const Document& document = studio.session.document();
    if (!studio.tried) return document;
    try {
        return applied(document, *studio.tried);
    } catch (const std::invalid_argument&) {
        return document;  // The document changed under the pointer: the look is gone.
    }
}

void show_look(Studio& studio, int look) {
    if (look == studio.shown_look || !find_look(studio.session.document(), look)) return;
    if (refuse_editing(studio)) return;
    if (!studio.chose_compared_look) studio.compared_look = studio.shown_look;
    studio.shown_look = look;
    keep_shown_looks_valid(studio);
}

void keep_shown_looks_valid(Studio& studio) {
    const Document& document = studio.session.document();
    if (document.looks.empty()) return;
    // The place in the list stays when the look that stood there is gone.
    const auto place = std::find_if(document.looks.begin(),
                                    document.looks.end(),
                                    [&](const auto& l) { return l.id == studio.shown_look; });
    if (place != document.looks.end()) {
        studio.shown_place = static_cast<std::size_t>(place - document.looks.begin());
    } else {
        studio.shown_place = std::min(studio.shown_place, document.looks.size() - 1);
        studio.shown_look = document.looks[studio.shown_place].id;
    }
    if (studio.compared_look && (*studio.compared_look == studio.shown_look ||
                                 !find_look(document, *studio.compared_look))) {
        studio.compared_look.reset();
        studio.chose_compared_look = false;
    }
    if (!studio.compared_look) {
        for (const SessionLook& look : document.looks) {
            if (look.id != studio.shown_look) {
                studio.compared_look = look.id;
                break;
            }
        }
    }
    if (!studio.compared_look) studio.wiping = studio.showing_b = false;
}

void select_part(Studio& studio, int part) {
    studio.selected_part = part;
    studio.paint_target = PaintTarget::part;
    studio.glowing_part = part;
    studio.glowing_until_s = studio.now_s + kGlow_s;
}

void notify(Studio& studio, Notice notice) {
    const auto level = notice.level == Notice::Level::error     ? LogLevel::error
                       : notice.level == Notice::Level::warning ? LogLevel::warning
                                                                : LogLevel::info;
    log_line(level, text_of(notice));
    if (notice.level == Notice::Level::info && notice.shown_until_s == 0.0) {
        notice.shown_until_s = studio.now_s + kInfoShown_s;
    }
    // The same thing again replaces itself rather than filling the window.
    std::erase_if(studio.notices, [&](const Notice& n) { return n.what == notice.what; });
    studio.notices.push_back(std::move(notice));
}

void tell_info(
    Studio& studio, std::string what, std::string cause, std::string fix, double until_s) {
    notify(studio,
           {Notice::Level::info, std::move(what), std::move(cause), std::move(fix), until_s});
}

void tell_warning(
    Studio& studio, std::string what, std::string cause, std::string fix, double until_s) {
    notify(studio,
           {Notice::Level::warning, std::move(what), std::move(cause), std::move(fix), until_s});
}

void tell_error(Studio& studio, std::string what, std::string cause, std::string fix) {
    notify(studio, {Notice::Level::error, std::move(what), std::move(cause), std::move(fix)});
}

std::string in_words(const std::exception_ptr& why) {
    try {
        std::rethrow_exception(why);
    } catch (const std::exception& error) {
        return error.what();
    }
}

void notify_failure(Studio& studio, const std::string& what, const std::exception_ptr& why) {
    try {
        std::rethrow_exception(why);
    } catch (const Cancelled&) {
        return;
    } catch (const Refused& refused) {
        tell_error(studio, what, refused.why(), refused.fix());
    } catch (const std::exception& error) {
        tell_error(studio, what, error.what());
    }
}

void in_background(Studio& studio, std::string what_failed, Background::Work work) {
    studio.background->run(std::move(work),
                           [&studio, what = std::move(what_failed)](std::exception_ptr why) {
                               notify_failure(studio, what, why);
                           });
}

}  // namespace livery
