// What the plan panel remembers between frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studio/quality_costs.h"

namespace livery {

struct PlanPanelState {
    MeasuredCosts measured;
    bool costs_read = false;
    std::optional<std::vector<PassCost>> costs;
    std::string problem;
};

}  // namespace livery
