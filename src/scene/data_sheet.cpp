#include "scene/data_sheet.h"

namespace livery {

View projector_of(const DataSheets& sheets, int width, int height) {
    View view;
    view.width = width;
    view.height = height;
    view.focal_px = glm::dvec2(sheets.throw_ratio * width);
    // Rows go down: a picture thrown upward has its axis near its lower edge.
    view.principal_px = {0.5 * width, (0.5 + sheets.lens_shift) * height};
    return view;
}

View camera_of(const DataSheets& sheets, int width, int height) {
    View view;
    view.width = width;
    view.height = height;
    view.focal_px = glm::dvec2(sheets.focal_mm / sheets.sensor_width_mm * width);
    view.principal_px = {0.5 * width, 0.5 * height};
    return view;
}

}  // namespace livery
