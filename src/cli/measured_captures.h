// What every command that measures from photographs asks for.
#pragma once

#include <string>

#include "cli/command.h"

namespace livery {

inline Option captures_option(std::string* folder) {
    return {"--captures",
            "DIR",
            "photographs with their manifest.json (docs/measuring.md)",
            folder,
            true,
            {}};
}

inline Option camera_to_xyz_option(std::string* file) {
    return {"--camera-to-xyz",
            "FILE",
            "matrix of linear camera RGB to XYZ (default: as the manifest says, else Rec.709)",
            file,
            false,
            {}};
}

}  // namespace livery
