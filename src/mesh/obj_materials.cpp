#include "mesh/obj_materials.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/utf8.h"
#include "mesh/text_cursor.h"

namespace livery {

void read_obj_colours(std::string_view text,
                      const std::filesystem::path& file,
                      ObjColours& colours,
                      std::vector<std::string>& notes) {
    TextCursor cursor(text);
    cursor.comments_begin_with = '#';
    std::string material;
    for (; !cursor.at_end(); cursor.next_line()) {
        const std::string_view keyword = cursor.word();
        if (keyword == "newmtl") {
            material = printable(cursor.rest_of_line());
        } else if (keyword == "map_Kd") {
            notes.push_back(fmt::format("material \"{}\": the picture \"{}\" is not read",
                                        material,
                                        printable(cursor.rest_of_line(), 100)));
        } else if (keyword == "Kd") {
            glm::dvec3 colour(0.0);
            for (int channel = 0; channel < 3; ++channel) {
                const std::string_view word = cursor.word();
                const bool is_number = read_number(word, colour[channel]);
                if (is_number && colour[channel] >= 0.0 && colour[channel] <= 1.0) continue;
                throw FileError(file,
                                fmt::format("line {}: Kd", cursor.line()),
                                word.empty() ? "nothing" : "\"" + printable(word, 40) + "\"",
                                "three numbers between 0 and 1");
            }
            colours[material] = colour;
        }
    }
}

}  // namespace livery
