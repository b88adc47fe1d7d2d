#include "studio/capture/data_sheet_settings.h"

#include <array>
#include <charconv>

#include <fmt/format.h>

namespace livery {

namespace {

struct Field {
    const char* name;
    double DataSheets::*value;
};
constexpr std::array<Field, 5> kFields{{{"throw-ratio", &DataSheets::throw_ratio},
                                        {"lens-shift", &DataSheets::lens_shift},
                                        {"focal-mm", &DataSheets::focal_mm},
                                        {"sensor-width-mm", &DataSheets::sensor_width_mm},
                                        {"lens-distance-mm", &DataSheets::lens_distance_mm}}};

}  // namespace

DataSheets kept_data_sheets(const UserSettings& settings) {
    DataSheets sheets{0.0, 0.5, 0.0, 0.0, 0.0};
    for (const Field& field : kFields) {
        const std::string text = setting(settings, field.name);
        double value = 0.0;
        const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
        if (read.ec == std::errc()) sheets.*field.value = value;
    }
    return sheets;
}

void keep_data_sheets(UserSettings& settings, const DataSheets& sheets) {
    for (const Field& field : kFields)
        keep_setting(settings, field.name, fmt::format("{}", sheets.*field.value));
}

}  // namespace livery
