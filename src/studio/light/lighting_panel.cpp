// Lights, environment, eye, exposure and quality: how the look is lit and seen.
#include "studio/light/lighting_panel.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>
#include <imgui_internal.h>

#include "core/angles.h"
#include "core/error.h"
#include "scene/frame_plan.h"
#include "studio/frame/quality_costs.h"
#include "studio/kit/imgui_versions.h"
#include "studio/light/light_values.h"
#include "twin/description.h"

namespace livery {

namespace {

struct Pad {
    ImVec2 centre;
    float radius;

    ImVec2 at(const glm::dvec2& pad) const {
        // What stands under the horizon is shown on the rim.
        const double length = glm::length(pad);
        const glm::dvec2 shown = length > 1.0 ? pad / length : pad;
        return {centre.x + radius * static_cast<float>(shown.x),
                centre.y + radius * static_cast<float>(shown.y)};
    }
    glm::dvec2 under(const ImVec2& mouse) const {
        return {static_cast<double>((mouse.x - centre.x) / radius),
                static_cast<double>((mouse.y - centre.y) / radius)};
    }
};

void draw_background(const Pad& pad, const glm::dvec3& toward_eye) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImU32 line = ImGui::GetColorU32(ImVec4(1.0f, 1.0f, 1.0f, 0.14f));
    draw->AddCircleFilled(
        pad.centre, pad.radius, ImGui::GetColorU32(ImGui::GetStyleColorVec4(ImGuiCol_FrameBg)), 64);
    for (const float ring : {1.0f / 3.0f, 2.0f / 3.0f, 1.0f}) {
        draw->AddCircle(pad.centre, ring * pad.radius, line, 64, std::max(1.0f, em(0.06f)));
    }
    if (glm::length(toward_eye) > 0.0) {
        const ImVec2 eye = pad.at(pad_from_angles(angles_of(toward_eye)));
        const float size = em(0.35f);
        draw->AddTriangle({eye.x, eye.y - size},
                          {eye.x - size, eye.y + 0.7f * size},
                          {eye.x + size, eye.y + 0.7f * size},
                          ImGui::GetColorU32(colours::dim_text),
                          std::max(1.0f, em(0.08f)));
    }
}

void draw_dot(const ImVec2& at, std::size_t light, const Angles& angles, bool lit) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float radius = em(0.52f);
    const ImU32 colour = ImGui::GetColorU32(lit ? ImVec4(1.0f, 1.0f, 1.0f, 1.0f) : colours::text);
    const bool below = angles.elevation_deg < 0.0;
    if (below) {
        draw->AddCircleFilled(at, radius, ImGui::GetColorU32(colours::panel), 24);
        draw->AddCircle(at, radius, colour, 24, std::max(1.0f, em(0.1f)));
    } else {
        draw->AddCircleFilled(at, radius, colour, 24);
    }
    const std::string number = fmt::format("{}", light + 1);
    const ImVec2 size = ImGui::CalcTextSize(number.c_str());
    draw->AddText({at.x - 0.5f * size.x, at.y - 0.5f * size.y},
                  below ? colour : ImGui::GetColorU32(colours::panel),
                  number.c_str());
}

/// Draws the pad with a dot a light and a mark for the eye. Each dot is an item that changes its
/// light's direction while it is held, named "light-pad:0", ...; `after_dot` is called right after
/// it.
void light_pad(std::vector<DirectionalLight>& lights,
               const glm::dvec3& toward_eye,
               float side_px,
               const std::function<void()>& after_dot) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float margin = em(0.55f);
    const Pad pad{{corner.x + 0.5f * side_px, corner.y + 0.5f * side_px}, 0.5f * side_px - margin};
    draw_background(pad, toward_eye);
    ImGui::PushFont(small_font());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const ImVec2 at = pad.at(pad_from_angles(angles_of(lights[i].direction)));
        const float reach = em(0.7f);
        ImGui::PushID(static_cast<int>(i));
        ImGui::SetCursorScreenPos({at.x - reach, at.y - reach});
        begin_overlapped_item();
        ImGui::InvisibleButton("dot", {2.0f * reach, 2.0f * reach});
        end_overlapped_item();
        if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1.0f)) {
            lights[i].direction = direction_of(angles_from_pad(pad.under(ImGui::GetIO().MousePos)));
            ImGui::MarkItemEdited(ImGui::GetItemID());
        }
        name_last_item(fmt::format("light-pad:{}", i));
        draw_dot(
            at, i, angles_of(lights[i].direction), ImGui::IsItemHovered() || ImGui::IsItemActive());
        after_dot();
        tooltip(
            fmt::format("The {} light. Pull it about: the middle is straight above, the rim the "
                        "horizon; the triangle is where the eye stands.",
                        light_name(i)));
        ImGui::PopID();
    }
    ImGui::PopFont();
    ImGui::SetCursorScreenPos(corner);
    ImGui::Dummy({side_px, side_px});
}

constexpr std::size_t kMostLights = 8;

bool same_light(const DirectionalLight& a, const DirectionalLight& b) {
    return a.direction == b.direction && a.radiance_rec709 == b.radiance_rec709 &&
           a.angle_rad == b.angle_rad;
}

bool same_lighting(const Look& a, const Look& b) {
    return std::equal(
               a.lights.begin(), a.lights.end(), b.lights.begin(), b.lights.end(), same_light) &&
           a.environment.file == b.environment.file &&
           a.environment.rotation_rad == b.environment.rotation_rad &&
           a.environment.scale == b.environment.scale;
}

const glm::dvec3& product_centre(Studio& studio) {
    LightingPanelState& state = studio.panels.of<LightingPanelState>();
    if (studio.product && state.centre_of != studio.product) {
        const Bounds bounds = bounds_of(studio.product->mesh);
        state.centre_mm = 0.5 * (bounds.low + bounds.high);
        state.centre_of = studio.product;
    }
    return state.centre_mm;
}

/// Along the panel's upper edge and over it: what the pointer is on stays where it is when solving
/// begins or ends, as it does with every light and environment that is tried.
void draw_solving(const Studio& studio) {
    if (!studio.frames) return;
    const auto solving = studio.frames->solving();
    if (!solving) return;
    const auto done = static_cast<float>(std::clamp(solving->fraction, 0.0, 1.0));
    const ImVec2 low = ImGui::GetWindowPos();
    const float width = ImGui::GetWindowWidth(), height = std::max(2.0f, em(0.2f));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(
        low, {low.x + width, low.y + height}, ImGui::GetColorU32(ImGuiCol_FrameBgHovered));
    list.AddRectFilled(
        low, {low.x + done * width, low.y + height}, ImGui::GetColorU32(ImGuiCol_PlotHistogram));
    name_rectangle("solving", low.x, low.y, width, height);
}

/// One control of one light, the value taken over while it is held.
class LightRows {
  public:
    LightRows(Studio& studio, Look& edited, std::size_t light)
        : studio_(studio), edited_(edited), light_(light) {}

    void after_item(const char* name, const std::string& meaning) {
        name_last_item(fmt::format("light:{}:{}", light_, name));
        tooltip(meaning);
        studio_.panels.of<LightingPanelState>().held.after_item();
        edit_with_last_item(studio_, SetLights{studio_.shown_look, edited_.lights});
    }

  private:
    Studio& studio_;
    Look& edited_;
    std::size_t light_;
};

void draw_direction(LightRows& rows, DirectionalLight& light) {
    Angles angles = angles_of(light.direction);
    row_label("Azimuth");
    number_slider("##azimuth", angles.azimuth_deg, -180.0, 180.0, "%.1f°");
    if (last_item_is_held()) light.direction = direction_of(angles);
    rows.after_item("azimuth", "0° is behind the product (-z), 90° on its right (+x).");
    row_label("Elevation");
    // Straight above and below the azimuth would be lost.
    number_slider("##elevation", angles.elevation_deg, -89.9, 89.9, "%.1f°");
    if (last_item_is_held()) light.direction = direction_of(angles);
    rows.after_item("elevation", "0° is the horizon, 90° straight above.");
}

/// `before` keeps the colour while the light is dragged to nothing and back.
void draw_strength(LightRows& rows, DirectionalLight& light, const DirectionalLight& before) {
    StrengthColour now = split_radiance(light.radiance_rec709);
    if (now.strength == 0.0)
        now.colour_rec709 = split_radiance(before.radiance_rec709).colour_rec709;
    double ev = ev_of(now.strength);
    row_label("Strength");
    number_slider("##strength", ev, kOffEv, 6.0, ev <= kOffEv ? "off" : "%+.2f EV");
    if (last_item_is_held()) light.radiance_rec709 = strength_of(ev) * now.colour_rec709;
    rows.after_item(
        "intensity",
        fmt::format("A white card that faces this light has radiance {:.3g}; at 0 EV it has 1.",
                    now.strength));
    row_label("Colour");
    glm::dvec3 colour = now.colour_rec709;
    colour_control("light-colour", colour);
    const double largest = std::max({colour.x, colour.y, colour.z});
    if (colour != now.colour_rec709 && largest > 0.0 && now.strength > 0.0) {
        light.radiance_rec709 = (now.strength / largest) * colour;
    }
    rows.after_item("colour", "Only hue and saturation count: its brightness is the strength.");
}

void draw_angle(LightRows& rows, DirectionalLight& light) {
    double degrees = kDegreesPerRadian * light.angle_rad;
    row_label("Size");
    ratio_slider("##angle", degrees, 0.0, 180.0, degrees <= 0.0 ? "a point" : "%.1f°");
    if (last_item_is_held()) light.angle_rad = degrees / kDegreesPerRadian;
    rows.after_item("angle",
                    "Angular diameter: 0 casts sharp shadows, 0.5° is the sun's, 3° a "
                    "lamp's, 30° a large soft box's.");
}

void draw_light(Studio& studio, Look& edited, const Look& before, std::size_t i) {
    ImGui::PushID(static_cast<int>(i));
    const std::string title = fmt::format("{}  {}###light", i + 1, light_name(i));
    bool keep = true;
    ImGui::SetNextItemOpen(i < 2, ImGuiCond_Once);
    const bool open = named(section_header(title.c_str(), &keep), fmt::format("light:{}", i));
    if (!keep) {
        auto lights = before.lights;
        lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(i));
        commit(studio, SetLights{studio.shown_look, lights});
    }
    if (open && keep) {
        LightRows rows(studio, edited, i);
        draw_direction(rows, edited.lights[i]);
        draw_strength(rows, edited.lights[i], before.lights[i]);
        draw_angle(rows, edited.lights[i]);
    }
    ImGui::PopID();
}

void draw_lights(Studio& studio, Look& edited, const Look& before) {
    heading("Lights");
    const glm::dvec3 toward_eye = eye_in_use_mm(studio.session.document()) - product_centre(studio);
    const float side = std::min(em(9.5f), ImGui::GetContentRegionAvail().x);
    light_pad(edited.lights, toward_eye, side, [&] {
        studio.panels.of<LightingPanelState>().held.after_item();
        edit_with_last_item(studio, SetLights{studio.shown_look, edited.lights});
    });
    ImGui::SameLine();
    ImGui::BeginGroup();
    begin_disabled(before.lights.size() >= kMostLights);
    if (button("Add light", "add-light")) {
        auto lights = before.lights;
        DirectionalLight light;
        light.direction = glm::normalize(glm::dvec3(0.3, 1.0, 0.6));
        light.radiance_rec709 = glm::dvec3(0.25);
        light.angle_rad = 3.0 / kDegreesPerRadian;
        lights.push_back(light);
        commit(studio, SetLights{studio.shown_look, lights});
    }
    end_disabled();
    dim_text(before.lights.empty() ? "This look has no lights."
                                   : "Pull a dot: the middle is straight above, the rim the "
                                     "horizon.");
    ImGui::EndGroup();
    for (std::size_t i = 0; i < edited.lights.size() && i < before.lights.size(); ++i) {
        draw_light(studio, edited, before, i);
    }
}

void draw_sharing(Studio& studio, const Look& look) {
    const auto& looks = studio.session.document().looks;
    const bool shared = std::all_of(looks.begin(), looks.end(), [&](const SessionLook& other) {
        return same_lighting(other.look, look);
    });
    begin_disabled(shared);
    if (ImGui::Button("Same light for all looks")) commit(studio, ShareLighting{studio.shown_look});
    name_last_item("share-lighting");
    tooltip("Gives every look these lights and this environment, so that only the paints differ.");
    end_disabled();
    if (looks.size() > 1) {
        dim_text(shared ? "All looks have this light." : "Other looks have another light.");
    }
}

void draw_eye_angles(Studio& studio, glm::dvec3& eye_mm) {
    const glm::dvec3 centre = product_centre(studio);
    Held<glm::dvec3>& held = studio.panels.of<LightingPanelState>().held_eye_mm;
    const auto row = [&](const char* label, const char* name, const char* meaning, auto change) {
        Polar polar = polar_of(eye_mm, centre);
        row_label(label);
        change(polar);
        if (last_item_is_held()) eye_mm = point_of(polar, centre);
        name_last_item(name);
        tooltip(meaning);
        held.after_item();
        edit_with_last_item(studio, SetEye{eye_mm});
    };
    row("Distance", "eye:distance", "From the middle of the mock-up.", [](Polar& polar) {
        ratio_slider("##distance", polar.distance_mm, 100.0, 10000.0, "%.0f mm");
    });
    row("Azimuth",
        "eye:azimuth",
        "0° is behind the product (-z), 90° on its right (+x).",
        [](Polar& polar) {
            number_slider("##azimuth", polar.angles.azimuth_deg, -180.0, 180.0, "%.1f°");
        });
    row("Elevation", "eye:elevation", "0° is level with the mock-up's middle.", [](Polar& polar) {
        number_slider("##elevation", polar.angles.elevation_deg, -89.9, 89.9, "%.1f°");
    });
    vector_row(
        "x, y, z (mm)", "eye", eye_mm, 2.0f, "%.0f", "In the product's frame: y is up.", [&] {
            held.after_item();
            edit_with_last_item(studio, SetEye{eye_mm});
        });
}

/// Read once a bench: a panel is drawn sixty times a second.
std::optional<glm::dvec3> observer_mm(Studio& studio) {
    LightingPanelState& state = studio.panels.of<LightingPanelState>();
    const std::string& bench = studio.session.document().bench;
    if (state.observer_of == bench) return state.observer_mm;
    state.observer_of = bench;
    state.observer_mm.reset();
    try {
        state.observer_mm = read_bench_file(bench).eye_mm;
    } catch (const FileError&) {
        // The calibration's tab says what is wrong with the bench.
    }
    return state.observer_mm;
}

void draw_eye_at_observer(Studio& studio) {
    const auto observer = observer_mm(studio);
    const bool there = observer && *observer == eye_in_use_mm(studio.session.document());
    begin_disabled(!observer || there);
    if (ImGui::Button("Eye at the bench's observer") && observer) {
        commit(studio, SetEye{*observer});
    }
    end_disabled();
    name_last_item("eye-at-observer");
    tooltip(there ? "The eye stands there: where the bench measures what an observer sees."
                  : "Puts the eye back where the bench measures what an observer sees. The "
                    "photograph is taken from the eye, wherever it stands.");
}

void draw_eye(Studio& studio) {
    LightingPanelState& state = studio.panels.of<LightingPanelState>();
    heading("Eye");
    tooltip(
        "Where the audience looks from: highlights sit where this eye sees them, and the "
        "photograph is taken from here.");
    ImGui::PushID("eye");
    glm::dvec3& eye_mm = state.held_eye_mm.start(eye_in_use_mm(studio.session.document()));
    draw_eye_angles(studio, eye_mm);
    state.held_eye_mm.finish();
    draw_eye_at_observer(studio);
    if (ImGui::Button("Seats in the room…")) show_panel(studio, "seats");
    name_last_item("open-seats");
    tooltip("Where people sit in a plan of the room, whose eye this is, and what others miss.");
    const Document& document = studio.session.document();
    if (document.eye_choice.source != EyeSource::by_hand) {
        dim_text(fmt::format("It is {}; moving it here sets it by hand.",
                             in_words(document.seats, document.eye_choice)));
        name_last_item("eye:of");
    }
    ImGui::PopID();
}

void draw_exposure(Studio& studio) {
    LightingPanelState& state = studio.panels.of<LightingPanelState>();
    heading("Exposure");
    double& ev = state.held_ev.start(studio.session.document().exposure_ev);
    row_label("Exposure");
    number_slider("##exposure", ev, -6.0, 6.0, "%+.2f EV");
    name_last_item("exposure");
    tooltip("Brightness of all looks alike; +1 doubles it.");
    state.held_ev.after_item();
    edit_with_last_item(studio, SetExposure{ev});
    state.held_ev.finish();
}

}  // namespace

void draw_lighting_panel(Studio& studio) {
    LightingPanelState& state = studio.panels.of<LightingPanelState>();
    const SessionLook* shown = find_look(studio.session.document(), studio.shown_look);
    if (!shown) {
        dim_text("There is no look to light.");
        return;
    }
    draw_solving(studio);
    const Look before = shown->look;
    // Another look, or undo while a control is held: its lights count, not the held ones.
    if (state.lit_look != studio.shown_look) state.held = {};
    state.lit_look = studio.shown_look;
    Look& edited = state.held.start(before);
    if (edited.lights.size() != before.lights.size()) edited = before;
    draw_lights(studio, edited, before);
    ImGui::Spacing();
    heading("Environment");
    draw_environment_choice(studio, edited.environment, [&] {
        state.held.after_item();
        edit_with_last_item(studio, SetEnvironment{studio.shown_look, edited.environment});
    });
    state.held.finish();
    draw_sharing(studio, before);
    ImGui::Spacing();
    draw_eye(studio);
    ImGui::Spacing();
    draw_exposure(studio);
    ImGui::Spacing();
    draw_quality_section(studio);
}

Panel lighting_panel() {
    return {.name = "Light",
            .place = PanelPlace::tab,
            .draw = draw_lighting_panel,
            .step = take_traced,
            .stop = [](Studio& s) { s.panels.of<ReferenceTracing>().thread.reset(); },
            .next_change_s =
                [](const Studio& s) { return is_tracing(s) ? s.now_s + kProgress_s : 0.0; },
            .holds_picture = is_tracing};
}

}  // namespace livery
