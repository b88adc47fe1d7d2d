#include "session/document.h"

#include "appearance/material_library.h"
#include "core/error.h"
#include "session/library.h"
#include "session/naming.h"
#include "twin/description.h"

namespace livery {

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
    PaintLibrary library;
    library.shipped = read_shipped_paints();
    for (const std::string& name : shipped_looks()) {
        Look look = find_look_for(name, parts);
        for_each_paint(look, [&](std::string& paint) {
            const Material* known = library.find(paint);
            if (!known) throw FileError(look.file, "parts", paint, "a paint's name");
            paint = known->name;
        });
        if (document.looks.empty()) document.exposure_ev = look.exposure_ev;
        look.exposure_ev = 0.0;
        look.file.clear();
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

std::vector<std::string> paint_names(const Document& document) {
    const PaintLibrary library = read_paint_library();
    std::vector<std::string> names;
    for (const auto* paints : {&document.paints, &library.shipped, &library.users}) {
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
    // The library is read once for all parts: a scene is made whenever the pointer moves.
    std::vector<Material> paints = document.paints;
    const PaintLibrary library = read_paint_library();
    for (const auto* more : {&library.shipped, &library.users}) {
        paints.insert(paints.end(), more->begin(), more->end());
    }
    return make_scene(
        std::move(product), look, document.eye_mm, loaded, paints, Unwearable::left_out);
}

}  // namespace livery
