// Errors that OpenGL keeps to itself until asked.
#pragma once

#include <string_view>

namespace livery {

/// Turns the check after every draw, bind and update on or off for this thread (tests: on;
/// a running show: off, since asking stalls a hardware driver). Creation is always checked.
void set_gl_checks(bool on);
bool gl_checks();

/// Throws std::runtime_error that names `what` and every pending error ("GL_INVALID_VALUE").
void throw_on_gl_error(std::string_view what);

/// The same where checks are on.
void check_gl(std::string_view what);

}  // namespace livery
