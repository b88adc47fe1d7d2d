#include "session/document.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "appearance/material_library.h"
#include "appearance/measured/measured_paint.h"
#include "core/error.h"
#include "scene/library.h"
#include "session/naming.h"
#include "twin/description.h"

namespace livery {

const PaintLibrary& library_of(const Document& document) {
    static const PaintLibrary none;
    return document.library ? *document.library : none;
}

std::string product_reference(const std::string& name_or_file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(name_or_file, error)) return name_or_file;
    return std::filesystem::absolute(name_or_file).string();
}

Document new_document(const std::string& product, std::optional<LengthUnit> unit) {
    check_text(product, "the product's name");
    Document document;
    document.product_unit = unit;
    document.product = product_reference(product);
    const auto bench = bench_of_shipped_product(product);
    const auto own = bench ? nullptr : find_product(product, unit);
    const std::vector<std::string> parts = own ? part_names(own->mesh) : part_names(product);
    document.library = read_paint_library();
    for (const std::string& name : shipped_looks()) {
        Look look = find_look_for(name, parts);
        for_each_paint(look, [&](std::string& paint) {
            const Material* known = document.library->find(paint);
            if (!known) throw FileError(look.file, "parts", paint, "a paint's name");
            paint = known->name;
        });
        if (document.looks.empty()) document.exposure_ev = look.exposure_ev;
        look.exposure_ev = 0.0;
        look.file.clear();
        document.looks.push_back({document.next_look_id++, std::move(look)});
    }
    for (Look& look : own ? own_looks(own->mesh) : std::vector<Look>()) {
        const bool taken = std::any_of(
            document.looks.begin(), document.looks.end(), [&](const SessionLook& other) {
                return other.look.name == look.name;
            });
        if (taken) look.name += " of the file";
        look.exposure_ev = 0.0;
        document.looks.push_back({document.next_look_id++, std::move(look)});
    }
    if (!own) {
        document.bench = *bench;
        document.eye_mm = read_bench_file(document.bench).eye_mm;
    } else {
        document.eye_mm = default_eye_mm(*own);
    }
    return document;
}

const SessionLook* find_look(const Document& document, int id) {
    for (const SessionLook& look : document.looks) {
        if (look.id == id) return &look;
    }
    return nullptr;
}

Document in_library(Document document, std::shared_ptr<const PaintLibrary> library) {
    document.library = std::move(library);
    for (Material& paint : document.paints) {
        paint = resolved(std::move(paint), library_of(document));
    }
    return document;
}

Document with_paints_read(Document document) {
    document = in_library(std::move(document), read_paint_library(document.library));
    const auto unread = unread_files(document);
    if (unread.empty()) return document;
    auto library = read_paint_library(document.library, unread);
    return in_library(std::move(document), std::move(library));
}

glm::dvec3 eye_in_use_mm(const Document& document) {
    return eye_in_use_mm(document.eye_mm, document.seats, document.eye_choice);
}

NamedPaint look_up(const Document& document, const std::string& name) {
    for (const Material& paint : document.paints) {
        if (!same_paint_name(paint.name, name)) continue;
        NamedPaint named{paint, paint.measured ? paint.measured->problem : ""};
        return named;
    }
    return look_up(library_of(document), name);
}

Material find_paint(const Document& document, const std::string& name) {
    NamedPaint named = look_up(document, name);
    if (!named.problem.empty()) throw std::invalid_argument(named.problem);
    return std::move(named.material);
}

std::set<std::filesystem::path> unread_files(const Document& document) {
    std::set<std::filesystem::path> files;
    const auto add = [&](const Material& paint) {
        if (!is_read(paint)) files.insert(paint.measured->file);
    };
    for (const Material& paint : document.paints) add(paint);
    for (const SessionLook& one : document.looks) {
        Look look = one.look;
        for_each_paint(look,
                       [&](const std::string& name) { add(look_up(document, name).material); });
    }
    return files;
}

std::vector<std::string> paint_names(const Document& document) {
    const PaintLibrary& library = library_of(document);
    std::vector<std::string> names;
    for (const auto* paints :
         {&document.paints, &library.shipped, &library.users, &library.unread}) {
        for (const Material& paint : *paints) {
            const bool known = std::any_of(names.begin(), names.end(), [&](const auto& name) {
                return same_paint_name(name, paint.name);
            });
            if (!known) names.push_back(paint.name);
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

Scene scene_of(const Document& document,
               int look_id,
               std::shared_ptr<const Product> product,
               const std::shared_ptr<const Environment>& loaded) {
    const SessionLook* found = find_look(document, look_id);
    check_argument(found != nullptr, "scene_of: there is no look " + std::to_string(look_id));
    Look look = found->look;
    std::erase_if(look.artwork, [](const Artwork& artwork) { return picture_problem(artwork); });
    look.exposure_ev = document.exposure_ev;
    const auto find = [&](const std::string& name) { return look_up(document, name).material; };
    if (environment_problem(look.environment)) look.environment = {};
    return make_scene(
        std::move(product), look, find, eye_in_use_mm(document), loaded, Unwearable::left_out);
}

std::vector<std::string> drawing_problems(const Document& document, const SessionLook& look) {
    std::vector<std::string> problems;
    std::set<std::string> seen;
    Look here = look.look;
    for_each_paint(here, [&](const std::string& name) {
        if (!seen.insert(name).second) return;
        const std::string why = look_up(document, name).problem;
        if (!why.empty()) problems.push_back(fmt::format("\"{}\" is black: {}", name, why));
    });
    for (const Artwork& artwork : look.look.artwork) {
        if (const auto why = picture_problem(artwork)) {
            problems.push_back(fmt::format(
                "The picture on {} of {} is not shown: {}", artwork.part, look.look.name, *why));
        }
    }
    if (const auto why = environment_problem(look.look.environment)) {
        problems.push_back(
            fmt::format("{} is lit without its environment: {}", look.look.name, *why));
    }
    return problems;
}

std::vector<std::string> drawing_problems(const Document& document) {
    std::vector<std::string> problems;
    for (const SessionLook& look : document.looks) {
        for (const std::string& one : drawing_problems(document, look)) {
            const bool told = std::find(problems.begin(), problems.end(), one) != problems.end();
            if (!told) problems.push_back(one);
        }
    }
    return problems;
}

}  // namespace livery
