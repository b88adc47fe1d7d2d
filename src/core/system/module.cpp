#include "core/system/module.h"

#include <filesystem>
#include <string>

#include <dlfcn.h>

#include "core/error.h"
#include "core/paths.h"

namespace livery {

void* symbol_of_module(const char* module_name, const char* symbol, const char* called) {
    const std::filesystem::path places[] = {executable_folder() / "../lib/livery",
                                            executable_folder() / "../lib"};
    std::string tried;
    for (const auto& place : places) {
        const auto file = (place / module_name).lexically_normal();
        if (std::error_code error; !std::filesystem::exists(file, error)) {
            tried += (tried.empty() ? "" : ", ") + file.parent_path().string();
            continue;
        }
        void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* found = library ? ::dlsym(library, symbol) : nullptr;
        if (!found) throw FileError(file, "", ::dlerror(), called);
        return found;
    }
    throw FileError(module_name, "", "nothing in " + tried, called);
}

}  // namespace livery
