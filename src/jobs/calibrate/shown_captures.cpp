#include "jobs/calibrate/shown_captures.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "calibration/captures/identify.h"

namespace livery {

namespace {

constexpr std::size_t kMostNamedPhotographs = 4;

Glimpse glimpse_at(const Capture& capture) { return glimpse_of(load_photograph(capture)); }

/// White and black, and the first and the last pair of stripes: enough to see that a row of files
/// is shifted or turned round.
std::vector<std::size_t> telling_places(const std::vector<Capture>& captures) {
    std::vector<std::size_t> places;
    const auto add = [&](std::size_t place) {
        if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
    };
    std::size_t last_inverse = 0;
    for (std::size_t k = 0; k < captures.size(); ++k) {
        const std::string& role = captures[k].role;
        if (role == "white" || role == "black") add(k);
        if (!role.ends_with("-inverse") || k == 0) continue;
        if (last_inverse == 0) {
            add(k - 1);
            add(k);
        }
        last_inverse = k;
    }
    if (last_inverse > 0) {
        add(last_inverse - 1);
        add(last_inverse);
    }
    std::sort(places.begin(), places.end());
    return places;
}

struct Looked {
    IdentifiedPhotographs found;
    bool alike = true;  ///< in size
};
Looked look_at(const std::vector<Capture>& captures,
               const std::vector<std::size_t>& photographs,
               const std::vector<std::string>& roles,
               const Progress& progress) {
    std::vector<Glimpse> glimpses;
    for (const std::size_t place : photographs) {
        progress.check_stop();
        progress.update(0.0, "looking at " + captures[place].file.filename().string());
        glimpses.push_back(glimpse_at(captures[place]));
        if (glimpses.back().values.size() != glimpses.front().values.size()) return {{}, false};
    }
    return {identify(glimpses, roles), true};
}

/// The photograph of one capture for the picture of another.
Capture with_role_of(Capture photograph, const Capture& picture) {
    photograph.role = picture.role;
    photograph.pattern = picture.pattern;
    photograph.drive = picture.drive;
    return photograph;
}

}  // namespace

CapturesFolder read_shown_captures(const std::filesystem::path& path,
                                   PhotographUse use,
                                   const std::filesystem::path& patterns_manifest,
                                   std::vector<std::string>& warnings,
                                   const Progress& progress) {
    CapturesFolder folder = read_captures_folder(path, use, patterns_manifest);
    std::error_code error;
    if (std::filesystem::exists(path / "manifest.json", error)) return folder;
    const std::vector<Capture>& captures = folder.captures;
    const auto roles_at = [&](const std::vector<std::size_t>& places) {
        std::vector<std::string> roles;
        for (const std::size_t place : places) roles.push_back(captures[place].role);
        return roles;
    };
    const std::vector<std::size_t> some = telling_places(captures);
    const Looked first = look_at(captures, some, roles_at(some), progress);
    const bool holds =
        first.found.complete() && first.found.odd.empty() && first.found.out_of_order.empty();
    if (holds || !first.alike) return folder;

    std::vector<std::string> names;
    for (const Capture& capture : captures) names.push_back(capture.file.filename().string());
    const std::vector<std::size_t> order = order_of_names(names);
    std::vector<std::size_t> all(captures.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const Looked looked = look_at(captures, order, roles_at(all), progress);
    if (!looked.alike) return folder;
    if (!looked.found.complete()) {
        for (std::size_t k = 0; k < std::min(looked.found.odd.size(), kMostNamedPhotographs); ++k)
            warnings.push_back(fmt::format(
                "{} {}", names[order[looked.found.odd[k].photograph]], looked.found.odd[k].why));
        return folder;
    }
    CapturesFolder shown = folder;
    shown.captures.clear();
    std::vector<std::size_t> role_of(captures.size(), captures.size());
    for (std::size_t role = 0; role < captures.size(); ++role)
        role_of[*looked.found.photograph_of_role[role]] = role;
    std::string moved;
    std::size_t count = 0;
    for (std::size_t taken = 0; taken < order.size(); ++taken) {
        const std::size_t role = role_of[taken];
        shown.captures.push_back(with_role_of(captures[order[taken]], captures[role]));
        if (role == order[taken]) continue;
        if (++count <= kMostNamedPhotographs)
            moved += fmt::format(
                "{}{} shows {}", count == 1 ? "" : ", ", names[order[taken]], captures[role].role);
    }
    if (count > 0)
        warnings.push_back(
            fmt::format("{} photographs are in another order than the pictures and were "
                        "recognised by what they show: {}{}",
                        count,
                        moved,
                        count > kMostNamedPhotographs ? ", …" : ""));
    return shown;
}

}  // namespace livery
