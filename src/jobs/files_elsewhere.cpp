#include "jobs/files_elsewhere.h"

#include <algorithm>

#include "core/error.h"
#include "core/paths.h"
#include "core/utf8.h"

namespace livery {

namespace {

using Path = std::filesystem::path;

constexpr std::size_t kMostNamed = 5;

Path resolved(const Path& path) {
    std::error_code error;
    const Path absolute = std::filesystem::absolute(path, error);
    const Path canonical = std::filesystem::weakly_canonical(absolute, error);
    return error ? absolute.lexically_normal() : canonical;
}

bool is_below(const Path& file, const Path& folder) {
    const auto part = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first;
    return !folder.empty() && part == folder.end();
}

}  // namespace

FilesElsewhere::FilesElsewhere(const Path& folder)
    : folder_(resolved(folder.empty() ? Path(".") : folder)) {
    try {
        shipped_ = resolved(shipped_path("materials")).parent_path();
    } catch (const FileError&) {
        // Without shipped data nothing lies among them.
    }
}

void FilesElsewhere::add(const Path& file) {
    if (file.empty()) return;
    const Path place = resolved(file);
    if (is_below(place, folder_) || is_below(place, shipped_)) return;
    const std::string name = printable(place.string(), 200);
    if (std::find(files_.begin(), files_.end(), name) != files_.end()) return;
    ++count_;
    if (files_.size() < kMostNamed) files_.push_back(name);
}

std::string FilesElsewhere::note() const {
    if (files_.empty()) return "";
    std::string text = "reads " + list_of(files_);
    if (count_ > files_.size()) text += " and " + std::to_string(count_ - files_.size()) + " more";
    return text + (count_ == 1 ? ", which lies elsewhere" : ", which lie elsewhere");
}

}  // namespace livery
