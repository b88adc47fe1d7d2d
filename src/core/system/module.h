// Modules of ours: libraries that are loaded when somebody first needs what they link.
#pragma once

namespace livery {

/// What a module offers under that name: found beside the program, in an installation or a build;
/// stays open until the end. `called` is what people call it. Throws FileError.
void* symbol_of_module(const char* module_name, const char* symbol, const char* called);

}  // namespace livery
