#include "jobs/export_product.h"

#include "core/error.h"
#include "core/paths.h"
#include "mesh/gltf/gltf_write.h"

namespace livery {

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
