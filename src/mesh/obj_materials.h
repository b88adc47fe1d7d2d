// The colours in a material library (.mtl) of an OBJ. Internal to mesh/.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace livery {

using ObjColours = std::map<std::string, glm::dvec3>;  ///< by material; linear Rec.709

/// Reads `Kd` of each material; `notes` receives what is not read, by name. Throws FileError.
void read_obj_colours(std::string_view text,
                      const std::filesystem::path& file,
                      ObjColours& colours,
                      std::vector<std::string>& notes);

}  // namespace livery
