#include "studio/save_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/error.h"
#include "core/image_io.h"
#include "gl/read_back.h"
#include "session/render.h"
#include "studio/look_files.h"
#include "studio/shell.h"
#include "studio/theme.h"
#include "studio/user_folders.h"

namespace livery {

namespace {

enum What { preview, wanted_exr, wanted_png, projector_input, photograph };

struct Choice {
    const char *label, *name, *suffix, *help;
};
constexpr std::array<Choice, 5> kChoices = {{
    {"Preview", "preview", ".png", "The product as in the preview, sRGB."},
    {"Wanted light, exact",
     "wanted",
     ".exr",
     "Linear Rec.709 in the projector's pixels, coverage in A."},
    {"Wanted light, to look at", "wanted", ".png", "The same as sRGB."},
    {"Projector input", "projector", ".png", "Device values, pixel by pixel, as they go out."},
    {"Photograph of the mock-up", "photograph", ".png", "From the simulated bench, sRGB."},
}};

/// What the picture is made of now; nothing when it is not there yet.
using Write = std::function<void(const std::filesystem::path&)>;

Image8 without_coverage(const ImageF& rgba) {
    Image8 rgb(rgba.width, rgba.height, 3);
    for (std::size_t i = 0; i < rgba.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            rgb.values[3 * i + c] =
                static_cast<std::uint8_t>(std::lround(255.0f * rgba.values[4 * i + c]));
        }
    }
    return rgb;
}

std::optional<Write> writer_of(const Shell& shell, int what) {
    const Studio& studio = shell.studio;
    switch (what) {
        case preview: {
            const auto& picture = studio.preview;
            if (!picture || picture->texture == 0) return {};
            picture->ready->wait_on_device();
            auto pixels = std::make_shared<const Image8>(without_coverage(
                read_floats(picture->texture, picture->size_px.x, picture->size_px.y, 4)));
            return [pixels](const auto& file) { write_png(file, *pixels); };
        }
        case wanted_exr:
        case wanted_png:
            if (!studio.frame || !studio.frame->radiance_working) return {};
            return [wanted = studio.frame->radiance_working](const auto& file) {
                RenderedFrame rendered;
                rendered.radiance_working = *wanted;
                write_frame(file, rendered, FrameStage::radiance);
            };
        case projector_input:
            if (!studio.frame || !studio.frame->drive) return {};
            return [drive = studio.frame->drive](const auto& file) { write_png(file, *drive); };
        case photograph:
            if (!studio.photograph || studio.photograph->srgb.empty()) return {};
            return [taken = studio.photograph](const auto& file) { write_png(file, taken->srgb); };
        default:
            return {};
    }
}

const char* why_not_there(int what) {
    return what == photograph ? "Choose Photograph above the picture first: none was taken yet."
                              : "It is not drawn yet.";
}

int what_is_on_stage(const Shell& shell) {
    switch (shell.studio.view) {
        case StageView::projector:
            return projector_input;
        case StageView::photograph:
            return photograph;
        default:
            return preview;
    }
}

void suggest_path(Shell& shell) {
    SavePictureState& state = shell.save_picture;
    const Choice& choice = kChoices[static_cast<std::size_t>(state.what)];
    const auto* look = find_look(shell.studio.session.document(), shell.studio.shown_look);
    const auto folder =
        state.path.empty() ? pictures_folder() : std::filesystem::path(state.path).parent_path();
    const std::string name = look ? file_name_of(look->look.name) : "picture";
    state.path = (folder / fmt::format("{}-{}{}", name, choice.name, choice.suffix)).string();
    state.problem.clear();
    state.asking_to_overwrite = false;
}

/// What is in the way; empty: nothing.
std::string problem_of(const std::filesystem::path& file, const Choice& choice) {
    std::error_code error;
    if (!file.has_filename() || std::filesystem::is_directory(file, error))
        return "Type a file name.";
    if (file.extension() != choice.suffix) {
        return fmt::format("The file name must end in {}.", choice.suffix);
    }
    if (!std::filesystem::is_directory(file.parent_path(), error)) {
        return "There is no folder " + file.parent_path().string() + ".";
    }
    return "";
}

void save(Shell& shell) {
    SavePictureState& state = shell.save_picture;
    const auto file = std::filesystem::absolute(expand_home(state.path));
    state.problem = problem_of(file, kChoices[static_cast<std::size_t>(state.what)]);
    if (!state.problem.empty()) return;
    std::error_code error;
    if (std::filesystem::exists(file, error) && !state.asking_to_overwrite) {
        state.asking_to_overwrite = true;
        return;
    }
    const auto write = writer_of(shell, state.what);
    if (!write) {
        state.problem = why_not_there(state.what);
        return;
    }
    state.open = false;
    shell.studio.background->run(
        [&shell, write = *write, file](const Progress&) -> Background::Then {
            write(file);
            return [&shell, file] {
                notify(shell.studio, {Notice::Level::info, "Saved " + file.string() + ".", "", ""});
            };
        },
        [&shell](std::exception_ptr why) {
            try {
                std::rethrow_exception(why);
            } catch (const std::exception& problem) {
                notify(shell.studio,
                       {Notice::Level::error,
                        "The picture was not saved.",
                        problem.what(),
                        "Save it in another folder."});
            }
        });
}

void draw_choices(Shell& shell) {
    SavePictureState& state = shell.save_picture;
    for (int i = 0; i < static_cast<int>(kChoices.size()); ++i) {
        const Choice& choice = kChoices[static_cast<std::size_t>(i)];
        if (ImGui::RadioButton(choice.label, state.what == i)) {
            state.what = i;
            suggest_path(shell);
        }
        name_last_item(fmt::format("save-picture:what-{}", i));
        ImGui::SameLine(em(14.0f));
        ImGui::TextColored(colours::dim_text, "%s", choice.help);
    }
}

}  // namespace

void open_save_picture(Shell& shell) {
    shell.save_picture.open = true;
    shell.save_picture.to_focus = true;
    shell.save_picture.what = what_is_on_stage(shell);
    suggest_path(shell);
}

void draw_save_picture(Shell& shell) {
    SavePictureState& state = shell.save_picture;
    if (!state.open) return;
    constexpr const char* title = "Save picture";
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    ImGui::SetNextWindowSize({em(42.0f), 0.0f});
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(title, &state.open, ImGuiWindowFlags_NoResize)) return;
    draw_choices(shell);
    ImGui::Dummy({0.0f, em(0.2f)});
    if (state.to_focus) ImGui::SetKeyboardFocusHere();
    state.to_focus = false;
    ImGui::SetNextItemWidth(-1.0f);
    bool agreed = ImGui::InputText("##path", &state.path, ImGuiInputTextFlags_EnterReturnsTrue);
    name_last_item("save-picture:path");
    if (ImGui::IsItemEdited()) {
        state.problem.clear();
        state.asking_to_overwrite = false;
    }
    if (!state.problem.empty()) warning_text(state.problem);
    if (state.asking_to_overwrite) warning_text("This file exists already. Replace it?");
    const float width = em(7.0f);
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - 2.0f * width -
                         ImGui::GetStyle().ItemSpacing.x);
    if (ImGui::Button("Cancel", {width, 0.0f}) ||
        ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        state.open = false;
    }
    name_last_item("save-picture:cancel");
    ImGui::SameLine();
    agreed = ImGui::Button(state.asking_to_overwrite ? "Replace" : "Save", {width, 0.0f}) || agreed;
    name_last_item("save-picture:ok");
    if (agreed) save(shell);
    if (!state.open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace livery
