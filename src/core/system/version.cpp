#include "core/system/version.h"

namespace livery {

std::string version_text() {
    const std::string commit = LIVERY_COMMIT;
    return "livery " LIVERY_VERSION + (commit.empty() ? "" : " (" + commit + ")") +
           "\nBuilt with " LIVERY_COMPILER
           ".\nMIT licence; the libraries' are listed in third-party.md, in the documentation.\n";
}

std::string version_number() { return LIVERY_VERSION; }

std::string built_with() { return LIVERY_COMPILER "; " LIVERY_BUILT_WITH; }

std::string version_date() { return LIVERY_VERSION_DATE; }

}  // namespace livery
