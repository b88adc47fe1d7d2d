// The command line program as the tests call it.
#pragma once

#include <string>
#include <vector>

#include "support/run_program.h"

namespace livery {

inline ProgramRun livery_run(const std::vector<std::string>& arguments) {
    return run_program(LIVERY_PROGRAM, arguments);
}

}  // namespace livery
