#include "core/cache.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <limits>
#include <vector>

#include "core/hash.h"
#include "core/log.h"
#include "core/paths.h"

namespace livery {
namespace {

namespace fs = std::filesystem;

fs::path cache_folder() { return user_folder() / "cache"; }

/// Its name is part of it: a file under another's name is damaged, too.
std::string digest_of(const std::string& name, std::string_view bytes) {
    Hasher hasher;
    hasher.add(name);
    hasher.add(bytes);
    return hasher.hex();
}

constexpr std::size_t kDigestSize = 32;

void sweep(const fs::path& folder, std::uintmax_t largest_bytes) {
    struct Kept {
        fs::path file;
        fs::file_time_type read_at;
        std::uintmax_t bytes;
    };
    std::vector<Kept> all;
    std::uintmax_t total = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        std::error_code error;
        const auto bytes = entry.file_size(error);
        const auto read_at = error ? fs::file_time_type() : entry.last_write_time(error);
        if (error) continue;  // Another program swept it away
        all.push_back({entry.path(), read_at, bytes});
        total += bytes;
    }
    std::sort(
        all.begin(), all.end(), [](const Kept& a, const Kept& b) { return a.read_at < b.read_at; });
    for (std::size_t k = 0; k < all.size() && total > largest_bytes; ++k) {
        std::error_code gone;
        fs::remove(all[k].file, gone);
        total -= all[k].bytes;
    }
}

}  // namespace

std::optional<std::string> read_cache(const std::string& name) {
    try {
        const fs::path file = cache_folder() / name;
        std::error_code error;
        if (!fs::exists(file, error)) return std::nullopt;
        std::string bytes = read_text_file(file, std::numeric_limits<std::size_t>::max());
        const std::size_t size = bytes.size() - std::min(bytes.size(), kDigestSize);
        const std::string_view content = std::string_view(bytes).substr(0, size);
        if (digest_of(name, content) != std::string_view(bytes).substr(size)) {
            log_line(LogLevel::warning,
                     "cache: " + file.string() + " is damaged; what it held is worked out again");
            fs::remove(file, error);
            return std::nullopt;
        }
        fs::last_write_time(file, fs::file_time_type::clock::now(), error);
        bytes.resize(size);
        return bytes;
    } catch (const std::exception& error) {
        log_line(LogLevel::warning,
                 std::string("cache: ") + error.what() + "; what it held is worked out again");
        return std::nullopt;
    }
}

void write_cache(const std::string& name, std::string_view bytes, std::uintmax_t largest_bytes) {
    if (bytes.size() + kDigestSize > largest_bytes) return;
    try {
        const fs::path folder = cache_folder();
        make_output_folder(folder);
        std::string whole(bytes);
        whole += digest_of(name, bytes);
        write_text_file(folder / name, whole);
        sweep(folder, largest_bytes);
    } catch (const std::exception& error) {
        log_line(LogLevel::info,
                 std::string("cache: ") + error.what() + "; it is worked out again next time");
    }
}

}  // namespace livery
