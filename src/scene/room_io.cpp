#include <limits>

#include "core/json.h"
#include "core/paths.h"
#include "scene/pose_io.h"
#include "scene/room.h"

namespace livery {

namespace {

constexpr int kRoomVersion = 1;
constexpr double kFarthest_px = 1e6;

std::size_t read_count(const JsonReader& field) {
    return static_cast<std::size_t>(field.integer(0, std::numeric_limits<int>::max()));
}

}  // namespace

RoomGeometry read_room_file(const std::filesystem::path& file) {
    return parse_room(read_text_file(file), file);
}

RoomGeometry parse_room(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.require_format_version(kRoomVersion);
    root.allow_only({"format_version",
                     "kind",
                     "projector",
                     "camera",
                     "pair_median_px",
                     "pair_inlier_share",
                     "median_px",
                     "rms_px",
                     "rms_mm",
                     "inliers",
                     "correspondences",
                     "agreement",
                     "free_turns",
                     "turns_through_mm",
                     "warnings",
                     "made_of"});
    root["kind"].one_of({"room"});
    RoomGeometry room;
    room.projector = read_camera_fields(root["projector"]);
    room.camera = read_camera_fields(root["camera"]);
    room.pair_median_px = root["pair_median_px"].number_between(0.0, kFarthest_px);
    room.pair_inlier_share = root["pair_inlier_share"].number_between(0.0, 1.0);
    room.median_px = root["median_px"].number_between(0.0, kFarthest_px);
    room.rms_px = root["rms_px"].number_between(0.0, kFarthest_px);
    room.rms_mm = root["rms_mm"].number_between(0.0, kFarthest_mm);
    room.inliers = read_count(root["inliers"]);
    room.correspondences = read_count(root["correspondences"]);
    room.agreement = root["agreement"].number_between(0.0, 1.0);
    room.free_turns = root["free_turns"].integer(0, 3);
    room.turns_through_mm = place_mm(root["turns_through_mm"]);
    const JsonReader warnings = root["warnings"];
    for (std::size_t k = 0; k < warnings.size(); ++k)
        room.warnings.push_back(warnings.at(k).text());
    room.made_of = root["made_of"].text();
    return room;
}

void write_room_file(const std::filesystem::path& file, const RoomGeometry& room) {
    write_json_file(file,
                    {{"format_version", kRoomVersion},
                     {"kind", "room"},
                     {"projector", json_of(room.projector)},
                     {"camera", json_of(room.camera)},
                     {"pair_median_px", room.pair_median_px},
                     {"pair_inlier_share", room.pair_inlier_share},
                     {"median_px", room.median_px},
                     {"rms_px", room.rms_px},
                     {"rms_mm", room.rms_mm},
                     {"inliers", room.inliers},
                     {"correspondences", room.correspondences},
                     {"agreement", room.agreement},
                     {"free_turns", room.free_turns},
                     {"turns_through_mm", json_from(room.turns_through_mm)},
                     {"warnings", room.warnings},
                     {"made_of", room.made_of}});
}

}  // namespace livery
