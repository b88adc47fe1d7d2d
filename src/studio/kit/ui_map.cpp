#include "studio/kit/ui_map.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "core/error.h"
#include "core/json.h"
#include "studio/kit/tab_order.h"

namespace livery {

namespace {

// Panels name items deep inside their drawing; Dear ImGui's state is just as global.
bool naming = false;
ItemPlaces named;

ItemPlace place_of(float left, float top, float right, float bottom) {
    const int x = static_cast<int>(std::floor(left)), y = static_cast<int>(std::floor(top));
    return {x, y, static_cast<int>(std::ceil(right)) - x, static_cast<int>(std::ceil(bottom)) - y};
}

Json json_of(const ItemPlace& place) {
    return Json::array({place.x, place.y, place.width, place.height});
}

}  // namespace

void start_naming_items(bool wanted) {
    naming = wanted;
    named.clear();
    start_tab_order();
}

ItemPlaces take_named_items() { return std::exchange(named, {}); }

void name_rectangle(const std::string& name, float x, float y, float width, float height) {
    if (naming) named[name] = place_of(x, y, x + width, y + height);
}

void name_last_item(const std::string& name) {
    note_tab_stop(name);
    if (!naming) return;
    // A pop-up's first frames only measure it: it is not seen, and not yet at its place.
    if (ImGui::GetCurrentWindowRead()->Hidden) return;
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 clip_low = list.GetClipRectMin(), clip_high = list.GetClipRectMax();
    const float left = std::max(low.x, clip_low.x), top = std::max(low.y, clip_low.y);
    const float right = std::min(high.x, clip_high.x), bottom = std::min(high.y, clip_high.y);
    if (right - left >= 1.0f && bottom - top >= 1.0f)
        named[name] = place_of(left, top, right, bottom);
}

std::string map_text(bool value) { return value ? "true" : "false"; }
std::string map_text(const std::string& value) { return Json(value).dump(); }
std::string map_text(const char* value) { return map_text(std::string(value)); }
std::string map_text(const std::optional<int>& value) {
    return value ? std::to_string(*value) : "null";
}

std::string map_text(const MapState& object) {
    Json json = Json::object();
    for (const auto& [name, value] : object) json[name] = Json::parse(value);
    return json.dump();
}

std::string ui_map_text(const ItemPlaces& items,
                        const MapState& state,
                        const ItemPlace& window_on_desktop) {
    Json json = {{"format_version", 1}, {"window", json_of(window_on_desktop)}};
    for (const auto& [name, value] : state) json["state"][name] = Json::parse(value);
    json["items"] = Json::object();
    for (const auto& [name, place] : items) json["items"][name] = json_of(place);
    return json.dump(1) + "\n";
}

void UiMapFile::update(const ItemPlaces& items,
                       const MapState& state,
                       const ItemPlace& window_on_desktop) {
    const std::string text = ui_map_text(items, state, window_on_desktop);
    if (text == written_) return;
    // Not flushed to the disk as a user's file is: it says what is now, and nothing later.
    auto temporary = file_;
    temporary += ".part";
    std::ofstream(temporary, std::ios::binary) << text;
    std::error_code error;
    std::filesystem::rename(temporary, file_, error);
    if (error) throw FileError(file_, "", error.message(), "a file that can be written");
    written_ = text;
}

}  // namespace livery
