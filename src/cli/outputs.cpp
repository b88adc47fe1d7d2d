#include "cli/outputs.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

#include "core/error.h"

namespace livery {

namespace {

using Path = std::filesystem::path;

[[noreturn]] void refuse(const Path& out, std::string found, std::string expected) {
    throw FileError(out, "--out", std::move(found), std::move(expected));
}

/// By making a file there: rights alone do not tell of a disk that is read-only or full.
void check_folder(const Path& out, const Path& folder) {
    const Path trial = folder / (".livery-" + std::to_string(::getpid()) + ".tmp");
    const int descriptor = ::open(trial.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
    const int reason = errno;
    if (descriptor >= 0) {
        ::close(descriptor);
        ::unlink(trial.c_str());
        return;
    }
    refuse(out,
           "the folder " + folder.string() + ", which cannot be written (" + std::strerror(reason) +
               ")",
           "a writable place");
}

void check_output_file(const Path& out) {
    std::error_code error;
    const auto status = std::filesystem::status(out, error);
    if (std::filesystem::is_directory(status)) refuse(out, "a folder", "a file's name");
    // A device or a pipe is written to as it is.
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return;
    const Path folder = out.has_parent_path() ? out.parent_path() : Path(".");
    if (!std::filesystem::is_directory(folder, error)) {
        refuse(out, "no folder " + folder.string(), "a folder that is there");
    }
    check_folder(out, folder);
}

/// The folder is made later: here it is enough that its nearest folder that is there can be
/// written.
void check_output_folder(const Path& out) {
    std::error_code error;
    Path there = std::filesystem::absolute(out, error).lexically_normal();
    while (!std::filesystem::exists(std::filesystem::symlink_status(there, error)) &&
           there.has_relative_path()) {
        there = there.parent_path();
    }
    if (!std::filesystem::is_directory(there, error)) {
        refuse(out, there.string() + ", which is no folder", "a folder that can be made");
    }
    check_folder(out, there);
}

}  // namespace

void check_outputs(const Command& command) {
    for (const Option& option : command.options) {
        const auto* target = std::get_if<std::string*>(&option.target);
        if (option.flag != "--out" || !target || (*target)->empty()) continue;
        const Path out = **target;
        std::error_code error;
        const bool either = option.value == "FILE|DIR";
        const bool folder =
            option.value == "DIR" ||
            (either && (!out.has_extension() || std::filesystem::is_directory(out, error)));
        folder ? check_output_folder(out) : check_output_file(out);
    }
}

}  // namespace livery
