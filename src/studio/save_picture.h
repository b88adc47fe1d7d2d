// Save picture...: what the stage shows, as a file.
#pragma once

namespace livery {

struct Shell;

void open_save_picture(Shell& shell);
void draw_save_picture(Shell& shell);  ///< once a frame

}  // namespace livery
