// Tests that run once on each device that shades.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "radiance/lanes/input_layers.h"

namespace livery::testing {

inline std::string name_of_device(const ::testing::TestParamInfo<ShadingDevice>& device) {
    return device.param == ShadingDevice::gl ? "OpenGl" : "Processor";
}

}  // namespace livery::testing

#define LIVERY_ON_BOTH_DEVICES(suite)                                                        \
    INSTANTIATE_TEST_SUITE_P(Devices,                                                        \
                             suite,                                                          \
                             ::testing::Values(ShadingDevice::gl, ShadingDevice::processor), \
                             ::livery::testing::name_of_device)

/// On one device at each change, on the other one at night.
#define LIVERY_ON_DEVICES(suite, daily, nightly)                                      \
    INSTANTIATE_TEST_SUITE_P(                                                         \
        Devices, suite, ::testing::Values(daily), ::livery::testing::name_of_device); \
    INSTANTIATE_TEST_SUITE_P(                                                         \
        NightlyDevices, suite, ::testing::Values(nightly), ::livery::testing::name_of_device)
