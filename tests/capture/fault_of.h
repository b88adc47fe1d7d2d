// What a camera fails with.
#pragma once

#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "capture/camera.h"

namespace livery {

/// The fault that `call` ends with; it says what to do.
inline CameraFault fault_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const CameraFault& fault) {
        EXPECT_FALSE(fault.fix().empty()) << fault.why();
        return fault;
    }
    throw std::runtime_error("no fault");
}

}  // namespace livery
