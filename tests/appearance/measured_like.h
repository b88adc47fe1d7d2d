// A paint as an instrument would have measured it: a formula's values on a grid.
#pragma once

#include <memory>
#include <string>

#include "appearance/bsdf.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/merl_bytes.h"
#include "core/colour.h"

namespace livery {

inline Material measured_like(const Material& formula) {
    const f64::BsdfParameters p = parameters_of_f64(formula);
    const std::string bytes = merl_bytes([&](const glm::dvec3& wi, const glm::dvec3& wo) {
        return rec709_from_working() * evaluate(formula.model, p, wi, wo);
    });
    const std::string file = "measured " + formula.name + ".binary";
    Material material;
    material.name = "measured " + formula.name;
    material.model = ReflectanceModel::measured;
    material.measured = std::make_shared<MeasuredPaint>(
        measured_paint(measured_from(parse_merl(bytes, file), file)));
    return material;
}

}  // namespace livery
