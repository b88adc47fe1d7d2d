// What a paint costs to draw on this machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "appearance/material.h"
#include "ledger/pass_costs.h"

namespace livery {

struct PaintCost {
    std::optional<double> ns_a_pixel;  ///< of shading
    std::string why_not;               ///< when it is not known
};

/// Of any paint of that model, with glints or without; `costs` as known_pass_costs() has them.
PaintCost paint_cost(const Material& material, const std::vector<PassCost>& costs);

}  // namespace livery
