// What the window draws by itself, once a frame: regions, menus, bars, notices.
#pragma once

namespace livery {

struct Studio;

void draw_layout(Studio& studio);
void draw_notices(Studio& studio);
void draw_projector_bar(Studio& studio);
void draw_status_line(Studio& studio);

}  // namespace livery
