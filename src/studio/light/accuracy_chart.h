// Error against time of the accuracy ledger's levels, both logarithmic.
#pragma once

#include <vector>

#include "ledger/accuracy/accuracy.h"

namespace livery {

/// "shadows: sharp"; a quality by its name alone.
std::string label_of(const AccuracyLevel& level);

/// The width of the row, `height` pixels. The level whose mark the pointer is at, else -1;
/// `pointed` is drawn larger.
int draw_accuracy_chart(const std::vector<AccuracyLevel>& levels,
                        const std::vector<bool>& on_front,
                        int pointed,
                        float height);

}  // namespace livery
