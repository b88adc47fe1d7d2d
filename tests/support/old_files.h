// Files that an older Livery wrote: tests/data/README.md says which, and how.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <zlib.h>

#include "support/temporary_folder.h"

namespace livery::testing {

/// The calibration under which the first round was voted on.
inline constexpr const char* kOldCalibrationId = "9a65daa9652f16e505258190faecbd9d";

/// All of them, uncompressed, in a folder of that folder, where they may be changed.
inline std::filesystem::path unpacked_old_files(const TemporaryFolder& folder) {
    namespace fs = std::filesystem;
    const fs::path kept = fs::path(LIVERY_TEST_DATA) / "old/1f0b929", to = folder / "old";
    for (const auto& entry : fs::recursive_directory_iterator(kept)) {
        if (!entry.is_regular_file()) continue;
        fs::path file = to / entry.path().lexically_relative(kept);
        if (file.extension() == ".gz") file.replace_extension();
        fs::create_directories(file.parent_path());
        // What is not compressed comes as it is.
        const gzFile from = gzopen(entry.path().c_str(), "rb");
        std::ofstream stream(file, std::ios::binary);
        char part[16384];
        int size = 0;
        while ((size = gzread(from, part, sizeof(part))) > 0) stream.write(part, size);
        gzclose(from);
        if (size < 0 || !stream) throw std::runtime_error("cannot unpack " + file.string());
    }
    return to;
}

}  // namespace livery::testing
