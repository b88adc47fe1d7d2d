#include "jobs/watched_captures.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(250);
constexpr std::size_t kLargestFile = std::size_t{1} << 30u;
/// While fewer have come it is said how many, not which are missing.
constexpr double kShareToName = 0.6;

}  // namespace

std::string text_of(const WatchedState& state) {
    std::string text = fmt::format("{} of {} photographs", state.found, state.wanted);
    if (!state.missing.empty())
        text += fmt::format("; missing: {}", fmt::join(state.missing, ", "));
    for (const auto& odd : state.odd) text += fmt::format("; {} {}", odd.file, odd.why);
    return text;
}

WatchedCaptures::WatchedCaptures(std::filesystem::path folder, std::vector<std::string> roles)
    : folder_(std::move(folder)), roles_(std::move(roles)), file_of_role_(roles_.size()) {
    make_output_folder(folder_);
    state_.wanted = roles_.size();
}

void WatchedCaptures::read(const std::filesystem::path& path, File& file) {
    file.read = true;
    file.problem.clear();
    try {
        Hasher hasher;
        hasher.add(read_text_file(path, kLargestFile));
        file.bytes_hash = hasher.hex();
        Capture capture;
        capture.file = path;
        capture.exposure_s = 1.0;
        file.glimpse = glimpse_of(load_photograph(capture));
    } catch (const FileError& error) {
        file.problem = error.field().empty()
                           ? "cannot be read: " + error.found()
                           : fmt::format("cannot be read: {}: {}", error.field(), error.found());
    }
}

bool WatchedCaptures::look() {
    bool changed = false;
    std::error_code error;
    std::map<std::string, File> there;
    for (std::filesystem::directory_iterator entry(folder_, error), end; !error && entry != end;
         entry.increment(error)) {
        const auto& path = entry->path();
        const std::string name = path.filename().string();
        if (name.starts_with(".") || !has_picture_suffix(path)) continue;
        std::error_code gone;
        File now;
        now.size = std::filesystem::file_size(path, gone);
        now.time = std::filesystem::last_write_time(path, gone);
        if (gone) continue;
        const auto before = files_.find(name);
        const bool same = before != files_.end() && before->second.size == now.size &&
                          before->second.time == now.time;
        if (same) now = std::move(before->second);
        if (same && !now.read) {
            read(path, now);
            changed = true;
        }
        there.emplace(name, std::move(now));
    }
    if (error)
        throw FileError(folder_, "", error.message(), "a folder to copy the photographs into");
    for (const auto& [name, file] : files_) changed = changed || !there.contains(name);
    files_ = std::move(there);
    if (!changed) return false;
    const WatchedState before = state_;
    identify_all();
    return !(state_ == before);
}

void WatchedCaptures::identify_all() {
    WatchedState state;
    state.wanted = roles_.size();
    std::vector<const std::pair<const std::string, File>*> sorted;
    for (const auto& entry : files_) {
        if (!entry.second.read) continue;
        if (entry.second.problem.empty()) {
            sorted.push_back(&entry);
        } else {
            state.odd.push_back({entry.first, entry.second.problem});
        }
    }
    std::sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) {
        return comes_before(a->first, b->first);
    });
    // The same file copied twice, under whatever name; the size that most have
    std::map<std::string, std::string> first_with;
    std::map<std::pair<int, int>, int> sizes;
    for (const auto* entry : sorted)
        ++sizes[{entry->second.glimpse.width, entry->second.glimpse.height}];
    const auto usual =
        std::max_element(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) {
            return a.second < b.second;
        });
    std::vector<Glimpse> photographs;
    std::vector<std::string> names;
    for (const auto* entry : sorted) {
        const File& file = entry->second;
        const auto [same, fresh] = first_with.emplace(file.bytes_hash, entry->first);
        if (!fresh) {
            state.odd.push_back({entry->first, "is the same file as " + same->second});
            continue;
        }
        if (std::pair(file.glimpse.width, file.glimpse.height) != usual->first) {
            state.odd.push_back({entry->first,
                                 fmt::format("has {}x{} pixels, the others {}x{}",
                                             file.glimpse.width,
                                             file.glimpse.height,
                                             usual->first.first,
                                             usual->first.second)});
            continue;
        }
        photographs.push_back(file.glimpse);
        names.push_back(entry->first);
    }
    state.files = photographs.size();
    const IdentifiedPhotographs identified = identify(photographs, roles_);
    for (std::size_t r = 0; r < roles_.size(); ++r) {
        const auto& place = identified.photograph_of_role[r];
        file_of_role_[r] = place ? names[*place] : "";
        state.found += place.has_value();
        if (!place) state.missing.push_back(roles_[r]);
    }
    const bool many = static_cast<double>(photographs.size()) >=
                      kShareToName * static_cast<double>(roles_.size());
    if (!many) state.missing.clear();
    for (const auto& odd : identified.odd) state.odd.push_back({names[odd.photograph], odd.why});
    state.complete = identified.complete();
    state_ = std::move(state);
}

CapturesFolder WatchedCaptures::captures(int projector_width, int projector_height) const {
    check_argument(state_.complete, "photographs are missing");
    CapturesFolder folder{folder_, projector_width, projector_height, {}};
    for (std::size_t r = 0; r < roles_.size(); ++r) {
        Capture capture;
        capture.role = roles_[r];
        capture.file = folder_ / file_of_role_[r];
        capture.exposure_s = 1.0;
        folder.captures.push_back(std::move(capture));
    }
    return folder;
}

BenchPorts WatchedCaptures::ports(const Progress& progress,
                                  std::function<void(const WatchedState&)> on_state) {
    const auto folder = std::make_shared<std::optional<BenchPorts>>();
    BenchPorts ports;
    ports.show = [](const Image8&) {};
    ports.turn_to =
        [this, progress, on_state = std::move(on_state), folder](const std::string& role) {
            while (!state_.complete) {
                if (look()) on_state(state_);
                if (state_.complete) break;
                progress.check_stop();
                std::this_thread::sleep_for(kBetweenLooks);
            }
            if (!*folder) *folder = ports_of(captures(1, 1));
            return (*folder)->turn_to(role);
        };
    ports.photograph = [folder](double) { return (*folder)->photograph(0.0); };
    return ports;
}

}  // namespace livery
