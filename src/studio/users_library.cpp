#include "studio/users_library.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "appearance/measured/measured_paint.h"
#include "appearance/paint_bsdf.h"
#include "appearance/paint_colour.h"
#include "core/colour.h"
#include "core/spectrum.h"

namespace livery {

namespace {

/// Of the user's own paints.
std::set<std::filesystem::path> unread_files(const PaintLibrary& library) {
    std::set<std::filesystem::path> files;
    for (const Material& paint : library.unread) files.insert(paint.measured->file);
    return files;
}

void add(LibraryReading& reading, LibraryReading more) {
    reading.asked = reading.asked || more.asked;
    reading.files.merge(more.files);
    std::move(more.then.begin(), more.then.end(), std::back_inserter(reading.then));
}

void start_reading(Studio& studio);

/// The user's own measured paints follow, one snapshot after the one in which they were found.
void finish_reading(Studio& studio) {
    LibraryReadings& state = studio.panels.of<LibraryReadings>();
    const LibraryReading done = std::exchange(state.now, {});
    for (const auto& then : done.then) then();
    if (state.problem.empty()) {
        auto files = unread_files(current_library(studio));
        if (!files.empty()) add(state.next, {true, std::move(files), {}});
    }
    if (state.next.asked && !state.now.asked) start_reading(studio);
}

void start_reading(Studio& studio) {
    LibraryReadings& state = studio.panels.of<LibraryReadings>();
    state.now = std::exchange(state.next, {});
    const auto before = studio.session.document().library;
    studio.background->run(
        [&studio, before, files = state.now.files](const Progress&) -> Background::Then {
            return [&studio, before, library = read_paint_library(before, files)] {
                LibraryReadings& there = studio.panels.of<LibraryReadings>();
                there.problem.clear();
                if (studio.session.document().library == before) {
                    studio.session.use(library);
                } else {
                    // A paint was saved meanwhile: once more, from there.
                    add(there.next, std::exchange(there.now, {}));
                }
                finish_reading(studio);
            };
        },
        [&studio](const std::exception_ptr& why) {
            studio.panels.of<LibraryReadings>().problem = in_words(why);
            finish_reading(studio);
        });
}

}  // namespace

const PaintLibrary& current_library(const Studio& studio) {
    return library_of(studio.session.document());
}

void refresh_library(Studio& studio,
                     const std::set<std::filesystem::path>& wanted,
                     std::function<void()> then) {
    LibraryReadings& state = studio.panels.of<LibraryReadings>();
    const auto& files = state.now.files;
    const bool is_under_way =
        !wanted.empty() && std::includes(files.begin(), files.end(), wanted.begin(), wanted.end());
    // After a failure the next look is at the next change of focus, not in every frame.
    const bool is_vain = !wanted.empty() && !state.problem.empty();
    if ((is_under_way || is_vain) && !then) return;
    LibraryReading asked{true, wanted, {}};
    if (then) asked.then.push_back(std::move(then));
    add(state.next, std::move(asked));
    if (!state.now.asked) start_reading(studio);
}

std::optional<glm::dvec3> colour_in(const std::string& query) {
    try {
        return parse_colour(query);
    } catch (const std::invalid_argument&) {
        return std::nullopt;
    }
}

bool is_marked_colour(const std::string& query) {
    const auto begins = [&](std::string_view with) {
        return std::equal(
            with.begin(),
            with.end(),
            query.begin(),
            query.begin() + static_cast<std::ptrdiff_t>(std::min(with.size(), query.size())),
            [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
    };
    return (begins("#") || begins("lab:") || begins("xyz:") || begins("rgb(")) &&
           colour_in(query).has_value();
}

glm::dvec3 drawn_face_lab(const Material& paint) {
    const double side = std::sqrt(0.5);
    const glm::dvec3 value = reflectance_of(paint)({side, 0.0, side}, {0.0, 0.0, 1.0});
    return lab10_from_xyz10(xyz10_from_xyz(xyz_from_working() * (std::numbers::pi * value)));
}

std::vector<NearPaint> find_near_paints(const std::vector<Material>& paints,
                                        const glm::dvec3& lab10,
                                        const std::string& family) {
    std::vector<std::size_t> of_family;
    std::vector<glm::dvec3> faces;
    for (std::size_t k = 0; k < paints.size(); ++k) {
        if (!family.empty() && paints[k].family != family) continue;
        of_family.push_back(k);
        faces.push_back(drawn_face_lab(paints[k]));
    }
    std::vector<NearPaint> found = nearest_colours(faces, lab10);
    if (found.size() > kNearestShown) found.resize(kNearestShown);
    for (NearPaint& near : found) near.index = of_family[near.index];
    return found;
}

std::vector<std::size_t> find_paints(const std::vector<Material>& paints,
                                     const std::string& query,
                                     const std::string& family) {
    const bool marked = is_marked_colour(query);
    std::vector<std::size_t> found;
    if (!marked) found = search_paints(paints, query, family);
    const auto wanted = colour_in(query);
    if (!wanted || !found.empty()) return found;
    for (const NearPaint& near : find_near_paints(paints, *wanted, family)) {
        found.push_back(near.index);
    }
    return found;
}

}  // namespace livery
