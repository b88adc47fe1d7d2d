#include "scene/data_sheet_io.h"

namespace livery {

DataSheets read_data_sheets(const JsonReader& json) {
    json.allow_only(
        {"throw_ratio", "lens_shift", "focal_mm", "sensor_width_mm", "lens_distance_mm"});
    DataSheets sheets;
    sheets.throw_ratio = json["throw_ratio"].number_between(0.1, 20.0);
    sheets.lens_shift = json["lens_shift"].number_between(-2.0, 2.0);
    sheets.focal_mm = json["focal_mm"].number_between(1.0, 5000.0);
    sheets.sensor_width_mm = json["sensor_width_mm"].number_between(1.0, 200.0);
    sheets.lens_distance_mm = json["lens_distance_mm"].number_between(1.0, 1e5);
    return sheets;
}

Json json_of(const DataSheets& sheets) {
    return {{"throw_ratio", sheets.throw_ratio},
            {"lens_shift", sheets.lens_shift},
            {"focal_mm", sheets.focal_mm},
            {"sensor_width_mm", sheets.sensor_width_mm},
            {"lens_distance_mm", sheets.lens_distance_mm}};
}

}  // namespace livery
