// Looks, sessions and pictures from and to files, asked for in the window.
#pragma once

#include <string>

namespace livery {

struct Shell;

void ask_for_look_file(Shell& shell);
void ask_where_to_export_look(Shell& shell);
void ask_where_to_export_product(Shell& shell);
void ask_where_to_save_session(Shell& shell);

/// "Blue metallic / 2" -> "Blue-metallic-2": for file names.
std::string file_name_of(const std::string& name);

struct Shell;

void ask_where_to_save_picture(Shell& shell);

}  // namespace livery
