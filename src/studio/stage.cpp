// The middle of the window: one of four pictures of the product, and the wipe.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "gl/handles.h"
#include "studio/artwork/artwork_edit.h"
#include "studio/artwork/artwork_values.h"
#include "studio/kit/theme.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"
#include "studio/nudge/nudge_panel.h"
#include "studio/seats/seat_maps.h"
#include "studio/stage_words.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

/// What the pointer does with the stage in this frame.
struct Pointer {
    bool hovered = false, pressed = false, held = false, released = false;
};

void draw_view_buttons(Shell& shell) {
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
        const bool on = shell.studio.view == choice.view && !shows_seat_map(shell.studio);
        if (toggle_button(choice.label, on)) {
            shell.studio.view = choice.view;
            shell.clicked_a_view = true;
            show_seat_map(shell.studio, false);
        }
        name_last_item(choice.name);
        tooltip(choice.help);
        ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
    }
}

void draw_compare_buttons(Shell& shell) {
    Studio& studio = shell.studio;
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
void draw_caption(const Shell& shell, const StageFrame& stage, std::string text) {
    const auto& frame = shell.studio.frame;
    const bool waits = frame && !frame->unfinished.empty() && !shell.nudge_open;
    std::string unfinished = waits ? "Not all there yet: " + frame->unfinished : "";
    if (const auto solving = shell.studio.frames->solving(); waits && solving) {
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

void choose_part_at_pointer(Shell& shell, const StageFrame& stage) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const View view = stage_view(shell, eye_in_use_mm(shell.studio.session.document()));
    const auto part = shell.studio.picker->part_at(
        view, {static_cast<double>(mouse.x - stage.x), static_cast<double>(mouse.y - stage.y)});
    if (part) {
        select_part(shell.studio, *part);
    } else {
        shell.studio.selected_part.reset();
    }
}

/// What of the chosen artwork's new place the pointer says; true while it has the pointer.
bool handle_placing(Shell& shell, const Pointer& pointer, const glm::dvec2& at) {
    Studio& studio = shell.studio;
    if (!is_placing(studio)) return false;
    const bool turning = pointer.held && shell.stage.dragged;
    std::optional<PickedPoint> point;
    if (pointer.hovered && !turning) {
        point = studio.picker->point_at(stage_view(shell, eye_in_use_mm(studio.session.document())),
                                        at);
    }
    if (point) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (pointer.hovered) try_placing(studio, point);
    if (pointer.released && pointer.hovered && !shell.stage.dragged && point) place(studio, *point);
    return true;
}

/// Turning, zooming and choosing parts in a picture drawn for this stage.
void handle_view(Shell& shell, const StageFrame& stage, const Pointer& pointer) {
    StageState& state = shell.stage;
    const ImGuiIO& io = ImGui::GetIO();
    const bool orbiting = shell.studio.view == StageView::preview;
    const glm::ivec2 size_px(state.width, state.height);
    const glm::dvec2 at(static_cast<double>(io.MousePos.x - stage.x),
                        static_cast<double>(io.MousePos.y - stage.y));
    const glm::dvec2 moved(static_cast<double>(io.MouseDelta.x),
                           static_cast<double>(io.MouseDelta.y));
    if (pointer.hovered && io.MouseWheel != 0.0f) {
        const auto steps = static_cast<double>(io.MouseWheel);
        if (orbiting) {
            state.orbit = zoomed(stage_orbit(shell), steps, shell.product_bounds, at, size_px);
        } else {
            state.eye_zoom = std::clamp(state.eye_zoom * std::pow(1.1, steps), 0.5, 8.0);
        }
    }
    if (pointer.hovered && orbiting && ImGui::IsMouseDragging(ImGuiMouseButton_Middle)) {
        state.orbit = panned(stage_orbit(shell), moved, size_px.y, shell.product_bounds);
    }
    if (pointer.pressed) state.dragged = false;
    if (pointer.held && ImGui::IsMouseDragging(ImGuiMouseButton_Left, em(0.25f))) {
        state.dragged = true;
        if (orbiting) state.orbit = turned(stage_orbit(shell), moved, size_px.y);
    }
    if (handle_placing(shell, pointer, at)) return;
    if (pointer.hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        state.orbit.reset();
        state.eye_zoom = 1.0;
    }
    if (pointer.released && pointer.hovered && !state.dragged) choose_part_at_pointer(shell, stage);
}

StageFrame projector_picture(const Shell& shell, const StageFrame& stage) {
    const auto& frame = shell.studio.frame;
    if (!frame) return stage;
    return place_picture(stage, frame->size_px.x, frame->size_px.y, shell.stage.projector);
}

StageFrame photograph_picture(const Shell& shell, const StageFrame& stage) {
    const auto& photograph = shell.studio.photograph;
    if (!photograph || photograph->srgb.empty()) return stage;
    return place_picture(
        stage, photograph->srgb.width, photograph->srgb.height, shell.stage.photograph);
}

/// The photograph shows the wipe on the mock-up, where no straight line of ours would lie.
bool has_wipe_line(const Studio& studio) {
    return studio.wiping && studio.compared_look && studio.view != StageView::photograph;
}

/// Where the wipe's line lies: across the mock-up in the projector's picture, across the stage in
/// the others, which have no columns of the projector.
std::pair<float, float> wipe_range(const Shell& shell, const StageFrame& stage) {
    const Studio& studio = shell.studio;
    const StageFrame picture = projector_picture(shell, stage);
    if (studio.view != StageView::projector || !shell.mock_up_columns || !studio.setup) {
        return {stage.x, stage.x + stage.width};
    }
    const double width = studio.setup->view.width;
    const auto at = [&](double column) {
        return picture.x + picture.width * static_cast<float>(column / width);
    };
    return {at(shell.mock_up_columns->first), at(shell.mock_up_columns->second)};
}

float wipe_line(const Shell& shell, const StageFrame& stage) {
    const auto [left, right] = wipe_range(shell, stage);
    return std::round(left + (right - left) * static_cast<float>(shell.studio.wipe_at));
}

/// True while the line has the pointer.
bool handle_wipe(Shell& shell, const StageFrame& stage, const Pointer& pointer) {
    Studio& studio = shell.studio;
    StageState& state = shell.stage;
    if (!pointer.held) state.dragging_wipe = false;
    if (!has_wipe_line(studio)) return false;
    const float mouse_x = ImGui::GetIO().MousePos.x;
    const bool near = pointer.hovered && std::abs(mouse_x - wipe_line(shell, stage)) < em(0.6f);
    if (pointer.pressed) state.dragging_wipe = near;
    const auto [left, right] = wipe_range(shell, stage);
    if (state.dragging_wipe && right > left) {
        studio.wipe_at =
            std::clamp(static_cast<double>((mouse_x - left) / (right - left)), 0.0, 1.0);
    }
    state.wipe_lit = state.dragging_wipe || (near && !pointer.held);
    if (state.wipe_lit) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    // Letting the line go is no click on a part.
    return state.wipe_lit || (near && pointer.released);
}

void draw_wipe(const Shell& shell, const StageFrame& stage) {
    const Studio& studio = shell.studio;
    if (!has_wipe_line(studio)) return;
    const float x = wipe_line(shell, stage);
    const float bottom = stage.y + stage.height, grip = stage.y + 0.5f * stage.height;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine({x, stage.y}, {x, bottom}, IM_COL32(0, 0, 0, 160), em(0.25f));
    list.AddLine({x, stage.y}, {x, bottom}, IM_COL32(235, 235, 235, 255), em(0.1f));
    list.AddRectFilled(
        {x - em(0.3f), grip - em(1.2f)},
        {x + em(0.3f), grip + em(1.2f)},
        shell.stage.wipe_lit ? IM_COL32(255, 255, 255, 255) : IM_COL32(205, 205, 205, 255),
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

void draw_drawn_view(Shell& shell, const StageFrame& stage) {
    shell.stage.width = static_cast<int>(stage.width);
    shell.stage.height = static_cast<int>(stage.height);
    const auto& preview = shell.studio.preview;
    const bool of_view =
        preview && is_of_view(shell.preview_lag, preview->number, shell.studio.view);
    if (!of_view || preview->texture == 0) {
        const bool failed = preview && !preview->problem.empty();
        draw_message(stage, failed ? preview->problem : "Drawing the product…");
        return;
    }
    preview->ready->wait_on_device();
    StageFrame picture = stage;
    if (preview->size_px != glm::ivec2(shell.stage.width, shell.stage.height)) {
        picture = place_picture(stage, preview->size_px.x, preview->size_px.y, {});
    }
    draw_texture(preview->texture, picture);
    const auto behind_since = behind_since_s(shell.preview_lag, preview->number);
    const bool behind = behind_since && shell.studio.now_s - *behind_since > kTellsLag_s;
    draw_caption(shell,
                 stage,
                 behind                ? "The last change is still being drawn."
                 : preview->unfinished ? "Light and shadows are being solved."
                                       : "");
    draw_placing(shell.studio, stage);
}

void draw_projector_view(Shell& shell, const StageFrame& stage) {
    const Studio& studio = shell.studio;
    if (!studio.frame) {
        draw_message(stage, "Preparing the projector's picture…");
        return;
    }
    const FinishedFrame& frame = *studio.frame;
    frame.ready->wait_on_device();
    const StageFrame picture = projector_picture(shell, stage);
    const auto& lines = studio.panels.nudge->picture;
    if (shell.nudge_open && lines) {
        draw_texture(lines->texture, picture);
        return draw_caption(shell, stage, "The mock-up's lines, as the projector draws them");
    }
    draw_texture(frame.drive_texture, picture);
    std::string caption = fmt::format("{} × {} pixels, ", frame.size_px.x, frame.size_px.y);
    caption += studio.setup && studio.setup->table
                   ? "corrected"
                   : "uncorrected: " + (studio.setup ? studio.setup->why_uncorrected : "");
    if (shell.stage.projector.factor > 1.0) {
        caption +=
            fmt::format(", {:.0f}%", 100.0f * picture.width / static_cast<float>(frame.size_px.x));
    }
    draw_caption(shell, stage, caption);
}

void draw_photograph(Shell& shell, const StageFrame& stage) {
    const auto& photograph = shell.studio.photograph;
    if (!photograph || photograph->srgb.empty()) {
        std::string text =
            "Photographing the mock-up on the simulated bench…\nThe first one takes a few seconds.";
        if (photograph && !photograph->problem.empty()) {
            text = photograph->problem;
        } else if (shell.studio.bench->calibrating().running) {
            text =
                "The simulated bench is being calibrated.\nIt photographs again when that is done.";
        }
        draw_message(stage, text);
        return;
    }
    StageState& state = shell.stage;
    const Image8& srgb = photograph->srgb;
    if (state.photograph_in_texture != photograph) {
        state.photograph_in_texture = photograph;
        Image8 rgba(srgb.width, srgb.height, 4, 255);
        for (std::size_t i = 0; i < srgb.pixel_count(); ++i) {
            std::copy_n(&srgb.values[3 * i], 3, &rgba.values[4 * i]);
        }
        if (state.photograph_texture.width() != srgb.width ||
            state.photograph_texture.height() != srgb.height) {
            state.photograph_texture =
                Texture2D({srgb.width, srgb.height}, TexelFormat::rgba8, TexelFilter::linear);
        }
        state.photograph_texture.upload(std::span<const std::uint8_t>(rgba.values));
    }
    const StageFrame picture = photograph_picture(shell, stage);
    draw_texture(state.photograph_texture.name(), picture);
    const bool behind = shell.studio.frame && photograph->number < shell.studio.frame->number;
    std::string caption = "The mock-up on the simulated bench, from the audience's eye";
    if (behind) {
        caption += shell.studio.bench->calibrating().running
                       ? ", as it was before the calibration that is running"
                       : ", a moment ago…";
    }
    if (!photograph->problem.empty()) caption += ": " + photograph->problem;
    draw_caption(shell, stage, caption);
}

}  // namespace

Orbit stage_orbit(const Shell& shell) {
    const StageState& stage = shell.stage;
    if (stage.orbit) return *stage.orbit;
    return default_orbit(shell.product_bounds,
                         static_cast<double>(stage.width) / static_cast<double>(stage.height));
}

View stage_view(const Shell& shell, glm::dvec3 eye_mm) {
    const StageState& stage = shell.stage;
    if (shell.studio.view != StageView::eye) {
        return view_of(stage_orbit(shell), stage.width, stage.height);
    }
    View view = eye_view(eye_mm, shell.product_bounds, stage.width, stage.height);
    view.focal_px *= stage.eye_zoom;
    return view;
}

void draw_stage(Shell& shell) {
    draw_view_buttons(shell);
    draw_compare_buttons(shell);
    const ImVec2 from = ImGui::GetCursorScreenPos(), space = ImGui::GetContentRegionAvail();
    const StageFrame stage{std::floor(from.x),
                           std::floor(from.y),
                           std::max(std::floor(space.x), 16.0f),
                           std::max(std::floor(space.y), 16.0f)};
    shell.stage_x = stage.x;
    shell.stage_y = stage.y;
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
    if (shows_seat_map(shell.studio)) {
        const glm::ivec2 size = seat_map_size(shell.studio);
        const StageFrame picture =
            size.x > 0 ? place_picture(stage, size.x, size.y, shell.stage.projector) : stage;
        handle_picture(shell.stage.projector, picture, pointer);
        draw_seat_map(shell.studio, picture, stage);
        return ImGui::PopClipRect();
    }
    const StageView view = shell.studio.view;
    if (!handle_wipe(shell, stage, pointer)) {
        if (view == StageView::projector) {
            handle_picture(shell.stage.projector, projector_picture(shell, stage), pointer);
        } else if (view == StageView::photograph) {
            handle_picture(shell.stage.photograph, photograph_picture(shell, stage), pointer);
        } else {
            handle_view(shell, stage, pointer);
        }
    }
    if (view == StageView::projector) {
        draw_projector_view(shell, stage);
    } else if (view == StageView::photograph) {
        draw_photograph(shell, stage);
    } else {
        draw_drawn_view(shell, stage);
    }
    draw_wipe(shell, stage);
    draw_held_name(shell.studio, stage);
    ImGui::PopClipRect();
}

}  // namespace livery
