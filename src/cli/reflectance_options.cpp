#include "cli/reflectance_options.h"

namespace livery {

std::vector<Option> reflectance_options(ReflectanceArguments& arguments) {
    return {
        {"--material",
         "FILE|NAME",
         "material file, or a paint of the library by its name",
         &arguments.material,
         true,
         {}},
        {"--precision",
         "KIND",
         "f32 or f64 on the processor, gpu in OpenGL (default f64)",
         &arguments.precision,
         false,
         {"f32", "f64", "gpu"}},
        {"--round-inputs",
         "",
         "round directions and parameters to float for f64 too, as the others do",
         &arguments.round_inputs,
         false,
         {}},
    };
}

ReflectanceSettings reflectance_settings(const ReflectanceArguments& arguments,
                                         const CommonOptions& common) {
    ReflectanceSettings settings;
    settings.precision = arguments.precision == "f32"   ? Precision::f32
                         : arguments.precision == "gpu" ? Precision::gpu
                                                        : Precision::f64;
    settings.gl = common.gl_device();
    settings.round_inputs = arguments.round_inputs;
    return settings;
}

}  // namespace livery
