#include "core/paths.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"
#include "core/replace_folder.h"

namespace livery {

namespace {

// Set once by the command line before any work starts.
std::filesystem::path chosen_data_folder;

}  // namespace

void set_data_folder(const std::filesystem::path& folder) { chosen_data_folder = folder; }

std::filesystem::path executable_folder() {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::current_path() : program.parent_path();
}

std::filesystem::path shipped_path(const std::filesystem::path& relative) {
    const char* from_environment = std::getenv("LIVERY_DATA");
    std::filesystem::path root = executable_folder() / "../share/livery";
    if (from_environment && *from_environment) root = from_environment;
    if (!chosen_data_folder.empty()) root = chosen_data_folder;
    const auto file = (root / relative).lexically_normal();
    std::error_code error;
    if (std::filesystem::exists(file, error)) return file;
    throw FileError(relative,
                    "",
                    "nothing in " + root.lexically_normal().string(),
                    "a file shipped with Livery (see --data)");
}

std::vector<std::string> shipped_names(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(shipped_path(folder))) {
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string list_of(const std::vector<std::string>& names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

std::filesystem::path user_folder() {
    const auto value = [](const char* name) -> std::filesystem::path {
        const char* text = std::getenv(name);
        return text ? text : "";
    };
    if (const auto home = value("LIVERY_HOME"); !home.empty()) return home;
    if (const auto data = value("XDG_DATA_HOME"); !data.empty()) return data / "livery";
    const auto home = value("HOME");
    if (home.empty())
        throw FileError("HOME", "", "no home folder", "LIVERY_HOME or HOME to be set");
    return home / ".local/share/livery";
}

std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) throw FileError(file, "", "no such file", "a file");
    if (std::filesystem::is_directory(status)) throw FileError(file, "", "a folder", "a file");
    const auto refuse_size = [&] {
        throw FileError(file,
                        "",
                        "more than " + std::to_string(max_bytes) + " bytes",
                        "a smaller file of this kind");
    };
    if (!std::filesystem::is_regular_file(status)) {
        // What a shell hands over; any other pipe or device may never end, or never begin.
        const std::string name = file.lexically_normal().string();
        if (name != "/dev/stdin" && !name.starts_with("/dev/fd/")) {
            throw FileError(file, "", "a pipe or a device", "a file");
        }
    } else if (const auto bytes = std::filesystem::file_size(file, error);
               !error && bytes > max_bytes) {
        refuse_size();
    }
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw FileError(file, "", std::strerror(errno), "a readable file");
    std::string text;
    std::vector<char> block(1u << 16u);
    while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) ||
           stream.gcount() > 0) {
        text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
        if (text.size() > max_bytes) refuse_size();
    }
    if (stream.bad()) throw FileError(file, "", "a read error", "a readable file");
    return text;
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
    const auto fail = [&](const char* what) {
        throw FileError(
            file, "", std::string(what) + ": " + std::strerror(errno), "a writable place");
    };
    // A device or a pipe is written to; a file in its place would be something else.
    std::error_code unknown;
    const auto status = std::filesystem::status(file, unknown);
    if (std::filesystem::is_character_file(status) || std::filesystem::is_fifo(status)) {
        std::ofstream stream(file, std::ios::binary);
        stream.write(text.data(), static_cast<std::streamsize>(text.size())).flush();
        if (!stream) fail("cannot write");
        return;
    }
    // What lies at the name already, a link to elsewhere even, is not written to.
    std::filesystem::path temporary;
    int descriptor = -1;
    for (int attempt = 0; attempt < 16; ++attempt) {
        temporary = file;
        temporary += fmt::format(".tmp{}-{}", ::getpid(), attempt);
        descriptor =
            ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (descriptor >= 0 || errno != EEXIST) break;
    }
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(
        descriptor < 0 ? nullptr : ::fdopen(descriptor, "wb"), &std::fclose);
    if (!stream) fail("cannot create");
    const bool written = std::fwrite(text.data(), 1, text.size(), stream.get()) == text.size() &&
                         std::fflush(stream.get()) == 0 && ::fsync(::fileno(stream.get())) == 0;
    const int closed = std::fclose(stream.release());
    std::error_code error;
    if (!written || closed != 0) {
        const int reason = errno;
        std::filesystem::remove(temporary, error);
        errno = reason;
        fail("cannot write");
    }
    std::filesystem::rename(temporary, file, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw FileError(file, "", "cannot replace: " + error.message(), "a writable place");
    }
    sync_folder(file.parent_path());
}

void make_output_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder)) {
        throw FileError(
            folder, "", error ? error.message() : "a file", "a folder that can be made");
    }
}

void make_private_folder(const std::filesystem::path& folder) {
    std::error_code error;
    const bool there = std::filesystem::exists(folder, error);
    make_output_folder(folder);
    if (!there) std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
}

void make_private_file(const std::filesystem::path& file) {
    const int made =
        ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (made >= 0) {
        ::close(made);
        return;
    }
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return;
    std::filesystem::permissions(
        file,
        std::filesystem::perms::group_all | std::filesystem::perms::others_all,
        std::filesystem::perm_options::remove,
        error);
}

}  // namespace livery
