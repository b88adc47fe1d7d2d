#include "studio/window/window_place.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

namespace livery {

namespace {

int overlap(int a, int a_size, int b, int b_size) {
    return std::max(0, std::min(a + a_size, b + b_size) - std::max(a, b));
}

long shared_area(const WindowPlace& place, const Monitor& m) {
    return static_cast<long>(overlap(place.position.x, place.size_px.x, m.x, m.width)) *
           overlap(place.position.y, place.size_px.y, m.y, m.height);
}

}  // namespace

std::string text_of(const WindowPlace& place) {
    return fmt::format("{}x{}+{}+{}{}",
                       place.size_px.x,
                       place.size_px.y,
                       place.position.x,
                       place.position.y,
                       place.maximised ? " maximised" : "");
}

std::optional<WindowPlace> parse_window_place(const std::string& text) {
    WindowPlace place;
    int used = 0;
    const int read = std::sscanf(text.c_str(),
                                 "%5dx%5d+%6d+%6d%n",
                                 &place.size_px.x,
                                 &place.size_px.y,
                                 &place.position.x,
                                 &place.position.y,
                                 &used);
    if (read != 4 || place.size_px.x < 320 || place.size_px.y < 240) return {};
    place.maximised = text.substr(static_cast<std::size_t>(used)) == " maximised";
    return place;
}

double default_scale(float content_scale, glm::ivec2 monitor_px) {
    const bool says_nothing = content_scale < 1.05f;
    const bool very_fine = monitor_px.x >= 3200 && monitor_px.y >= 1800;
    return says_nothing && very_fine ? 2.0 : std::max(1.0, static_cast<double>(content_scale));
}

bool must_move(const WindowPlace& place,
               const std::vector<Monitor>& monitors,
               const std::string& projector_id) {
    bool seen = false;
    for (const Monitor& monitor : monitors) {
        const bool overlaps = shared_area(place, monitor) > 0;
        if (overlaps && monitor.id == projector_id) return true;
        seen = seen || overlaps;
    }
    return !seen;
}

std::optional<WindowPlace> place_beside_projector(const WindowPlace& wanted,
                                                  const std::vector<Monitor>& monitors,
                                                  const std::string& projector_id) {
    const Monitor* best = nullptr;
    const auto is_better = [&](const Monitor& a, const Monitor& b) {
        const long area_a = shared_area(wanted, a), area_b = shared_area(wanted, b);
        return area_a != area_b ? area_a > area_b : a.primary && !b.primary;
    };
    for (const Monitor& monitor : monitors) {
        if (monitor.id == projector_id) continue;
        if (!best || is_better(monitor, *best)) best = &monitor;
    }
    if (!best) return {};
    WindowPlace place = wanted;
    place.size_px = {std::min(wanted.size_px.x, best->width),
                     std::min(wanted.size_px.y, best->height)};
    place.position = {
        std::clamp(wanted.position.x, best->x, best->x + best->width - place.size_px.x),
        std::clamp(wanted.position.y, best->y, best->y + best->height - place.size_px.y)};
    return place;
}

}  // namespace livery
