#include "session/file_lock.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"

namespace livery {

namespace {

/// The process that wrote itself into the lock file; empty while it has not yet.
std::string holder_of(int descriptor) {
    char text[32] = {};
    const ssize_t size = ::pread(descriptor, text, sizeof text - 1, 0);
    std::string process(text, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    process.erase(std::find_if_not(process.begin(), process.end(), is_digit), process.end());
    return process;
}

/// Whether the name still leads to the file that was opened: its last holder removes it.
bool is_still_there(int descriptor, const std::filesystem::path& file) {
    struct stat opened {
    }, named{};
    return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &named) == 0 &&
           opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& file,
                   const std::string& what,
                   const std::string& fix) {
    std::error_code unknown;
    lock_file_ = std::filesystem::weakly_canonical(file, unknown);
    if (unknown) lock_file_ = std::filesystem::absolute(file);
    lock_file_ += ".lock";
    while (true) {
        descriptor_ = ::open(lock_file_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
        if (descriptor_ < 0) {
            throw FileError(file,
                            "",
                            "no way to write beside it (" + std::string(std::strerror(errno)) + ")",
                            "a folder that is there and that you may write");
        }
        if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
            const std::string process = holder_of(descriptor_);
            ::close(descriptor_);
            throw Refused(what + (process.empty() ? "" : " (process " + process + ")"), fix);
        }
        if (is_still_there(descriptor_, lock_file_)) break;
        ::close(descriptor_);
    }
    // Only for the message: on a full disk the lock holds all the same.
    const std::string process = std::to_string(::getpid()) + "\n";
    if (::ftruncate(descriptor_, 0) == 0) {
        [[maybe_unused]] const ssize_t written =
            ::pwrite(descriptor_, process.data(), process.size(), 0);
    }
}

FileLock::~FileLock() {
    ::unlink(lock_file_.c_str());
    ::close(descriptor_);
}

}  // namespace livery
