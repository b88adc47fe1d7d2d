// What `livery brdf` and `livery albedo` have in common.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "cli/command.h"
#include "ledger/reflectance_values.h"

namespace livery {

struct ReflectanceArguments {
    std::string material, precision = "f64";
    bool round_inputs = false;
};

/// A paint, or a measured one by its file.
using AnyReflectance = std::variant<Material, MeasuredReflectance>;
AnyReflectance find_reflectance(const std::string& name_or_file);
/// The paint's name, or the file's.
std::string name_of(const AnyReflectance& reflectance);
/// What about the measurement limits the answer, for a person and for scripts: format, samples,
/// masked, and of the grid what it loses. Nothing for a paint.
void tell_measurement(const AnyReflectance& reflectance,
                      const ReflectanceSettings& settings,
                      Outcome& outcome);

std::vector<Option> reflectance_options(ReflectanceArguments& arguments);
ReflectanceSettings reflectance_settings(const ReflectanceArguments& arguments,
                                         const CommonOptions& common);

}  // namespace livery
