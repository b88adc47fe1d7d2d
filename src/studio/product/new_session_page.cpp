// The page of a new session, over the window.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "studio/product/new_session.h"
#include "studio/studio.h"

namespace livery {

namespace {

constexpr std::array kScales{1.0, 4.0, 10.0, 25.0};
constexpr float kWidth_em = 74.0f, kQuestionsHeight_em = 25.0f;
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// As large as leaves room for the questions beside it.
ImVec2 picture_size(float page_width) {
    const float width = std::floor(std::min(em(31.0f), 0.42f * page_width));
    return {width, std::floor(0.65f * width)};
}

/// A choice among the row's others; true when it was pressed.
bool choice(const std::string& label, bool on, const std::string& name, bool first = false) {
    if (!first) place_in_row(button_width(label.c_str()));
    const bool pressed = named(chip(label.c_str(), on), "new-session:" + name);
    return pressed;
}

void row(const char* label) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label);
    ImGui::SameLine(em(7.5f));
}

/// Below the choices of a row, under them.
void reason(const std::string& why) {
    if (why.empty()) return;
    ImGui::Indent(em(7.5f));
    dim_text(why);
    ImGui::Unindent(em(7.5f));
}

void draw_unit(NewSession& asked) {
    row("Its unit is");
    ImGui::BeginGroup();
    for (const LengthUnit unit : {LengthUnit::mm, LengthUnit::cm, LengthUnit::m, LengthUnit::in}) {
        const std::string label = unit == LengthUnit::in ? "inch" : to_string(unit);
        if (choice(label,
                   asked.answers.unit == unit,
                   std::string("unit:") + to_string(unit),
                   unit == LengthUnit::mm)) {
            asked.answers.unit = unit;
        }
    }
    ImGui::EndGroup();
    reason(asked.suggested.unit_why);
    ProductAnswers as_it_is = asked.answers;
    as_it_is.mesh_is_product = false;
    reason("So it is " + size_text(mock_up_size_mm(asked.facts, as_it_is)) + " large.");
}

void draw_up(NewSession& asked) {
    static constexpr std::array<std::pair<const char*, UpAxis>, 6> axes{{{"+x", UpAxis::plus_x},
                                                                         {"−x", UpAxis::minus_x},
                                                                         {"+y", UpAxis::plus_y},
                                                                         {"−y", UpAxis::minus_y},
                                                                         {"+z", UpAxis::plus_z},
                                                                         {"−z", UpAxis::minus_z}}};
    static constexpr std::array names{"+x", "-x", "+y", "-y", "+z", "-z"};
    row("Up is");
    ImGui::BeginGroup();
    for (std::size_t k = 0; k < axes.size(); ++k) {
        const auto& [label, up] = axes[k];
        if (choice(label, asked.answers.up == up, std::string("up:") + names[k], k == 0)) {
            set_up(asked.answers, up);
        }
    }
    place_in_row(button_width("Turn"));
    if (button("Turn", "new-session:turn", "By a right angle, as it stands")) {
        turn(asked.answers);
    }
    ImGui::EndGroup();
    reason(asked.suggested.up_why);
}

/// As mesh_picture() shows it: +z comes near to the left, +x to the right.
void draw_front(NewSession& asked) {
    static constexpr std::array<std::pair<const char*, const char*>, 5> sides{{{"near left", "+z"},
                                                                               {"near right", "+x"},
                                                                               {"far right", "-z"},
                                                                               {"far left", "-x"},
                                                                               {"not said", ""}}};
    // Turned by a right angle, the picture has another side there
    const auto turns =
        static_cast<std::size_t>(std::floor(asked.azimuth_rad / (0.5 * std::numbers::pi)));
    row("Its front is");
    ImGui::BeginGroup();
    for (std::size_t k = 0; k < sides.size(); ++k) {
        const char* label = sides[k].first;
        const char* front = k < 4 ? sides[(k + turns) % 4].second : "";
        const std::string name = std::string("front:") + front;
        if (choice(label, asked.answers.front == front, name, label == sides[0].first)) {
            asked.answers.front = front;
        }
    }
    ImGui::EndGroup();
    reason("In the picture. Its left and right are named after it.");
}

void draw_scale(NewSession& asked) {
    ProductAnswers& answers = asked.answers;
    row("On the bench");
    ImGui::BeginGroup();
    for (const double scale : kScales) {
        const bool on = answers.product_scale == scale && !asked.other_scale;
        if (choice(scale_text(scale), on, "scale:" + readable_number(scale), scale == kScales[0])) {
            answers.product_scale = scale;
            asked.other_scale = false;
        }
    }
    const bool usual =
        std::find(kScales.begin(), kScales.end(), answers.product_scale) != kScales.end();
    if (choice("other", asked.other_scale || !usual, "scale:other")) asked.other_scale = true;
    if (asked.other_scale || !usual) {
        place_in_row(em(7.0f));
        ImGui::SetNextItemWidth(em(5.0f));
        ImGui::InputDouble("##scale", &answers.product_scale, 0.0, 0.0, "1:%.6g");
        name_last_item("new-session:scale");
        tooltip("Millimetres of the product for one of the model");
    }
    ImGui::EndGroup();
    reason(asked.suggested.scale_why);
    if (answers.product_scale == 1.0) return;
    row("The mesh is of");
    ImGui::BeginGroup();
    if (choice("the product", answers.mesh_is_product, "of:product", true)) {
        answers.mesh_is_product = true;
    }
    if (choice("the model on the bench", !answers.mesh_is_product, "of:model")) {
        answers.mesh_is_product = false;
    }
    ImGui::EndGroup();
}

void draw_sizes(const NewSession& asked, float width) {
    ImGui::PushFont(heading_font());
    ImGui::TextUnformatted(
        ("On the bench: " + size_text(mock_up_size_mm(asked.facts, asked.answers))).c_str());
    name_last_item("new-session:size");
    ImGui::PopFont();
    // A product file has placed its mesh itself.
    const ProductFile product =
        asked.is_product_file ? ProductFile{} : product_file_of(asked.facts, asked.answers, "");
    if (const auto share = lit_share(asked.samples, product, asked.projector)) {
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
        dim_text(lit_share_text(*share));
        name_last_item("new-session:lit");
        ImGui::PopTextWrapPos();
    }
    if (asked.answers.product_scale == 1.0) return;
    dim_text("A " + scale_text(asked.answers.product_scale) + " of a product of " +
             size_text(product_size_mm(asked.facts, asked.answers)) + ".");
}

void draw_parts(NewSession& asked) {
    auto& names = asked.answers.part_names;
    const bool renames = !asked.is_product_file;
    ImGui::Dummy({0.0f, em(0.3f)});
    ImGui::TextUnformatted(names.size() == 1 ? "Its part is called" : "Its parts are called");
    for (std::size_t k = 0; k < names.size(); ++k) {
        ImGui::PushID(static_cast<int>(k));
        ImGui::SetNextItemWidth(em(14.0f));
        begin_disabled(!renames);
        named(ImGui::InputText("##name", &names[k]), fmt::format("new-session:part:{}", k));
        end_disabled();
        if (names[k] != asked.facts.parts[k]) {
            ImGui::SameLine();
            dim_text("in the file: " + asked.facts.parts[k]);
        }
        ImGui::PopID();
    }
    dim_text("Once it is open: click a part, then a paint.");
}

void draw_picture(Studio& studio, const ImVec2& size) {
    NewSession& asked = *page(studio);
    if (studio.window) {
        ask_for_mesh_picture(studio, {static_cast<int>(size.x), static_cast<int>(size.y)});
    }
    const ImVec2 from = ImGui::GetCursorScreenPos();
    named(ImGui::InvisibleButton("##picture", size), "new-session:picture");
    if (ImGui::IsItemActive() && ImGui::GetIO().MouseDelta.x != 0.0f) {
        // Half a turn over its width
        const double turned = 0.5 * kTurn_rad * static_cast<double>(ImGui::GetIO().MouseDelta.x) /
                              static_cast<double>(size.x);
        asked.azimuth_rad -= turned;
        asked.azimuth_rad -= kTurn_rad * std::floor(asked.azimuth_rad / kTurn_rad);
    }
    if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        asked.azimuth_rad = kThreeQuarters_rad;
    }
    tooltip("Drag to look at it from all sides.");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 to{from.x + size.x, from.y + size.y};
    list.AddRectFilled(from, to, IM_COL32(22, 22, 22, 255), em(0.3f));
    if (asked.picture.name() != 0) {
        list.AddImage(imgui_texture(asked.picture.name()), from, to);
    }
}

void draw_session_file(Studio& studio) {
    NewSession& asked = *page(studio);
    ImGui::Dummy({0.0f, em(0.3f)});
    row("Session");
    std::string file = asked.session.string();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - em(6.5f));
    if (named(ImGui::InputText("##session", &file), "new-session:file")) asked.session = file;
    ImGui::SameLine();
    if (button("Change…", "new-session:change", "", em(6.0f))) {
        studio.file_dialog->ask({.kind = FileQuestion::Kind::save,
                                 .title = "Where the session is saved",
                                 .action = "Choose",
                                 .suffixes = {".livery"},
                                 .only_new = true,
                                 .suggested = asked.session,
                                 .then = [&studio](const auto& chosen) {
                                     if (page(studio)) page(studio)->session = chosen;
                                 }});
    }
}

void draw_questions(Studio& studio) {
    NewSession& asked = *page(studio);
    begin_disabled(asked.stage == NewSession::Stage::creating);
    ImGui::BeginGroup();
    const ImVec2 picture = picture_size(ImGui::GetContentRegionAvail().x);
    draw_picture(studio, picture);
    draw_sizes(asked, picture.x);
    ImGui::EndGroup();
    ImGui::SameLine(0.0f, em(1.2f));
    ImGui::BeginChild("questions", {0.0f, em(kQuestionsHeight_em)}, false);
    if (asked.is_product_file) {
        dim_text("The product file says what its mesh is: its unit, its size and how it stands.");
    } else {
        draw_unit(asked);
        draw_up(asked);
        draw_front(asked);
        draw_scale(asked);
    }
    draw_parts(asked);
    ImGui::EndChild();
    draw_session_file(studio);
    end_disabled();
}

void draw_given(Studio& studio) {
    const NewSession& asked = *page(studio);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(asked.given.filename().string().c_str());
    tooltip(asked.given.string());
    if (asked.facts.triangles > 0) {
        ImGui::SameLine();
        dim_text(readable_number(static_cast<double>(asked.facts.triangles)) + " triangles");
    }
    ImGui::SameLine(ImGui::GetContentRegionMax().x - em(9.0f));
    if (button("Another file…", "new-session:mesh", "", em(9.0f))) ask_for_product(studio);
    ImGui::Separator();
}

/// True when the page is done with.
bool draw_buttons(Studio& studio) {
    const NewSession& asked = *page(studio);
    using Stage = NewSession::Stage;
    const float width = em(9.0f);
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - 2.0f * width -
                         ImGui::GetStyle().ItemSpacing.x);
    begin_disabled(asked.stage == Stage::creating);
    const bool cancelled = button("Cancel", "new-session:cancel", "", width);
    end_disabled();
    ImGui::SameLine();
    begin_disabled(asked.stage != Stage::asking);
    if (button("Create session", "new-session:create", "", width)) start_creating(studio);
    end_disabled();
    return (cancelled || was_pressed(ImGuiKey_Escape)) && asked.stage != Stage::creating;
}

}  // namespace

void draw_new_session(Studio& studio) {
    studio.panels.of<NewSessionPage>()
        .closed.reset();  // What was drawn of it is on the screen by now.
    // A file dialog or a question that the page asked for comes instead of it for a while.
    if (!page(studio) || studio.file_dialog->is_open() || studio.question) {
        if (page(studio)) page(studio)->to_open = true;
        return;
    }
    NewSession& asked = *page(studio);
    const char* title = "New session###new-session";
    if (std::exchange(asked.to_open, false)) ImGui::OpenPopup(title);
    if (!begin_modal(title, em(kWidth_em))) return;
    // A notice that comes meanwhile stays behind it.
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    draw_given(studio);
    using Stage = NewSession::Stage;
    if (asked.stage == Stage::reading) dim_text("Reading the file…");
    if (asked.stage == Stage::asking || asked.stage == Stage::creating) draw_questions(studio);
    if (asked.stage == Stage::creating) dim_text("Making the session…");
    if (!asked.problem.empty()) warning_text(asked.problem);
    if (draw_buttons(studio)) {
        studio.panels.of<NewSessionPage>().closed = std::move(page(studio));
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

namespace {

const char* name_of(NewSession::Stage stage) {
    constexpr std::array names{"reading", "unreadable", "asking", "creating"};
    return names[static_cast<std::size_t>(stage)];
}

void describe_new_session(const Studio& studio, MapState& state) {
    const NewSession* open = studio.panels.of<NewSessionPage>().open.get();
    state["new_session"] = map_text(open ? name_of(open->stage) : "closed");
    state["new_session_pictured"] = map_text(open && open->picture.name() != 0);
    state["new_session_says"] = map_text(open ? open->problem : "");
}

}  // namespace

Panel new_session_panel() {
    return {
        .name = "new-session",
        .place = PanelPlace::page,
        .draw = draw_new_session,
        .is_open = [](const Studio& s) { return s.panels.of<NewSessionPage>().open != nullptr; },
        .describe = describe_new_session};
}

}  // namespace livery
