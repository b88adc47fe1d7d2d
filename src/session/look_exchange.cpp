#include "session/look_exchange.h"

#include <algorithm>
#include <map>

#include "core/error.h"

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

}  // namespace livery
