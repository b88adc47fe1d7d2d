// The parameters of the chosen part's paint: live on the mock-up while they are dragged.
#include "studio/paint/paint_panel.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "appearance/fit/recolour.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
#include "core/error.h"
#include "session/naming.h"
#include "studio/paint/parts_panel.h"
#include "studio/studio.h"
#include "studio/users_library.h"

namespace livery {

namespace {

constexpr const char* kSavePopup = "Save as new paint";
constexpr const char* kRenamePopup = "Rename paint";

/// The name that the part's paint has after an edit.
std::string name_after_edit(const Document& document, const EditPaint& edit) {
    try {
        const Document after = applied(document, edit);
        const SessionLook* look = find_look(after, edit.look);
        return look ? worn_paint(look->look, edit.part) : "";
    } catch (const std::invalid_argument&) {
        return "";
    }
}

/// Looks the paint up again when the document or the choice has changed.
void refresh(Studio& studio) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    const auto chosen = chosen_part(studio);
    const int part = chosen ? static_cast<int>(*chosen) : -1;
    const bool same = state.read && state.revision == studio.session.revision() &&
                      state.look == studio.shown_look && state.part == part;
    if (same) return;
    if (state.part != part || state.look != studio.shown_look) state.brushed = false;
    state.read = true;
    state.revision = studio.session.revision();
    state.look = studio.shown_look;
    state.part = part;
    state.material.reset();
    state.part_name.clear();
    state.problem.clear();
    const Document& document = studio.session.document();
    const SessionLook* look = find_look(document, studio.shown_look);
    if (!look || !chosen) return;
    state.part_name = studio.product->mesh.parts[*chosen].name;
    const std::string paint = worn_paint(look->look, state.part_name);
    if (paint.empty()) return;
    NamedPaint named = look_up(document, paint);
    state.problem = named.problem;
    if (!named.problem.empty()) return;
    if (!is_read(named.material)) {
        // What is drawn wears it as well and has it read (drawing.cpp).
        state.problem = "Reading " + named.material.measured->file.filename().string() + ".";
        return;
    }
    state.material = std::move(named.material);
    state.becomes =
        name_after_edit(document, EditPaint{state.look, state.part_name, *state.material});
}

bool is_own(const Document& document, const std::string& name) {
    return std::any_of(document.paints.begin(), document.paints.end(), [&](const Material& paint) {
        return paint.name == name;
    });
}

/// One control's row; the edit is tried and committed by what was just drawn.
class ParameterRows {
  public:
    ParameterRows(Studio& studio, Material& edited) : studio_(studio), edited_(edited) {}

    void label(const char* text, const std::string& meaning) {
        row_label(text);
        meaning_ = meaning;
    }
    void parameter(const ParameterInfo& info, const char* how = "Drag, or Ctrl+click to type.") {
        label(info.label,
              fmt::format("{}\n{}: {}. {}", info.meaning, info.name, info.range_text(), how));
    }
    void after_item(const std::string& name) {
        name_last_item("param:" + name);
        tooltip(meaning_);
        after_named_item();
    }
    void after_named_item() {
        PaintPanelState& state = studio_.panels.of<PaintPanelState>();
        state.held.after_item();
        const bool touched = last_item_is_held() || ImGui::IsItemDeactivatedAfterEdit();
        if (!touched) return;
        state.problem = paint_problem(edited_).value_or("");
        // What was put back where it was, or typed in part, is no edit.
        if (state.problem.empty() && !same_reflectance(edited_, *state.material)) {
            edit_with_last_item(studio_, EditPaint{state.look, state.part_name, edited_});
        }
    }

  private:
    Studio& studio_;
    Material& edited_;
    std::string meaning_;
};

void commit_edit(Studio& studio, const Material& material) {
    const PaintPanelState& state = studio.panels.of<PaintPanelState>();
    commit(studio, EditPaint{state.look, state.part_name, material});
}

/// Where the paint comes from, and what becomes of it when it is changed.
void draw_origin(Studio& studio) {
    const PaintPanelState& state = studio.panels.of<PaintPanelState>();
    const Material& material = *state.material;
    const bool own = is_own(studio.session.document(), material.name);
    std::string origin = own ? "This session's own paint" : "From the library";
    if (!own && !material.file.empty() && current_library(studio).find(material.name) == nullptr) {
        origin = "From " + material.file.string();
    }
    dim_text(fmt::format("On {}. {}.", state.part_name, origin));
    if (!state.becomes.empty() && state.becomes != material.name) {
        dim_text(
            own ? fmt::format("Other parts or looks wear it as well: a change here makes \"{}\" "
                              "for this part alone.",
                              state.becomes)
                : fmt::format("A change makes \"{}\", this session's own; the library stays as "
                              "it is.",
                              state.becomes));
    }
    if (!material.provenance.empty()) dim_text("Source: " + material.provenance);
}

void draw_model(Studio& studio, const Material& material) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    row_label("Model");
    const ModelInfo& chosen = model_info(material.model);
    if (ImGui::BeginCombo("##model", chosen.label)) {
        for (const ModelInfo& model : formula_models()) {
            const bool same = model.model == material.model;
            const bool picked = ImGui::Selectable(model.label, same);
            name_last_item(std::string("model:") + model.name);
            tooltip(model.meaning);
            if (same) continue;
            if (!picked && !ImGui::IsItemHovered()) continue;
            if (!state.in_model || state.in_model->model != model.model ||
                !same_reflectance(state.in_model_of, material)) {
                state.in_model = with_model(material, model.model);
                state.in_model_of = material;
            }
            if (picked) {
                commit_edit(studio, *state.in_model);
            } else {
                try_out(studio, EditPaint{state.look, state.part_name, *state.in_model});
            }
        }
        ImGui::EndCombo();
    }
    name_last_item("param:model");
    tooltip(chosen.meaning);
}

void draw_slider(const ParameterInfo& parameter, const std::string& id, double& value) {
    readable_slider(id.c_str(),
                    value,
                    parameter.low,
                    parameter.high,
                    unit_of(parameter),
                    parameter.logarithmic);
}

void draw_pair(Studio& studio,
               ParameterRows& rows,
               const ParameterInfo& parameter,
               Material& edited) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    const Components<double> components = parameter.in_material(edited);
    double& along = *components[0];
    double& across = *components[1];
    const bool can_differ = model_info(edited.model).anisotropic;
    const bool differs = can_differ && along != across;
    const bool brushed = differs || (can_differ && state.brushed);
    rows.parameter(parameter);
    draw_slider(parameter, std::string("##") + parameter.name, along);
    if (!brushed) across = along;
    rows.after_item(parameter.name);
    if (brushed) {
        rows.label("  across", "The same across the brushing; the one above is along it.");
        draw_slider(parameter, "##across", across);
        rows.after_item(std::string(parameter.name) + "-across");
    }
    if (!can_differ) return;
    row_label("");
    bool wanted = brushed;
    if (ImGui::Checkbox("Brushed", &wanted)) {
        state.brushed = wanted;
        if (!wanted && differs) {
            across = along;
            commit_edit(studio, edited);
        }
    }
    name_last_item("param:brushed");
    tooltip("Different gloss along and across the surface's tangent.");
}

void draw_parameters(Studio& studio) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    Material& edited = state.held.start(*state.material);
    ParameterRows rows(studio, edited);
    if (is_translucent(edited)) {
        draw_medium_rows(
            edited,
            studio.product->product_scale,
            {[&](const char* text, const std::string& meaning) { rows.label(text, meaning); },
             [&](const std::string& name) {
                 name.empty() ? rows.after_named_item() : rows.after_item(name);
             }});
    }
    for (const char* name : model_info(edited.model).parameters) {
        const ParameterInfo& parameter = parameter_info(name);
        const Components<double> components = parameter.in_material(edited);
        if (parameter.kind == ParameterKind::colour) {
            rows.parameter(parameter,
                           "The three numbers are linear Rec.709: drag, or Ctrl+click to type.");
            glm::dvec3 value = value_of(parameter, edited);
            colour_control(std::string("param:") + name, value);
            for (int c = 0; c < 3; ++c) *components[static_cast<std::size_t>(c)] = value[c];
            rows.after_item(name);
        } else if (parameter.kind == ParameterKind::pair) {
            draw_pair(studio, rows, parameter, edited);
        } else {
            rows.parameter(parameter);
            draw_slider(parameter, std::string("##") + name, *components[0]);
            rows.after_item(name);
        }
    }
    state.held.finish();
}

void save_paint(Studio& studio) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    Material paint = *state.material;
    paint.name = state.new_name;
    paint.family = state.new_family;
    const auto& own = studio.session.document().paints;
    const bool taken = std::any_of(own.begin(), own.end(), [&](const Material& other) {
        return same_paint_name(other.name, paint.name);
    });
    if (taken) {
        // It would come before the library's wherever it is looked up by name.
        state.save_problem = fmt::format(
            "This session has a paint \"{}\" of its own already. Choose another name.", paint.name);
        return;
    }
    try {
        const auto file = save_to_library(paint);
        studio.session.use(read_paint_library(studio.session.document().library));
        ImGui::CloseCurrentPopup();
        commit(studio, SetPaint{state.look, state.part_name, paint.name});
        tell_info(studio,
                  fmt::format("Saved \"{}\" to your library.", paint.name),
                  "",
                  "It lies in " + file.string() + ".");
    } catch (const Refused& refused) {
        state.save_problem = fmt::format("Not saved: {}; {}.", refused.why(), refused.fix());
    } catch (const std::exception& error) {
        state.save_problem = fmt::format("Not saved: {}.", error.what());
    }
}

void draw_save_popup(Studio& studio) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    ImGui::SetNextWindowSize({em(24.0f), 0.0f});
    if (!ImGui::BeginPopupModal(
            kSavePopup, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove)) {
        return;
    }
    dim_text("Keeps the paint in your own library, for every session.");
    row_label("Name", 0.3f);
    if (ImGui::IsWindowAppearing()) focus_next_field("##name");
    const bool entered =
        ImGui::InputText("##name",
                         &state.new_name,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    name_last_item("save-paint:name");
    row_label("Family", 0.3f);
    ImGui::InputText("##family", &state.new_family);
    name_last_item("save-paint:family");
    tooltip(fmt::format("Groups the library: {}.", fmt::join(paint_families(), ", ")));
    if (!state.save_problem.empty()) warning_text(state.save_problem);
    const bool named = state.new_name.find_first_not_of(' ') != std::string::npos;
    begin_disabled(!named);
    if (button("Save", "save-paint:save") || (entered && named)) save_paint(studio);
    end_disabled();
    ImGui::SameLine();
    if (ImGui::Button("Cancel") || was_pressed(ImGuiKey_Escape)) ImGui::CloseCurrentPopup();
    name_last_item("save-paint:cancel");
    ImGui::EndPopup();
}

void draw_rename_popup(Studio& studio) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    ImGui::SetNextWindowSize({em(24.0f), 0.0f});
    if (!ImGui::BeginPopupModal(
            kRenamePopup, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove)) {
        return;
    }
    dim_text("The session's own paint, wherever it is worn. Ctrl+Z takes it back.");
    row_label("Name", 0.3f);
    if (ImGui::IsWindowAppearing()) focus_next_field("##name");
    const bool entered =
        ImGui::InputText("##name",
                         &state.other_name,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    name_last_item("rename-paint:name");
    if (!state.rename_problem.empty()) warning_text(state.rename_problem);
    const RenamePaint command{state.material->name, state.other_name};
    const bool agreed = ImGui::Button("Rename") || entered;
    name_last_item("rename-paint:ok");
    if (agreed) {
        try {
            applied(studio.session.document(), command);
            ImGui::CloseCurrentPopup();
            commit(studio, command);
        } catch (const std::invalid_argument& refused) {
            state.rename_problem = sentence(refused.what());
        }
    }
    ImGui::SameLine();
    if (ImGui::Button("Cancel") || was_pressed(ImGuiKey_Escape)) ImGui::CloseCurrentPopup();
    name_last_item("rename-paint:cancel");
    ImGui::EndPopup();
}

void draw_rename(Studio& studio) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    const char* rename = "Rename…";
    place_in_row(button_width(rename));
    begin_disabled(!is_own(studio.session.document(), state.material->name));
    if (ImGui::Button(rename)) {
        state.other_name = state.material->name;
        state.rename_problem.clear();
        ImGui::OpenPopup(kRenamePopup);
    }
    name_last_item("rename-paint");
    tooltip("Another name for this session's own paint. A paint of the library keeps its name.");
    end_disabled();
    draw_rename_popup(studio);
}

void draw_actions(Studio& studio) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    const Material& material = *state.material;
    const Material* origin = is_own(studio.session.document(), material.name)
                                 ? library_origin(material.name, current_library(studio))
                                 : nullptr;
    begin_disabled(origin == nullptr);
    const bool reset = button("Reset to library", "reset-paint");
    const bool over = ImGui::IsItemHovered();
    tooltip(origin ? fmt::format("Gives the part the library's \"{}\" again.", origin->name)
                   : "This is the library's paint, or none of the library's lies under it.");
    end_disabled();
    if (origin) {
        const SetPaint command{state.look, state.part_name, origin->name};
        if (over) try_out(studio, command);
        if (reset) commit(studio, command);
    }
    const char* save = "Save as new paint…";
    place_in_row(button_width(save));
    if (button(save, "save-paint", "Writes a material file into your own library.")) {
        const auto& own = studio.session.document().paints;
        state.new_name = free_name(material.name, [&](const std::string& name) {
            return current_library(studio).find(name) != nullptr ||
                   std::any_of(own.begin(), own.end(), [&](const Material& paint) {
                       return same_paint_name(paint.name, name);
                   });
        });
        state.new_family = material.family;
        state.save_problem.clear();
        ImGui::OpenPopup(kSavePopup);
    }
    draw_save_popup(studio);
    draw_rename(studio);
}

}  // namespace

void draw_paint_panel(Studio& studio) {
    PaintPanelState& state = studio.panels.of<PaintPanelState>();
    refresh(studio);
    if (state.part_name.empty()) {
        dim_text("There is no part whose paint could be shown.");
        return;
    }
    if (!state.material) {
        if (!state.problem.empty()) {
            warning_text(state.problem);
        } else {
            dim_text(
                fmt::format("{} wears the colour that the product's file gives it. Choose a "
                            "paint from the library to change it.",
                            state.part_name));
        }
        return;
    }
    heading(state.material->name.c_str());
    name_last_item("paint-name");
    draw_paint_portrait(studio, state.held.is_held() ? state.held.value() : *state.material);
    ImGui::Spacing();
    // What the sliders do stays in sight while one scrolls to them, as long as there is room.
    const float room = ImGui::GetContentRegionAvail().y;
    const bool apart = room >= em(8.0f);
    if (apart) {
        ImGui::Separator();
        ImGui::BeginChild("parameters");
    }
    draw_origin(studio);
    ImGui::Spacing();
    draw_paint_colour_row(studio, *state.material);
    draw_model(studio, *state.material);
    draw_parameters(studio);
    if (!state.problem.empty()) warning_text("Not taken: " + state.problem);
    ImGui::Spacing();
    draw_actions(studio);
    if (apart) ImGui::EndChild();
}

Panel paint_panel() {
    return {.name = "Paint", .place = PanelPlace::tab, .draw = draw_paint_panel};
}

}  // namespace livery
