#include "studio/look_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <memory>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "core/image_io.h"
#include "gl/read_back.h"
#include "jobs/export_product.h"
#include "jobs/render/render.h"
#include "scene/look.h"
#include "session/look_exchange.h"
#include "studio/kit/folders.h"
#include "studio/kit/theme.h"
#include "studio/paint/users_library.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

void tell(Shell& shell, const std::string& what, const std::exception& error) {
    notify(shell.studio, {Notice::Level::error, what, error.what(), ""});
}

void import_look(Shell& shell, const std::filesystem::path& file) {
    AddLook command;
    try {
        command.look = portable_look(read_look_file(file));
    } catch (const std::exception& error) {
        tell(shell, "The look was not imported.", error);
        return;
    }
    const auto files = unread_files(shell.studio.session.document(), command);
    refresh_library(shell.studio, files, [&shell, command] { commit(shell.studio, command); });
}

}  // namespace

std::string file_name_of(const std::string& name) {
    std::string result;
    for (const char c : name) {
        const bool plain = static_cast<unsigned char>(c) >= 0x80 ||
                           std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
        if (plain) {
            result += c;
        } else if (!result.empty() && result.back() != '-') {
            result += '-';
        }
    }
    while (!result.empty() && result.back() == '-') result.pop_back();
    return result.empty() ? "look" : result;
}

void ask_for_look_file(Shell& shell) {
    shell.studio.file_dialog->ask({FileQuestion::Kind::open,
                                   "Import look",
                                   "Import",
                                   {".json"},
                                   false,
                                   documents_folder(),
                                   [&shell](const auto& file) { import_look(shell, file); }});
}

void ask_where_to_export_look(Shell& shell) {
    const int id = shell.studio.shown_look;
    const std::string name = find_look(shell.studio.session.document(), id)->look.name;
    shell.studio.file_dialog->ask(
        {FileQuestion::Kind::save,
         "Export look",
         "Export",
         {".json"},
         false,
         documents_folder() / (file_name_of(name) + ".json"),
         [&shell, id, name](const auto& file) {
             try {
                 const auto written = export_look(shell.studio.session.document(), id, file);
                 std::string more;
                 if (written.size() > 1) {
                     more = fmt::format("{} paints of this session lie beside it.",
                                        written.size() - 1);
                 }
                 notify(shell.studio,
                        {Notice::Level::info,
                         "Exported " + name + " to " + file.string() + ".",
                         more,
                         ""});
             } catch (const std::exception& error) {
                 tell(shell, "The look was not exported.", error);
             }
         }});
}

void ask_where_to_export_product(Shell& shell) {
    const Studio& studio = shell.studio;
    FileQuestion question;
    question.kind = FileQuestion::Kind::save;
    question.title = "Export product with looks";
    question.action = "Export";
    question.suffixes = {".glb"};
    question.suggested = documents_folder() / (file_name_of(studio.product->name) + ".glb");
    question.then = [&shell](const std::filesystem::path& file) {
        const Studio& now = shell.studio;
        try {
            std::string left_out;
            for (const std::string& note :
                 export_product(now.session.document(), now.product, now.shown_look, file)) {
                left_out += note + ". ";
            }
            notify(shell.studio,
                   {Notice::Level::info,
                    fmt::format("Exported {} with {} looks to {}.",
                                now.product->name,
                                now.session.document().looks.size(),
                                file.string()),
                    left_out,
                    ""});
        } catch (const std::exception& error) {
            tell(shell, "The product was not exported.", error);
        }
    };
    shell.studio.file_dialog->ask(std::move(question));
}

void ask_where_to_save_session(Shell& shell) {
    FileQuestion question;
    question.kind = FileQuestion::Kind::save;
    question.title = "Save session as";
    question.action = "Save";
    question.suffixes = {".livery"};
    question.only_new = true;
    question.suggested = documents_folder() / "session.livery";
    question.then = [&shell](const std::filesystem::path& file) {
        try {
            shell.studio.session.save_as(file);
        } catch (const std::exception& error) {
            tell(shell, "The session was not saved.", error);
            return;
        }
        notify(shell.studio,
               {Notice::Level::info,
                "The session goes on in " + file.string() + ".",
                "What was saved before stays as it is.",
                ""});
    };
    shell.studio.file_dialog->ask(std::move(question));
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

std::string suggested_name(const Shell& shell, int what) {
    const SavedAs& choice = kSavedAs[static_cast<std::size_t>(what)];
    const auto* look = find_look(shell.studio.session.document(), shell.studio.shown_look);
    const std::string name = look ? file_name_of(look->look.name) : "picture";
    return fmt::format("{}-{}{}", name, choice.name, choice.suffix);
}

void save(Shell& shell, int what, const std::filesystem::path& file) {
    if (!is_there(shell.studio, what)) return;  // The dialog asked just before.
    shell.studio.background->run(
        [&shell, write = writer_of(shell.studio, what), file](const Progress&) -> Background::Then {
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

void use_choice(const Shell& shell, int what, FileQuestion& question) {
    question.suffixes = {kSavedAs[static_cast<std::size_t>(what)].suffix};
    question.suggested = question.suggested.parent_path() / suggested_name(shell, what);
}

void draw_choices(const Shell& shell, int& what, FileQuestion& question) {
    for (int i = 0; i < static_cast<int>(kSavedAs.size()); ++i) {
        const SavedAs& choice = kSavedAs[static_cast<std::size_t>(i)];
        if (ImGui::RadioButton(choice.label, what == i)) {
            what = i;
            use_choice(shell, what, question);
        }
        name_last_item(fmt::format("save-picture:what-{}", i));
        ImGui::SameLine(em(14.0f));
        ImGui::TextColored(colours::dim_text, "%s", choice.help);
    }
}

}  // namespace

void ask_where_to_save_picture(Shell& shell) {
    const auto what = std::make_shared<int>(what_is_on_stage(shell));
    FileQuestion question;
    question.kind = FileQuestion::Kind::save;
    question.title = "Save picture";
    question.action = "Save";
    question.suggested = pictures_folder() / "";
    use_choice(shell, *what, question);
    question.choices = [&shell, what](FileQuestion& asked) { draw_choices(shell, *what, asked); };
    question.not_ready = [&shell, what] {
        return std::string(is_there(shell.studio, *what) ? "" : why_not_there(*what));
    };
    question.then = [&shell, what](const std::filesystem::path& file) { save(shell, *what, file); };
    shell.studio.file_dialog->ask(std::move(question));
}

}  // namespace livery
