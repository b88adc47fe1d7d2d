#include <array>

#include "calibration/registration/picked_points.h"
#include "core/paths.h"
#include "core/text/csv.h"

namespace livery {

std::vector<MeshPick> read_picked_points(const std::filesystem::path& file) {
    return parse_picked_points(read_text_file(file), file);
}

std::vector<MeshPick> parse_picked_points(const std::string& text,
                                          const std::filesystem::path& file) {
    CsvReader csv(text, file);
    constexpr const char* kColumns = "x_mm,y_mm,z_mm,u_px,v_px";
    std::array<std::size_t, 5> columns{};
    const char* names[] = {"x_mm", "y_mm", "z_mm", "u_px", "v_px"};
    for (std::size_t k = 0; k < 5; ++k) columns[k] = csv.column(names[k], kColumns);
    std::vector<MeshPick> points;
    while (csv.next()) {
        const auto number = [&](std::size_t k) { return csv.number(columns[k]); };
        points.push_back(
            {{number(0), number(1), number(2)}, {number(3) + 0.5, number(4) + 0.5}, csv.place()});
    }
    return points;
}

}  // namespace livery
