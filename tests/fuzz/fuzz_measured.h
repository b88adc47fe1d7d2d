// What samples promise once a file of them was read: reflectance wherever it is asked for.
#pragma once

#include <cmath>
#include <utility>

#include "appearance/measured/half_difference.h"
#include "appearance/measured/measured_reflectance.h"
#include "fuzz/fuzz.h"

namespace livery::fuzz {

inline void evaluate_everywhere(MeasuredSamples samples, MeasuredFormat format) {
    require(samples.values.size() == samples.pairs.size() * samples.channels(), "whole rows");
    const DirectionPair first = samples.pairs.front();
    const auto measured = measured_from(std::move(samples), format, "a");
    for (const double theta_h : {0.0, 0.01, 1.0, 1.5707}) {
        for (const double theta_d : {0.0, 0.3, 1.5707}) {
            for (const double phi_d : {0.0, 1.0, 3.1}) {
                const glm::dvec3 value = evaluate_at(measured, {theta_h, theta_d, phi_d});
                require(std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z),
                        "finite");
            }
        }
    }
    is_measured(measured, first.wi, first.wo);
}

}  // namespace livery::fuzz
