#include "core/replace_folder.h"

#include <cstdio>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

using Path = std::filesystem::path;

/// A calibration's folder has no more; a folder of other things is not moved about.
constexpr std::size_t kMostEntries = 32;

/// A second name for a file, or a copy where the file system has no such names.
bool take_along(const Path& from, const Path& to) {
    std::error_code error;
    if (std::filesystem::is_symlink(from, error)) {
        std::filesystem::copy_symlink(from, to, error);
        return !error;
    }
    std::filesystem::create_hard_link(from, to, error);
    if (error) {
        error.clear();
        std::filesystem::copy_file(from, to, error);
    }
    return !error;
}

bool is_below(const Path& path, const Path& folder) { return path.parent_path() == folder; }

std::vector<Path> entries_of(const Path& folder) {
    std::vector<Path> entries;
    std::error_code error;
    for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end;
         at.increment(error)) {
        entries.push_back(at->path());
    }
    return entries;
}

}  // namespace

void sync_folder(const Path& folder) {
    const int descriptor =
        ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

FolderReplacement::FolderReplacement(const Path& folder) {
    std::error_code error;
    const Path absolute = std::filesystem::absolute(folder, error);
    folder_ = std::filesystem::weakly_canonical(absolute, error);
    if (error) folder_ = absolute.lexically_normal();
    if (!folder_.has_filename()) folder_ = folder_.parent_path();
    if (std::filesystem::exists(folder_, error) && !std::filesystem::is_directory(folder_, error)) {
        throw FileError(folder, "", "a file", "a folder that can be made");
    }
    staging_ = folder_.parent_path() /
               ("." + folder_.filename().string() + ".new" + std::to_string(::getpid()));
    std::filesystem::remove_all(staging_, error);
    std::filesystem::create_directories(staging_, error);
    if (!error) return;
    // Where only the folder itself can be written.
    staging_ = folder_ / (".new" + std::to_string(::getpid()));
    make_output_folder(staging_);
}

FolderReplacement::~FolderReplacement() {
    std::error_code ignored;
    std::filesystem::remove_all(staging_, ignored);
}

void FolderReplacement::commit(const std::string& last) {
    sync_folder(staging_);
    std::error_code error;
    if (!std::filesystem::exists(folder_, error)) {
        std::filesystem::rename(staging_, folder_, error);
        if (error) throw FileError(folder_, "", error.message(), "a folder that can be made");
    } else if (!exchange()) {
        move_files(last);
    }
    sync_folder(folder_.parent_path());
}

bool FolderReplacement::exchange() {
    std::error_code error;
    // Whoever stands in the folder would be left in the one that goes.
    if (std::filesystem::equivalent(folder_, std::filesystem::current_path(error), error)) {
        return false;
    }
    const std::vector<Path> entries = entries_of(folder_);
    if (entries.size() > kMostEntries || is_below(staging_, folder_)) return false;
    for (const Path& entry : entries) {
        const Path to = staging_ / entry.filename();
        if (std::filesystem::exists(std::filesystem::symlink_status(to, error))) continue;
        const auto status = std::filesystem::symlink_status(entry, error);
        if (std::filesystem::is_directory(status) || !take_along(entry, to)) return false;
    }
    sync_folder(staging_);
    // The old content is then where the new one was written, and goes with the object.
    return ::renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, folder_.c_str(), RENAME_EXCHANGE) == 0;
}

void FolderReplacement::move_files(const std::string& last) {
    const auto move = [&](const Path& name) {
        std::error_code error;
        std::filesystem::rename(staging_ / name, folder_ / name, error);
        if (error) {
            throw FileError(
                folder_ / name, "", "cannot replace: " + error.message(), "a writable place");
        }
    };
    for (const Path& entry : entries_of(staging_)) {
        if (entry.filename() != last) move(entry.filename());
    }
    move(last);
    sync_folder(folder_);
}

}  // namespace livery
