#include "jobs/watched_captures.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "capture/transfer.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr auto kBetweenLooks = std::chrono::milliseconds(250);
constexpr std::size_t kLargestFile = std::size_t{1} << 30u;
/// While fewer have come it is said how many, not which are missing.
constexpr double kShareToName = 0.6;
/// Of the files that were exposed otherwise; after so many it is all of them.
constexpr std::size_t kMostNamedCaptures = 12;

Capture capture_of(const std::filesystem::path& file) {
    Capture capture;
    capture.file = file;
    capture.transfer = usual_transfer(file);
    capture.exposure_s = 1.0;
    capture.raw_half = true;  // As cameras on a cable read theirs: nothing made up, and soon read.
    return capture;
}

}  // namespace

std::string text_of(const WatchedState& state) {
    std::string text = fmt::format("{} of {} photographs", state.found, state.wanted);
    if (!state.missing.empty())
        text += fmt::format("; missing: {}", fmt::join(state.missing, ", "));
    for (const auto& one : state.out_of_order)
        text += fmt::format("; {} is out of order and shows {}", one.file, one.role);
    for (const auto& odd : state.odd) text += fmt::format("; {} {}", odd.file, odd.why);
    if (state.exposed_otherwise.empty()) return text;
    text += fmt::format("; {} were exposed otherwise than the others ({}):",
                        state.exposed_otherwise.size(),
                        text_of(state.usual_exposure));
    const std::size_t named = std::min(state.exposed_otherwise.size(), kMostNamedCaptures);
    for (std::size_t k = 0; k < named; ++k)
        text += fmt::format(" {} {:+.1f} stops,",
                            state.exposed_otherwise[k].file,
                            state.exposed_otherwise[k].stops);
    if (named < state.exposed_otherwise.size())
        text += fmt::format(" and {} more,", state.exposed_otherwise.size() - named);
    text.back() = ';';
    text += " the camera's automatic was on: turn its dial to M, with automatic ISO off, and ";
    text += state.complete ? "these are not used" : "photograph these pictures again";
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
        const Photograph photograph = load_photograph(capture_of(path));
        file.settings = photograph.settings;
        file.glimpse = glimpse_of(photograph);
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

std::vector<const WatchedCaptures::NamedFile*> WatchedCaptures::comparable_files(
    WatchedState& state) const {
    std::vector<const NamedFile*> sorted;
    std::vector<std::string> names;
    for (const auto& entry : files_) names.push_back(entry.first);
    for (const std::size_t place : order_of_names(names)) {
        const NamedFile& entry = *files_.find(names[place]);
        if (!entry.second.read) continue;
        if (from_before_.contains(entry.first)) {
            state.odd.push_back({entry.first, "was there before"});
            continue;
        }
        if (entry.second.problem.empty()) {
            sorted.push_back(&entry);
        } else {
            state.odd.push_back({entry.first, entry.second.problem});
        }
    }
    // The same file copied twice, under whatever name
    std::map<std::string, std::string> first_with;
    std::erase_if(sorted, [&](const NamedFile* file) {
        const auto [same, fresh] = first_with.emplace(file->second.bytes_hash, file->first);
        if (!fresh) state.odd.push_back({file->first, "is the same file as " + same->second});
        return !fresh;
    });
    if (sorted.empty()) return sorted;
    const auto most_like = [&](const auto& alike) -> const File& {
        return sorted[usual_of(sorted.size(),
                               [&](std::size_t a, std::size_t b) {
                                   return alike(sorted[a]->second, sorted[b]->second);
                               })]
            ->second;
    };
    const Glimpse usual =
        most_like([](const File& a, const File& b) {
            return a.glimpse.width == b.glimpse.width && a.glimpse.height == b.glimpse.height;
        }).glimpse;
    std::erase_if(sorted, [&](const NamedFile* file) {
        const Glimpse& glimpse = file->second.glimpse;
        const bool other = glimpse.width != usual.width || glimpse.height != usual.height;
        if (other)
            state.odd.push_back({file->first,
                                 fmt::format("has {}x{} pixels, the others {}x{}",
                                             glimpse.width,
                                             glimpse.height,
                                             usual.width,
                                             usual.height)});
        return other;
    });
    state.usual_exposure = most_like([](const File& a, const File& b) {
                               return a.settings != ExposureSettings{} &&
                                      b.settings != ExposureSettings{} &&
                                      !are_exposed_otherwise(a.settings, b.settings);
                           }).settings;
    std::erase_if(sorted, [&](const NamedFile* file) {
        const bool other = are_exposed_otherwise(file->second.settings, state.usual_exposure);
        if (other)
            state.exposed_otherwise.push_back(
                {file->first, stops_over(file->second.settings, state.usual_exposure)});
        return other;
    });
    return sorted;
}

void WatchedCaptures::identify_all() {
    WatchedState state;
    state.wanted = roles_.size();
    const std::vector<const NamedFile*> files = comparable_files(state);
    state.files = files.size();
    std::vector<Glimpse> photographs;
    for (const NamedFile* file : files) photographs.push_back(file->second.glimpse);
    const IdentifiedPhotographs identified = identify(photographs, roles_);
    for (std::size_t r = 0; r < roles_.size(); ++r) {
        const auto& place = identified.photograph_of_role[r];
        file_of_role_[r] = place ? files[*place]->first : "";
        state.found += place.has_value();
        if (!place) state.missing.push_back(roles_[r]);
    }
    const bool many = static_cast<double>(photographs.size()) >=
                      kShareToName * static_cast<double>(roles_.size());
    if (!many) state.missing.clear();
    for (const auto& one : identified.out_of_order)
        state.out_of_order.push_back({files[one.photograph]->first, roles_[one.role]});
    for (const auto& odd : identified.odd)
        state.odd.push_back({files[odd.photograph]->first, odd.why});
    state.complete = identified.complete();
    state_ = std::move(state);
}

WatchedCaptures::FoundBefore WatchedCaptures::look_at_what_is_there(std::vector<Pattern> patterns) {
    look();
    look();  // what has not grown since the first
    FoundBefore result{std::move(patterns), {}};
    if (files_.empty()) return result;
    if (static_cast<double>(state_.found) < kShareToName * static_cast<double>(roles_.size())) {
        for (const auto& [name, file] : files_) from_before_.insert(name);
        identify_all();
        result.words =
            fmt::format("{} files were there before and are passed over", from_before_.size());
        return result;
    }
    const auto is_there = [this](const std::string& wanted) {
        const auto role = std::find(roles_.begin(), roles_.end(), wanted);
        return role == roles_.end() ||
               !file_of_role_[static_cast<std::size_t>(role - roles_.begin())].empty();
    };
    // Stripes and their inverse together: one alone may be either
    const std::string inverse = "-inverse";
    std::erase_if(result.still_to_shoot, [&](const Pattern& pattern) {
        const std::string other = pattern.role.ends_with(inverse)
                                      ? pattern.role.substr(0, pattern.role.size() - inverse.size())
                                      : pattern.role + inverse;
        return is_there(pattern.role) && is_there(other);
    });
    result.words = fmt::format(
        "{} of the {} photographs were there before and are used", state_.found, state_.wanted);
    return result;
}

CapturesFolder WatchedCaptures::captures(int projector_width, int projector_height) const {
    check_argument(state_.complete, "photographs are missing");
    CapturesFolder folder{folder_, projector_width, projector_height, {}};
    const bool all_say_so =
        std::all_of(file_of_role_.begin(), file_of_role_.end(), [&](const std::string& name) {
            return files_.at(name).settings.time_s > 0.0;
        });
    for (std::size_t r = 0; r < roles_.size(); ++r) {
        Capture capture = capture_of(folder_ / file_of_role_[r]);
        capture.role = roles_[r];
        if (all_say_so) capture.exposure_s = state_.usual_exposure.time_s;
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
