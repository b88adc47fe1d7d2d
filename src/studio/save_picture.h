// Save picture...: what the stage shows, as a file.
#pragma once

namespace livery {

struct Shell;

void ask_where_to_save_picture(Shell& shell);

}  // namespace livery
