// What people read where there is no desktop; what windows do is tested where there is one.
#include "gl/window.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace livery {
namespace {

std::string refusal_with_display(const char* display) {
    if (display) {
        ::setenv("DISPLAY", display, 1);
    } else {
        ::unsetenv("DISPLAY");
    }
    try {
        const WindowSystem system;
        return "opened";
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

TEST(WindowSystem, WithoutADisplaySaysWhatToDo) {
    const std::string missing = refusal_with_display(nullptr);
    EXPECT_NE(missing.find("no window can be opened: X11: The DISPLAY environment variable is "
                           "missing. Is DISPLAY set? Without a display every command but the "
                           "desktop works"),
              std::string::npos)
        << missing;
    const std::string wrong = refusal_with_display(":4711");
    EXPECT_NE(wrong.find("X11: Failed to open display :4711"), std::string::npos) << wrong;
    ::unsetenv("DISPLAY");
}

}  // namespace
}  // namespace livery
