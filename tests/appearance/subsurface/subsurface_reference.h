// Tables of an independent photon code (LIVERY_REFERENCE_DATA), per unit power that enters.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "appearance/subsurface/monte_carlo.h"
#include "core/paths.h"
#include "core/text/csv.h"

namespace livery {

struct ReferenceTable {
    std::string name;
    ScatteringMedium medium;
    std::vector<ProfileRing> rings;
    std::vector<Estimate> rd, rt;
};

inline std::vector<ReferenceTable> reference_tables(const std::filesystem::path& data) {
    const ScatteringMedium marble{0.0041, 2.62, 0.0, 1.5, {}}, skin{0.17, 0.88, 0.0, 1.3, {}};
    std::vector<ReferenceTable> tables;
    const auto add =
        [&](const std::string& name, ScatteringMedium medium, double eta, double slab) {
            medium.eta = eta;
            if (slab > 0.0) medium.thickness_mm = slab;
            ReferenceTable table{name, medium, {}, {}, {}};
            const auto file = data / "montecarlo" / (name + "_g0_r.csv");
            const std::string text = read_text_file(file);
            CsvReader csv(text, file);
            const double entering = 1.0 - unscattered_light(medium).specular;
            while (csv.next()) {
                table.rings.push_back({csv.number(0), csv.number(1)});
                table.rd.push_back({csv.number(3) / entering, csv.number(4) / entering});
                table.rt.push_back({csv.number(5) / entering, csv.number(6) / entering});
            }
            tables.push_back(table);
        };
    add("marble_g_n1.5_semi", marble, 1.5, 0.0);
    add("skin1_g_n1.3_semi", skin, 1.3, 0.0);
    add("skin1_g_n1_semi", skin, 1.0, 0.0);
    add("marble_g_n1.5_slab2mm", marble, 1.5, 2.0);
    add("skin1_g_n1.3_slab2mm", skin, 1.3, 2.0);
    return tables;
}

}  // namespace livery
