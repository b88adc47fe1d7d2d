// What a paint costs to draw on this machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ledger/predictions.h"

namespace livery {

struct PaintCost {
    std::optional<double> ns_a_pixel;  ///< of shading at normal quality, by the last ledger
    std::string why_not;               ///< when it is not known
};

/// Of any paint of that model, with glints or without; `costs` as known_pass_costs() gives them.
PaintCost paint_cost(const Material& material, const std::optional<std::vector<PassCost>>& costs);

}  // namespace livery
