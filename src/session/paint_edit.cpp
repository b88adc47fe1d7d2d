#include "session/paint_edit.h"

#include <algorithm>

#include <fmt/format.h>

#include "appearance/fit/recolour.h"
#include "appearance/material_library.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/parameter_table.h"
#include "core/error.h"
#include "session/naming.h"

namespace livery {

namespace {

const Material* own_paint(const Document& document, const std::string& name) {
    for (const Material& paint : document.paints) {
        if (same_paint_name(paint.name, name)) return &paint;
    }
    return nullptr;
}

std::ptrdiff_t times_used(const Document& document, const std::string& paint) {
    std::ptrdiff_t count = 0;
    for (const SessionLook& one : document.looks) {
        Look look = one.look;
        for_each_paint(look, [&](const std::string& name) { count += name == paint ? 1 : 0; });
    }
    return count;
}

/// Of a colour that this edit asked for, with what came of it. One that an earlier edit asked for
/// counts only until the paint is changed again.
std::string colour_asked_by(const Material& edited, const std::string& provenance_before) {
    const auto asked = colour_record(edited.provenance);
    return asked && edited.provenance != provenance_before ? text_of(*asked) : "";
}

/// What was edited is no longer what was measured or designed under that name.
std::string provenance_of_edit(const std::string& name) {
    return "edited in a session, from " + name;
}

}  // namespace

std::set<std::filesystem::path> unread_files(const Document& document,
                                             const SessionCommand& command) {
    std::set<std::filesystem::path> files;
    const auto add_named = [&](const std::string& name) {
        std::error_code error;
        const NamedPaint named = look_up(document, name);
        const bool is_file =
            !named.problem.empty() && std::filesystem::is_regular_file(name, error);
        if (is_file) files.insert(std::filesystem::absolute(name).lexically_normal());
        if (!is_read(named.material)) files.insert(named.material.measured->file);
    };
    Look look;
    if (const auto* painted = std::get_if<SetPaint>(&command)) {
        add_named(painted->paint);
    } else if (const auto* product = std::get_if<PaintProduct>(&command)) {
        add_named(product->paint);
    } else if (const auto* edit = std::get_if<EditPaint>(&command)) {
        if (!is_read(edit->material)) files.insert(edit->material.measured->file);
    } else if (const auto* artwork = std::get_if<SetArtwork>(&command)) {
        look.artwork = artwork->artwork;
    } else if (const auto* added = std::get_if<AddLook>(&command)) {
        look = portable_look(added->look);
    }
    for_each_paint(look, add_named);
    return files;
}

std::string known_paint(const Document& document, const std::string& name) {
    check_text(name, "the paint's name");
    const NamedPaint named = look_up(document, name);
    const bool is_own = own_paint(document, name) != nullptr;
    if (!is_own && !named.problem.empty()) throw std::invalid_argument(named.problem);
    // By its name where that leads to it, else by its whole path.
    if (is_own || library_of(document).find(name)) return named.material.name;
    const std::string file = std::filesystem::absolute(name).lexically_normal().string();
    if (!is_read(named.material)) check_argument(false, file + " was not read yet");
    return file;
}

void edit_paint(Document& document, const EditPaint& command) {
    check_name(command.material.name, "the paint's name");
    check_text(command.material.family, "the paint's family");
    check_text(command.material.provenance, "the paint's provenance");
    Material edited = kept_paint(command.material);
    edited = resolved(std::move(edited), library_of(document));
    check_argument(is_read(edited), edited.name + " was not read yet");
    // A step of long ago may name a file that is gone; a new one may not.
    check_argument(!edited.measured || edited.measured->problem.empty(),
                   edited.measured ? edited.measured->problem : "");
    edited.file.clear();

    const auto look = std::find_if(document.looks.begin(),
                                   document.looks.end(),
                                   [&](const auto& one) { return one.id == command.look; });
    auto& parts = look->look.parts;
    const auto worn = parts.find(command.part);
    const auto own =
        std::find_if(document.paints.begin(), document.paints.end(), [&](const Material& paint) {
            return worn != parts.end() && paint.name == worn->second;
        });
    const auto taken = [&](const std::string& name) {
        return own_paint(document, name) || library_of(document).find(name);
    };
    if (own != document.paints.end() && times_used(document, own->name) == 1) {
        edited.name = free_name(edited.name, [&](const std::string& name) {
            return !same_paint_name(own->name, name) && taken(name);
        });
        worn->second = edited.name;
        if (const std::string asked = colour_asked_by(edited, own->provenance); !asked.empty()) {
            edited.provenance = without_colour_record(own->provenance) + asked;
        } else if (!same_reflectance(edited, *own)) {
            edited.provenance = without_colour_record(edited.provenance);
        }
        *own = std::move(edited);
        return;
    }
    const std::string from = edited.name;
    edited.name = free_name(from, taken);
    const Material* before = own != document.paints.end() ? &*own : library_of(document).find(from);
    edited.provenance =
        provenance_of_edit(from) + colour_asked_by(edited, before ? before->provenance : "");
    parts[command.part] = edited.name;
    document.paints.push_back(std::move(edited));
}

void rename_paint(Document& document, const RenamePaint& command) {
    check_name(command.name, "the paint's name");
    const auto own =
        std::find_if(document.paints.begin(), document.paints.end(), [&](const Material& paint) {
            return same_paint_name(paint.name, command.paint);
        });
    if (own == document.paints.end()) {
        std::string known;
        for (const Material& paint : document.paints) {
            known += (known.empty() ? "" : ", ") + paint.name;
        }
        throw std::invalid_argument(fmt::format("\"{}\" is no paint of the session's own; there {}",
                                                command.paint,
                                                known.empty() ? "is none" : "are " + known));
    }
    const Material* other = own_paint(document, command.name);
    // Another way to write its own name is no other paint's.
    if ((other && other != &*own) || library_of(document).find(command.name)) {
        throw std::invalid_argument(
            fmt::format("there is a paint \"{}\" already; expected another name", command.name));
    }
    const std::string before = own->name;
    own->name = command.name;
    for (SessionLook& one : document.looks) {
        for_each_paint(one.look, [&](std::string& name) {
            if (name == before) name = command.name;
        });
    }
}

}  // namespace livery
