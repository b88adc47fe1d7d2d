#include "capture/recording_list_io.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/json.h"

namespace livery {

namespace {

constexpr int kNewestListVersion = 1;
/// Numbers of files above it are none of ours, and what is added to them would overflow.
constexpr int kHighestNumber = 1'000'000'000;

Json json_of(const RecordedPhotograph& photograph) {
    Json json = {{"file", photograph.file},
                 {"of", photograph.of},
                 {"asked_s", photograph.asked_s},
                 {"exposure_s", photograph.exposure_s},
                 {"black_level", photograph.black_level}};
    if (std::isfinite(photograph.saturates_at)) json["saturates_at"] = photograph.saturates_at;
    return json;
}

RecordedPhotograph photograph_from(const JsonReader& json) {
    json.allow_only({"file", "of", "asked_s", "exposure_s", "black_level", "saturates_at"});
    RecordedPhotograph photograph;
    photograph.file = json["file"].text();
    const std::filesystem::path name(photograph.file);
    if (name.filename() != name || photograph.file.empty()) {
        json["file"].fail("\"" + photograph.file + "\"", "the name of a file in the same folder");
    }
    photograph.of = json["of"].text();
    photograph.asked_s = json["asked_s"].number_between(0.0, 1e6);
    photograph.exposure_s = json["exposure_s"].number_between(1e-9, 1e6);
    photograph.black_level = json["black_level"].number_between(0.0, 1e9);
    photograph.saturates_at = json.has("saturates_at")
                                  ? json["saturates_at"].number_between(0.0, 1e9)
                                  : std::numeric_limits<double>::infinity();
    return photograph;
}

RecordedShowing showing_from(const JsonReader& json) {
    json.allow_only({"picture", "photographs", "measured"});
    RecordedShowing showing;
    showing.picture = json["picture"].text();
    const JsonReader photographs = json["photographs"];
    for (std::size_t k = 0; k < photographs.size(); ++k) {
        showing.photographs.push_back(photograph_from(photographs.at(k)));
    }
    if (!json.has("measured")) return showing;
    const JsonReader measured = json["measured"];
    for (std::size_t k = 0; k < measured.size(); ++k) {
        const auto values = measured.at(k).numbers(5);
        showing.measured.push_back({{values[0], values[1]}, {values[2], values[3], values[4]}});
    }
    return showing;
}

}  // namespace

RecordingList parse_recording_list(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.require_format_version(kNewestListVersion);
    root.allow_only({"format_version", "bench", "showings"});
    RecordingList list;
    list.bench = root["bench"].text();
    const JsonReader showings = root["showings"];
    for (std::size_t k = 0; k < showings.size(); ++k) {
        list.showings.push_back(showing_from(showings.at(k)));
    }
    return list;
}

std::string text_of(const RecordingList& list) {
    Json json = {{"format_version", kNewestListVersion}, {"bench", list.bench}};
    json["showings"] = Json::array();
    for (const RecordedShowing& showing : list.showings) {
        if (showing.photographs.empty() && showing.measured.empty()) continue;
        Json entry = {{"picture", showing.picture}, {"photographs", Json::array()}};
        for (const auto& photograph : showing.photographs)
            entry["photographs"].push_back(json_of(photograph));
        for (const auto& [place, xyz] : showing.measured)
            entry["measured"].push_back({place.x, place.y, xyz.x, xyz.y, xyz.z});
        json["showings"].push_back(std::move(entry));
    }
    return json.dump(1) + "\n";
}

int next_file_number(const std::vector<RecordedShowing>& showings) {
    int next = 0;
    for (const RecordedShowing& showing : showings) {
        for (const RecordedPhotograph& photograph : showing.photographs) {
            const std::string& name = photograph.file;
            int number = 0;
            const auto read = std::from_chars(name.data(), name.data() + name.size(), number);
            if (read.ec != std::errc() || number > kHighestNumber) continue;
            next = std::max(next, number + 1);
        }
    }
    return next;
}

}  // namespace livery
