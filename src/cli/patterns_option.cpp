#include "cli/patterns_option.h"

namespace livery {

Option patterns_option(std::string& target) {
    return {"--patterns",
            "FILE|DIR",
            "what photographs without a manifest.json show, in the order of their names: the "
            "patterns' folder or its manifest",
            &target,
            false,
            {}};
}

}  // namespace livery
