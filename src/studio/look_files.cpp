#include "studio/look_files.h"

#include <cctype>

#include <fmt/format.h>

#include "core/error.h"
#include "jobs/export_product.h"
#include "scene/look.h"
#include "session/look_exchange.h"
#include "studio/kit/user_folders.h"
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

void ask_for_look(Shell& shell) {
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

}  // namespace livery
