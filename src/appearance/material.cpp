#include "appearance/material.h"

#include <fmt/format.h>

#include "appearance/measured/measured_paint.h"

namespace livery {

bool is_measured(const Material& material) { return material.model == ReflectanceModel::measured; }

bool is_translucent(const Material& material) {
    return material.model == ReflectanceModel::translucent && material.medium;
}

bool has_film(const Material& material) {
    return material.model == ReflectanceModel::car_paint && material.film_nm > 0.0;
}

bool has_glints(const Material& material) {
    return material.model == ReflectanceModel::car_paint && material.glint_density_per_mm2 > 0.0;
}

std::string glint_scale_text(const Material& material) {
    return material.glint_scale > 1.0
               ? fmt::format("exaggerated {:.3g} times", material.glint_scale)
               : "physical";
}

bool is_read(const Material& material) {
    return !is_measured(material) || !material.measured || !material.measured->unread;
}

Material with_measured_read(Material material) {
    if (!is_read(material)) material.measured = read_measured_paint(material.measured->file);
    return material;
}

}  // namespace livery
