#include "evaluation/statistics/significance.h"

#include <fmt/format.h>

namespace livery {

std::string p_words(double p) {
    return p < 0.0001 ? std::string("p < 0.0001") : fmt::format("p = {:.2g}", p);
}

}  // namespace livery
