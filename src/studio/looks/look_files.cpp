#include "studio/looks/look_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "core/image_io.h"
#include "gl/read_back.h"
#include "jobs/export_product.h"
#include "jobs/render/render.h"
#include "scene/look.h"
#include "session/look_exchange.h"
#include "studio/studio.h"
#include "studio/users_library.h"

namespace livery {

namespace {

void tell(Studio& studio, const std::string& what, const std::exception& error) {
    tell_error(studio, what, error.what());
}

void import_look(Studio& studio, const std::filesystem::path& file) {
    AddLook command;
    try {
        command.look = portable_look(read_look_file(file));
    } catch (const std::exception& error) {
        tell(studio, "The look was not imported.", error);
        return;
    }
    const auto files = unread_files(studio.session.document(), command);
    refresh_library(studio, files, [&studio, command] { commit(studio, command); });
}

}  // namespace

void ask_for_look_file(Studio& studio) {
    studio.file_dialog->ask({FileQuestion::Kind::open,
                             "Import look",
                             "Import",
                             {".json"},
                             false,
                             documents_folder(),
                             [&studio](const auto& file) { import_look(studio, file); }});
}

void ask_where_to_export_look(Studio& studio) {
    const int id = studio.shown_look;
    const std::string name = find_look(studio.session.document(), id)->look.name;
    studio.file_dialog->ask(
        {FileQuestion::Kind::save,
         "Export look",
         "Export",
         {".json"},
         false,
         documents_folder() / (file_name_of(name) + ".json"),
         [&studio, id, name](const auto& file) {
             try {
                 const auto written = export_look(studio.session.document(), id, file);
                 std::string more;
                 if (written.size() > 1) {
                     more = fmt::format("{} paints of this session lie beside it.",
                                        written.size() - 1);
                 }
                 tell_info(studio, "Exported " + name + " to " + file.string() + ".", more);
             } catch (const std::exception& error) {
                 tell(studio, "The look was not exported.", error);
             }
         }});
}

void ask_where_to_export_product(Studio& studio) {
    studio.file_dialog->ask(
        {.kind = FileQuestion::Kind::save,
         .title = "Export product with looks",
         .action = "Export",
         .suffixes = {".glb"},
         .suggested = documents_folder() / (file_name_of(studio.product->name) + ".glb"),
         .then = [&studio](const std::filesystem::path& file) {
             const Studio& now = studio;
             try {
                 std::string left_out;
                 for (const std::string& note :
                      export_product(now.session.document(), now.product, now.shown_look, file)) {
                     left_out += note + ". ";
                 }
                 tell_info(studio,
                           fmt::format("Exported {} with {} looks to {}.",
                                       now.product->name,
                                       now.session.document().looks.size(),
                                       file.string()),
                           left_out);
             } catch (const std::exception& error) {
                 tell(studio, "The product was not exported.", error);
             }
         }});
}

void ask_where_to_save_session(Studio& studio) {
    studio.file_dialog->ask({.kind = FileQuestion::Kind::save,
                             .title = "Save session as",
                             .action = "Save",
                             .suffixes = {".livery"},
                             .only_new = true,
                             .suggested = documents_folder() / "session.livery",
                             .then = [&studio](const std::filesystem::path& file) {
                                 try {
                                     studio.session.save_as(file);
                                 } catch (const std::exception& error) {
                                     tell(studio, "The session was not saved.", error);
                                     return;
                                 }
                                 tell_info(studio,
                                           "The session goes on in " + file.string() + ".",
                                           "What was saved before stays as it is.");
                             }});
}

namespace {

enum What { preview, wanted_exr, wanted_png, projector_input, photograph };

struct SavedAs {
    const char *label, *name, *suffix, *help;
};
constexpr std::array<SavedAs, 5> kSavedAs = {{
    {"Preview", "preview", ".png", "The product as in the preview, sRGB."},
    {"Wanted light, exact",
     "wanted",
     ".exr",
     "Linear Rec.709 in the projector's pixels, coverage in A."},
    {"Wanted light, to look at", "wanted", ".png", "The same as sRGB."},
    {"Projector input", "projector", ".png", "Device values, pixel by pixel, as they go out."},
    {"Photograph of the mock-up", "photograph", ".png", "From the simulated bench, sRGB."},
}};

using Write = std::function<void(const std::filesystem::path&)>;

bool is_there(const Studio& studio, int what) {
    switch (what) {
        case preview:
            return studio.preview && studio.preview->texture != 0;
        case photograph:
            return studio.photograph && !studio.photograph->srgb.empty();
        default:
            return studio.frame && studio.frame->pictures;
    }
}

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

/// Of a picture that is there, as it is now: fetched here, written on any thread.
Write writer_of(const Studio& studio, int what) {
    switch (what) {
        case preview: {
            const PreviewPicture& picture = *studio.preview;
            picture.ready->wait_on_device();
            auto pixels = std::make_shared<const Image8>(without_coverage(
                read_floats(picture.texture, picture.size_px.x, picture.size_px.y, 4)));
            return [pixels](const auto& file) { write_png(file, *pixels); };
        }
        case projector_input:
            return [drive = drive_of(*studio.frame->pictures)](const auto& file) {
                write_png(file, *drive);
            };
        case photograph:
            return [taken = studio.photograph](const auto& file) { write_png(file, taken->srgb); };
        default:
            return [wanted = radiance_of(*studio.frame->pictures)](const auto& file) {
                RenderedFrame rendered;
                rendered.radiance_working = *wanted;
                write_frame(file, rendered, FrameStage::radiance);
            };
    }
}

const char* why_not_there(int what) {
    return what == photograph ? "Choose Photograph above the picture first: none was taken yet."
                              : "It is not drawn yet.";
}

int what_is_on_stage(const Studio& studio) {
    switch (studio.view) {
        case StageView::projector:
            return projector_input;
        case StageView::photograph:
            return photograph;
        default:
            return preview;
    }
}

std::string suggested_name(const Studio& studio, int what) {
    const SavedAs& choice = kSavedAs[static_cast<std::size_t>(what)];
    const auto* look = find_look(studio.session.document(), studio.shown_look);
    const std::string name = look ? file_name_of(look->look.name) : "picture";
    return fmt::format("{}-{}{}", name, choice.name, choice.suffix);
}

void save(Studio& studio, int what, const std::filesystem::path& file) {
    if (!is_there(studio, what)) return;  // The dialog asked just before.
    studio.background->run(
        [&studio, write = writer_of(studio, what), file](const Progress&) -> Background::Then {
            write(file);
            return [&studio, file] { tell_info(studio, "Saved " + file.string() + "."); };
        },
        [&studio](std::exception_ptr why) {
            tell_error(
                studio, "The picture was not saved.", in_words(why), "Save it in another folder.");
        });
}

void use_choice(const Studio& studio, int what, FileQuestion& question) {
    question.suffixes = {kSavedAs[static_cast<std::size_t>(what)].suffix};
    question.suggested = question.suggested.parent_path() / suggested_name(studio, what);
}

void draw_choices(const Studio& studio, int& what, FileQuestion& question) {
    for (int i = 0; i < static_cast<int>(kSavedAs.size()); ++i) {
        const SavedAs& choice = kSavedAs[static_cast<std::size_t>(i)];
        if (ImGui::RadioButton(choice.label, what == i)) {
            what = i;
            use_choice(studio, what, question);
        }
        name_last_item(fmt::format("save-picture:what-{}", i));
        ImGui::SameLine(em(14.0f));
        ImGui::TextColored(colours::dim_text, "%s", choice.help);
    }
}

}  // namespace

void ask_where_to_save_picture(Studio& studio) {
    const auto what = std::make_shared<int>(what_is_on_stage(studio));
    FileQuestion question;
    question.kind = FileQuestion::Kind::save;
    question.title = "Save picture";
    question.action = "Save";
    question.suggested = pictures_folder() / "";
    use_choice(studio, *what, question);
    question.choices = [&studio, what](FileQuestion& asked) { draw_choices(studio, *what, asked); };
    question.not_ready = [&studio, what] {
        return std::string(is_there(studio, *what) ? "" : why_not_there(*what));
    };
    question.then = [&studio, what](const std::filesystem::path& file) {
        save(studio, *what, file);
    };
    studio.file_dialog->ask(std::move(question));
}

}  // namespace livery
