#include "pointer.h"

#include <X11/Xlib.h>
#include <X11/extensions/Xfixes.h>

namespace livery {

int visible_pointer_pixels() {
    Display* display = XOpenDisplay(nullptr);
    if (!display) return -1;
    int opaque = 0;
    if (XFixesCursorImage* image = XFixesGetCursorImage(display)) {
        for (int i = 0; i < image->width * image->height; ++i) {
            opaque += (image->pixels[i] >> 24u & 0xFFu) != 0 ? 1 : 0;
        }
        XFree(image);
    }
    XCloseDisplay(display);
    return opaque;
}

}  // namespace livery
