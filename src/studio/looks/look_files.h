// Looks, sessions and pictures from and to files, asked for in the window.
#pragma once

namespace livery {

struct Studio;

void ask_for_look_file(Studio& studio);
void ask_where_to_export_look(Studio& studio);
void ask_where_to_export_product(Studio& studio);
void ask_where_to_save_session(Studio& studio);

void ask_where_to_save_picture(Studio& studio);

}  // namespace livery
