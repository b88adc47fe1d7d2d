// compensate_again() with the instruction set said, so that tests can compare them.
#pragma once

#include "compensation/compensation.h"
#include "compensation/kernel.h"

namespace livery {

void compensate_with(const kernel::Functions& functions,
                     const CompensationTable& table,
                     const ImageF& wanted_working,
                     std::size_t covered_pixels,
                     Image8* drive,
                     CompensationStats* stats);

}  // namespace livery
