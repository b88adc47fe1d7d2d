// The middle of the window: one of four pictures of the product, and the wipe.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "studio/artwork/artwork_edit.h"
#include "studio/artwork/artwork_values.h"
#include "studio/drawing.h"
#include "studio/seats/seats_panel.h"
#include "studio/studio.h"

namespace livery {

namespace {

/// While B is held everything else in the window is about A.
void draw_held_name(const Studio& studio, const StageFrame& stage) {
    if (!studio.showing_b || !studio.compared_look) return;
    const SessionLook* look = find_look(studio.session.document(), *studio.compared_look);
    if (!look) return;
    ImFont* font = large_font();
    const float pad = em(0.5f), width = stage.width - 6.0f * pad;
    ImGui::PushFont(font);
    const auto lines = fitted_lines("B   " + look->look.name, width, 1);
    ImGui::PopFont();
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0f, lines.front().c_str());
    // At the lower right: notices and captions have the other corners.
    const ImVec2 at(std::round(stage.x + stage.width - size.x - 4.0f * pad),
                    stage.y + stage.height - size.y - 2.0f * pad);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({at.x - 2.0f * pad, at.y - pad},
                       {at.x + size.x + 2.0f * pad, at.y + size.y + pad},
                       IM_COL32(0, 0, 0, 190),
                       em(0.25f));
    list.AddText(
        font, font->FontSize, at, ImGui::GetColorU32(colours::text), lines.front().c_str());
    name_rectangle("held-b-name", at.x, at.y, size.x, size.y);
}

/// Over the picture's upper edge, while the next click means something else than usual.
void draw_placing(const Studio& studio, const StageFrame& stage) {
    if (!is_placing(studio)) return;
    const std::string text =
        fmt::format("Click where \"{}\" goes. Esc takes it back.",
                    shown_name(shown_artwork(studio)[*chosen_artwork(studio)]));
    const float pad = em(0.5f), width = stage.width - 4.0f * pad;
    const auto lines = fitted_lines(text, width - 2.0f * pad, 3);
    const float height = static_cast<float>(lines.size()) * ImGui::GetFontSize() * 1.15f;
    const ImVec2 low(stage.x + 2.0f * pad, stage.y + 2.0f * pad);
    ImGui::GetWindowDrawList()->AddRectFilled(
        low,
        {low.x + width, low.y + height + 2.0f * pad},
        ImGui::GetColorU32(ImVec4(colours::accent.x, colours::accent.y, colours::accent.z, 0.9f)),
        em(0.25f));
    centred_lines(lines, {low.x, low.y + pad}, width, colours::text);
}

/// What the pointer does with the stage in this frame.
struct Pointer {
    bool hovered = false, pressed = false, held = false, released = false;
};

void show_view(Studio& studio, StageView view) {
    studio.view = view;
    studio.clicked_a_view = true;
    show_seat_map(studio, false);
}

void draw_view_buttons(Studio& studio) {
    struct Choice {
        StageView view;
        const char *label, *name, *help;
    };
    static constexpr Choice choices[] = {
        {StageView::preview,
         "Preview",
         "view:preview",
         "The product from any side. Drag to turn it, the wheel zooms, a click chooses a part."},
        {StageView::eye,
         "Eye",
         "view:eye",
         "From where the audience stands: highlights are drawn for this point."},
        {StageView::projector,
         "Projector",
         "view:projector",
         "What goes to the projector, pixel by pixel."},
        {StageView::photograph,
         "Photograph",
         "view:photograph",
         "A photograph of the mock-up on the simulated bench, taken from the audience's eye: what "
         "they would see."}};
    for (const Choice& choice : choices) {
        const bool on = studio.view == choice.view && !shows_seat_map(studio);
        if (named(toggle_button(choice.label, on), choice.name, choice.help))
            show_view(studio, choice.view);
        ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
    }
}

void draw_compare_buttons(Studio& studio) {
    // With their keys, as Black and Freeze have theirs.
    const char *compare = "Compare  Space", *wipe = "Wipe  W";
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float left =
        ImGui::GetWindowContentRegionMax().x - button_width(compare) - gap - button_width(wipe);
    // A line of their own where the column is too narrow for both.
    if (ImGui::GetCursorPosX() + gap > left) ImGui::NewLine();
    ImGui::SetCursorPosX(std::max(left, ImGui::GetCursorStartPos().x));
    begin_disabled(!studio.compared_look);
    ImGui::PushStyleColor(ImGuiCol_Text, colours::text);
    chip(compare, studio.showing_b);
    const bool over = ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    if (ImGui::IsItemActivated()) studio.showing_b = true;
    if (ImGui::IsItemDeactivated()) studio.showing_b = false;
    name_last_item("hold-b");
    if (over && !studio.showing_b) {
        const SessionLook* b = studio.compared_look
                                   ? find_look(studio.session.document(), *studio.compared_look)
                                   : nullptr;
        tooltip(b ? "While it or the space bar is held, shows B: " + b->look.name + "."
                  : "Shows B, the look to compare with, while held. Needs a second look.");
    }
    ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
    if (chip(wipe, studio.wiping)) studio.wiping = !studio.wiping;
    ImGui::PopStyleColor();
    end_disabled();
    name_last_item("wipe");
    tooltip("A on the left, B on the right of a line that you can drag.");
}

/// Fitted, in whole pixels, then zoomed about a point of the picture.
StageFrame place_picture(const StageFrame& stage, int width, int height, const PictureZoom& zoom) {
    const double fit = std::min(static_cast<double>(stage.width) / width,
                                static_cast<double>(stage.height) / height);
    const double scale = fit * zoom.factor;
    StageFrame frame;
    frame.width = static_cast<float>(std::round(width * scale));
    frame.height = static_cast<float>(std::round(height * scale));
    const auto at = [](float from, float size, double point, float picture) {
        return std::round(from + 0.5f * size - static_cast<float>(point) * picture);
    };
    frame.x = at(stage.x, stage.width, zoom.x, frame.width);
    frame.y = at(stage.y, stage.height, zoom.y, frame.height);
    return frame;
}

void draw_texture(unsigned texture, const StageFrame& frame) {
    ImGui::GetWindowDrawList()->AddImage(imgui_texture(texture),
                                         {frame.x, frame.y},
                                         {frame.x + frame.width, frame.y + frame.height});
}

void draw_message(const StageFrame& stage, const std::string& text) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, stage.width * 0.8f);
    ImGui::SetCursorScreenPos(
        {stage.x + 0.5f * (stage.width - size.x), stage.y + 0.5f * (stage.height - size.y)});
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + stage.width * 0.8f);
    ImGui::TextColored(colours::dim_text, "%s", text.c_str());
    ImGui::PopTextWrapPos();
}

/// Words over the picture's lower left corner; what is not as it will be comes last.
void draw_caption(const Studio& studio, const StageFrame& stage, std::string text) {
    const auto& frame = studio.frame;
    const bool waits = frame && !frame->unfinished.empty() && studio.instead.caption.empty();
    std::string unfinished = waits ? "Not all there yet: " + frame->unfinished : "";
    if (const auto solving = studio.frames->solving(); waits && solving) {
        unfinished += fmt::format(", {:.0f}%", 100.0 * solving->fraction);
    }
    if (text.empty() && unfinished.empty()) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImFont* font = small_font();
    const float pad = em(0.4f), wrap = stage.width - 6.0f * pad;
    const auto size_of = [&](const std::string& line) {
        return line.empty() ? ImVec2(0.0f, 0.0f)
                            : font->CalcTextSizeA(font->FontSize, FLT_MAX, wrap, line.c_str());
    };
    const ImVec2 above = size_of(text), below = size_of(unfinished);
    const ImVec2 at(stage.x + 2.0f * pad, stage.y + stage.height - above.y - below.y - 2.0f * pad);
    list.AddRectFilled(
        {at.x - pad, at.y - 0.5f * pad},
        {at.x + std::max(above.x, below.x) + pad, at.y + above.y + below.y + 0.5f * pad},
        IM_COL32(0, 0, 0, 150),
        em(0.25f));
    const auto add = [&](const ImVec2& where, const ImVec4& colour, const std::string& line) {
        list.AddText(
            font, font->FontSize, where, ImGui::GetColorU32(colour), line.c_str(), nullptr, wrap);
    };
    add(at, colours::text, text);
    add({at.x, at.y + above.y}, colours::warning, unfinished);
}

/// The point under the pointer stays there.
void zoom_picture(PictureZoom& zoom, const StageFrame& picture, float notches) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const double factor =
        std::clamp(zoom.factor * std::pow(1.15, static_cast<double>(notches)), 1.0, 32.0);
    const auto u = static_cast<double>((mouse.x - picture.x) / picture.width);
    const auto v = static_cast<double>((mouse.y - picture.y) / picture.height);
    const double change = zoom.factor / factor;
    zoom = {factor, u + (zoom.x - u) * change, v + (zoom.y - v) * change};
    if (factor <= 1.0) zoom = {};
}

/// Wheel, drag and double click for a picture that is only looked at.
void handle_picture(PictureZoom& zoom, const StageFrame& picture, const Pointer& pointer) {
    if (picture.width <= 0.0f) return;
    const ImGuiIO& io = ImGui::GetIO();
    if (pointer.hovered && io.MouseWheel != 0.0f) zoom_picture(zoom, picture, io.MouseWheel);
    if (pointer.hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) zoom = {};
    if (pointer.held && zoom.factor > 1.0) {
        const auto moved = [](double at, float by) {
            return std::clamp(at - static_cast<double>(by), 0.0, 1.0);
        };
        zoom.x = moved(zoom.x, io.MouseDelta.x / picture.width);
        zoom.y = moved(zoom.y, io.MouseDelta.y / picture.height);
    }
}

void choose_part_at_pointer(Studio& studio, const StageFrame& stage) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const View view = stage_view(studio, eye_in_use_mm(studio.session.document()));
    const auto part = studio.picker->part_at(
        view, {static_cast<double>(mouse.x - stage.x), static_cast<double>(mouse.y - stage.y)});
    if (part) {
        select_part(studio, *part);
    } else {
        studio.selected_part.reset();
    }
}

/// What of the chosen artwork's new place the pointer says; true while it has the pointer.
bool handle_placing(Studio& studio, const Pointer& pointer, const glm::dvec2& at) {
    if (!is_placing(studio)) return false;
    const bool turning = pointer.held && studio.stage.dragged;
    std::optional<PickedPoint> point;
    if (pointer.hovered && !turning) {
        point = studio.picker->point_at(
            stage_view(studio, eye_in_use_mm(studio.session.document())), at);
    }
    if (point) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (pointer.hovered) try_placing(studio, point);
    if (pointer.released && pointer.hovered && !studio.stage.dragged && point)
        place(studio, *point);
    return true;
}

/// Turning, zooming and choosing parts in a picture drawn for this stage.
void handle_view(Studio& studio, const StageFrame& stage, const Pointer& pointer) {
    StageState& state = studio.stage;
    const ImGuiIO& io = ImGui::GetIO();
    const bool orbiting = studio.view == StageView::preview;
    const glm::ivec2 size_px(state.width, state.height);
    const glm::dvec2 at(static_cast<double>(io.MousePos.x - stage.x),
                        static_cast<double>(io.MousePos.y - stage.y));
    const glm::dvec2 moved(static_cast<double>(io.MouseDelta.x),
                           static_cast<double>(io.MouseDelta.y));
    if (pointer.hovered && io.MouseWheel != 0.0f) {
        const auto steps = static_cast<double>(io.MouseWheel);
        if (orbiting) {
            state.orbit = zoomed(stage_orbit(studio), steps, studio.product_bounds, at, size_px);
        } else {
            state.eye_zoom = std::clamp(state.eye_zoom * std::pow(1.1, steps), 0.5, 8.0);
        }
    }
    if (pointer.hovered && orbiting && ImGui::IsMouseDragging(ImGuiMouseButton_Middle)) {
        state.orbit = panned(stage_orbit(studio), moved, size_px.y, studio.product_bounds);
    }
    if (pointer.pressed) state.dragged = false;
    if (pointer.held && ImGui::IsMouseDragging(ImGuiMouseButton_Left, em(0.25f))) {
        state.dragged = true;
        if (orbiting) state.orbit = turned(stage_orbit(studio), moved, size_px.y);
    }
    if (handle_placing(studio, pointer, at)) return;
    if (pointer.hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        state.orbit.reset();
        state.eye_zoom = 1.0;
    }
    if (pointer.released && pointer.hovered && !state.dragged)
        choose_part_at_pointer(studio, stage);
}

StageFrame projector_picture(const Studio& studio, const StageFrame& stage) {
    const auto& frame = studio.frame;
    if (!frame) return stage;
    return place_picture(stage, frame->size_px.x, frame->size_px.y, studio.stage.projector);
}

StageFrame photograph_picture(const Studio& studio, const StageFrame& stage) {
    const auto& photograph = studio.photograph;
    if (!photograph || photograph->srgb.empty()) return stage;
    return place_picture(
        stage, photograph->srgb.width, photograph->srgb.height, studio.stage.photograph);
}

/// The photograph shows the wipe on the mock-up, where no straight line of ours would lie.
bool has_wipe_line(const Studio& studio) {
    return studio.wiping && studio.compared_look && studio.view != StageView::photograph;
}

/// Where the wipe's line lies: across the mock-up in the projector's picture, across the stage in
/// the others, which have no columns of the projector.
std::pair<float, float> wipe_range(const Studio& studio, const StageFrame& stage) {
    const StageFrame picture = projector_picture(studio, stage);
    if (studio.view != StageView::projector || !studio.mock_up_columns || !studio.setup) {
        return {stage.x, stage.x + stage.width};
    }
    const double width = studio.setup->view.width;
    const auto at = [&](double column) {
        return picture.x + picture.width * static_cast<float>(column / width);
    };
    return {at(studio.mock_up_columns->first), at(studio.mock_up_columns->second)};
}

float wipe_line(const Studio& studio, const StageFrame& stage) {
    const auto [left, right] = wipe_range(studio, stage);
    return std::round(left + (right - left) * static_cast<float>(studio.wipe_at));
}

/// True while the line has the pointer.
bool handle_wipe(Studio& studio, const StageFrame& stage, const Pointer& pointer) {
    StageState& state = studio.stage;
    if (!pointer.held) state.dragging_wipe = false;
    if (!has_wipe_line(studio)) return false;
    const float mouse_x = ImGui::GetIO().MousePos.x;
    const bool near = pointer.hovered && std::abs(mouse_x - wipe_line(studio, stage)) < em(0.6f);
    if (pointer.pressed) state.dragging_wipe = near;
    const auto [left, right] = wipe_range(studio, stage);
    if (state.dragging_wipe && right > left) {
        studio.wipe_at =
            std::clamp(static_cast<double>((mouse_x - left) / (right - left)), 0.0, 1.0);
    }
    state.wipe_lit = state.dragging_wipe || (near && !pointer.held);
    if (state.wipe_lit) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    // Letting the line go is no click on a part.
    return state.wipe_lit || (near && pointer.released);
}

void draw_wipe(const Studio& studio, const StageFrame& stage) {
    if (!has_wipe_line(studio)) return;
    const float x = wipe_line(studio, stage);
    const float bottom = stage.y + stage.height, grip = stage.y + 0.5f * stage.height;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine({x, stage.y}, {x, bottom}, IM_COL32(0, 0, 0, 160), em(0.25f));
    list.AddLine({x, stage.y}, {x, bottom}, IM_COL32(235, 235, 235, 255), em(0.1f));
    list.AddRectFilled(
        {x - em(0.3f), grip - em(1.2f)},
        {x + em(0.3f), grip + em(1.2f)},
        studio.stage.wipe_lit ? IM_COL32(255, 255, 255, 255) : IM_COL32(205, 205, 205, 255),
        em(0.3f));
    name_rectangle("wipe-line", x - em(0.3f), grip - em(1.2f), em(0.6f), em(2.4f));
    const auto name = [&](int id) {
        const SessionLook* look = find_look(studio.session.document(), id);
        return look ? look->look.name : std::string();
    };
    const std::string a = "A  " + name(studio.shown_look), b = "B  " + name(*studio.compared_look);
    const ImU32 colour = ImGui::GetColorU32(colours::text);
    const float top = stage.y + em(0.5f);
    list.AddText({x - ImGui::CalcTextSize(a.c_str()).x - em(0.6f), top}, colour, a.c_str());
    list.AddText({x + em(0.6f), top}, colour, b.c_str());
}

void draw_drawn_view(Studio& studio, const StageFrame& stage) {
    studio.stage.width = static_cast<int>(stage.width);
    studio.stage.height = static_cast<int>(stage.height);
    const auto& preview = studio.preview;
    const bool of_view = preview && is_of_view(studio.preview_lag, preview->number, studio.view);
    if (!of_view || preview->texture == 0) {
        const bool failed = preview && !preview->problem.empty();
        draw_message(stage, failed ? preview->problem : "Drawing the product…");
        return;
    }
    preview->ready->wait_on_device();
    StageFrame picture = stage;
    if (preview->size_px != glm::ivec2(studio.stage.width, studio.stage.height)) {
        picture = place_picture(stage, preview->size_px.x, preview->size_px.y, {});
    }
    draw_texture(preview->texture, picture);
    const auto behind_since = behind_since_s(studio.preview_lag, preview->number);
    const bool behind = behind_since && studio.now_s - *behind_since > kTellsLag_s;
    draw_caption(studio,
                 stage,
                 behind                ? "The last change is still being drawn."
                 : preview->unfinished ? "Light and shadows are being solved."
                                       : "");
    draw_placing(studio, stage);
}

void draw_projector_view(Studio& studio, const StageFrame& stage) {
    if (!studio.frame) {
        draw_message(stage, "Preparing the projector's picture…");
        return;
    }
    const FinishedFrame& frame = *studio.frame;
    frame.ready->wait_on_device();
    const StageFrame picture = projector_picture(studio, stage);
    if (studio.instead.picture && !studio.instead.caption.empty()) {
        draw_texture(studio.instead.picture->texture, picture);
        return draw_caption(studio, stage, studio.instead.caption);
    }
    draw_texture(frame.drive_texture, picture);
    std::string caption = fmt::format("{} × {} pixels, ", frame.size_px.x, frame.size_px.y);
    caption += studio.setup && studio.setup->table
                   ? "corrected"
                   : "uncorrected: " + (studio.setup ? studio.setup->why_uncorrected : "");
    if (studio.stage.projector.factor > 1.0) {
        caption +=
            fmt::format(", {:.0f}%", 100.0f * picture.width / static_cast<float>(frame.size_px.x));
    }
    draw_caption(studio, stage, caption);
}

void draw_photograph(Studio& studio, const StageFrame& stage) {
    const auto& photograph = studio.photograph;
    if (!photograph || photograph->srgb.empty()) {
        std::string text =
            "Photographing the mock-up on the simulated bench…\nThe first one takes a few seconds.";
        if (photograph && !photograph->problem.empty()) {
            text = photograph->problem;
        } else if (studio.bench->calibrating().running) {
            text =
                "The simulated bench is being calibrated.\nIt photographs again when that is done.";
        }
        draw_message(stage, text);
        return;
    }
    StageState& state = studio.stage;
    const Image8& srgb = photograph->srgb;
    if (state.photograph_in_texture != photograph) {
        state.photograph_in_texture = photograph;
        state.photograph_texture = texture_of(srgb);
    }
    const StageFrame picture = photograph_picture(studio, stage);
    draw_texture(state.photograph_texture.name(), picture);
    const bool behind = studio.frame && photograph->number < studio.frame->number;
    std::string caption = "The mock-up on the simulated bench, from the audience's eye";
    if (behind) {
        caption += studio.bench->calibrating().running
                       ? ", as it was before the calibration that is running"
                       : ", a moment ago…";
    }
    if (!photograph->problem.empty()) caption += ": " + photograph->problem;
    draw_caption(studio, stage, caption);
}

}  // namespace

bool draw_stage(Studio& studio) {
    draw_view_buttons(studio);
    draw_compare_buttons(studio);
    const ImVec2 from = ImGui::GetCursorScreenPos(), space = ImGui::GetContentRegionAvail();
    const StageFrame stage{std::floor(from.x),
                           std::floor(from.y),
                           std::max(std::floor(space.x), 16.0f),
                           std::max(std::floor(space.y), 16.0f)};
    studio.stage_x = stage.x;
    studio.stage_y = stage.y;
    ImGui::GetWindowDrawList()->AddRectFilled({stage.x, stage.y},
                                              {stage.x + stage.width, stage.y + stage.height},
                                              IM_COL32(18, 18, 18, 255),
                                              em(0.25f));
    ImGui::PushClipRect({stage.x, stage.y}, {stage.x + stage.width, stage.y + stage.height}, true);
    ImGui::PushAllowKeyboardFocus(false);  // only the pointer means anything here
    ImGui::InvisibleButton("stage", {stage.width, stage.height});
    ImGui::PopAllowKeyboardFocus();
    name_last_item("stage");
    const Pointer pointer{ImGui::IsItemHovered(),
                          ImGui::IsItemActivated(),
                          ImGui::IsItemActive(),
                          ImGui::IsItemDeactivated()};
    if (shows_seat_map(studio)) {
        const glm::ivec2 size = seat_map_size(studio);
        const StageFrame picture =
            size.x > 0 ? place_picture(stage, size.x, size.y, studio.stage.projector) : stage;
        handle_picture(studio.stage.projector, picture, pointer);
        draw_seat_map(studio, picture, stage);
        ImGui::PopClipRect();
        return true;
    }
    const StageView view = studio.view;
    if (!handle_wipe(studio, stage, pointer)) {
        if (view == StageView::projector) {
            handle_picture(studio.stage.projector, projector_picture(studio, stage), pointer);
        } else if (view == StageView::photograph) {
            handle_picture(studio.stage.photograph, photograph_picture(studio, stage), pointer);
        } else {
            handle_view(studio, stage, pointer);
        }
    }
    if (view == StageView::projector) {
        draw_projector_view(studio, stage);
    } else if (view == StageView::photograph) {
        draw_photograph(studio, stage);
    } else {
        draw_drawn_view(studio, stage);
    }
    draw_wipe(studio, stage);
    draw_held_name(studio, stage);
    ImGui::PopClipRect();
    return true;
}

namespace {

std::vector<Action> view_actions() {
    const auto view = [](const char* id, const char* label, int function_key, StageView what) {
        return Action{id,
                      "View",
                      label,
                      {key(function_key)},
                      [what](Studio& s) { show_view(s, what); },
                      {},
                      [what](const Studio& s) { return s.view == what; }};
    };
    return {
        view("view-preview", "Preview", GLFW_KEY_F5, StageView::preview),
        view("view-eye", "From the audience's eye", GLFW_KEY_F6, StageView::eye),
        view("view-projector", "Projector picture", GLFW_KEY_F7, StageView::projector),
        view("view-photograph", "Photograph of the mock-up", GLFW_KEY_F8, StageView::photograph)};
}

}  // namespace

Panel stage_panel() { return {.name = "stage", .draw_stage = draw_stage, .actions = view_actions}; }

}  // namespace livery
