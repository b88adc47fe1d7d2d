// One program at a time on a file.
#pragma once

#include <filesystem>

namespace livery {

/// Holds `FILE.lock` beside a file; the system lets go of it when the program ends, however it
/// ends.
class FileLock {
  public:
    /// Throws Refused when another holds it (`what` begins the message, the holder's process ends
    /// it; with the fix), FileError when the folder cannot be written.
    FileLock(const std::filesystem::path& file, const std::string& what, const std::string& fix);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    std::filesystem::path lock_file_;
    int descriptor_ = -1;
};

}  // namespace livery
