// What `livery brdf` and `livery albedo` have in common.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "session/reflectance_values.h"

namespace livery {

struct ReflectanceArguments {
    std::string material, precision = "f64";
    bool round_inputs = false;
};

std::vector<Option> reflectance_options(ReflectanceArguments& arguments);
ReflectanceSettings reflectance_settings(const ReflectanceArguments& arguments,
                                         const CommonOptions& common);

}  // namespace livery
