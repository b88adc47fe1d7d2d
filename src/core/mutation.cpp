#include "core/mutation.h"

#include <cstdlib>
#include <string_view>

namespace livery {

double mutation_factor(const char* name) {
    const char* chosen = std::getenv("LIVERY_MUTATION");
    return chosen && std::string_view(chosen) == name ? 1.02 : 1.0;
}

std::string mutated_glsl(std::string text) {
    const char* chosen = std::getenv("LIVERY_MUTATION");
    const std::string call = "MUTATED(" + std::string(chosen ? chosen : "") + ",";
    const std::string mutated = "MUTATED_HERE(";
    bool any = false;
    for (auto at = text.find(call); at != text.npos; at = text.find(call, at)) {
        text.replace(at, call.size(), mutated);
        any = true;
    }
    if (any) {
        text.insert(text.find('\n', text.find("#version")) + 1,
                    "#define MUTATED_HERE(x) ((x) * 1.02)\n");
    }
    return text;
}

}  // namespace livery
