// Which OpenGL the tests draw with.
#pragma once

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "gl/context.h"

namespace livery {

/// Software, so that a test is the same on every machine, unless LIVERY_TEST_GL is "hardware": then
/// a graphics card, and what has none fails. Throws std::runtime_error for any other value.
inline GlDevice tested_gl() {
    const char* wanted = std::getenv("LIVERY_TEST_GL");
    const std::string device = wanted && *wanted ? wanted : "software";
    if (device == "software") return GlDevice::software;
    if (device == "hardware") return GlDevice::hardware;
    throw std::runtime_error("LIVERY_TEST_GL: found \"" + device +
                             "\", expected software or hardware");
}

}  // namespace livery
