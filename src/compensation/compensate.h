// compensate_into() with the instruction set said, so that tests can compare them.
#pragma once

#include "compensation/compensation.h"
#include "compensation/kernel.h"

namespace livery {

void compensate_with(const kernel::Functions& functions,
                     const CompensationTable& table,
                     const ImageF& wanted_working,
                     Image8* drive,
                     CompensationStats* stats);

}  // namespace livery
