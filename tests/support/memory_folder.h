// Where files cost no waiting for a disk, for tests that write thousands.
#pragma once

#include <filesystem>

namespace livery {

inline std::filesystem::path memory_folder() {
    std::error_code error;
    return std::filesystem::is_directory("/dev/shm", error)
               ? std::filesystem::path("/dev/shm")
               : std::filesystem::temp_directory_path();
}

}  // namespace livery
