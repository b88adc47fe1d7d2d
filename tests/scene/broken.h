// Files with one thing wrong.
#pragma once

#include <functional>

#include "core/json.h"

namespace livery {

struct Broken {
    const char* what;
    std::function<void(Json&)> damage;  ///< of a good file
    const char* message;                ///< a part of what a person reads
};

}  // namespace livery
