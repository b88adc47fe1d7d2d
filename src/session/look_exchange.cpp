#include "session/look_exchange.h"

#include <algorithm>
#include <map>

#include "core/error.h"
#include "core/paths.h"
#include "mesh/gltf_write.h"

namespace livery {

namespace {

/// "out.json" and "solid red 2" -> "out solid red 2.json".
std::string material_file_name(const std::filesystem::path& look_file, const std::string& paint) {
    std::string name = look_file.stem().string() + " " + paint + ".json";
    std::replace(name.begin(), name.end(), '/', '-');
    return name;
}

}  // namespace

std::vector<std::filesystem::path> export_look(const Document& document,
                                               int look_id,
                                               const std::filesystem::path& file) {
    const SessionLook* found = find_look(document, look_id);
    check_argument(found != nullptr, "there is no look " + std::to_string(look_id));
    Look look = found->look;
    look.exposure_ev = document.exposure_ev;
    std::vector<std::filesystem::path> written = {file};
    std::map<std::string, std::string> files;  // by paint
    for_each_paint(look, [&](std::string& paint) {
        const auto own = std::find_if(document.paints.begin(),
                                      document.paints.end(),
                                      [&](const Material& one) { return one.name == paint; });
        if (own == document.paints.end()) return;
        if (!files.contains(paint)) {
            files[paint] = material_file_name(file, paint);
            written.push_back(file.parent_path() / files[paint]);
            write_material_file(written.back(), *own);
        }
        paint = files[paint];
    });
    write_look_file(file, look);
    return written;
}

std::vector<std::string> export_product(const Document& document,
                                        const std::shared_ptr<const Product>& product,
                                        int look_id,
                                        const std::filesystem::path& file) {
    check_argument(find_look(document, look_id) != nullptr,
                   "there is no look " + std::to_string(look_id));
    std::vector<MeshLook> looks;
    std::vector<std::string> notes;
    for (const SessionLook& one : document.looks) {
        const Scene scene = scene_of(document, one.id, product);
        if (!scene.artwork.empty() || !scene.relief.empty()) {
            notes.push_back("the artwork of \"" + one.look.name + "\" is not in the file");
        }
        MeshLook look{one.look.name, scene.part_materials};
        looks.insert(one.id == look_id ? looks.begin() : looks.end(), std::move(look));
    }
    write_text_file(file, gltf_bytes(product->mesh, looks, notes));
    return notes;
}

}  // namespace livery
