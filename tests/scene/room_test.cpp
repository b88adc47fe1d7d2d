#include "scene/room.h"

#include <functional>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/json.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

RoomGeometry some_room() {
    RoomGeometry room;
    room.projector = look_at({400, 300, 900}, {10, 20, 30}, 0.7, 1280, 800);
    room.camera = look_at({-300, 350, 800}, {0, 20, 0}, 0.6, 1728, 1152);
    room.camera.distortion = {-0.1, 0.02, 1e-3, -2e-3, 1.0 / 3.0};
    room.pair_median_px = 0.17;
    room.pair_inlier_share = 0.93;
    room.median_px = 0.05;
    room.rms_px = 0.11;
    room.rms_mm = 0.03;
    room.inliers = 39000;
    room.correspondences = 40000;
    room.agreement = 0.96;
    room.free_turns = 1;
    room.turns_through_mm = {1, 2, 3};
    room.warnings = {"the product is symmetric"};
    room.made_of = "0123";
    return room;
}

TEST(RoomFile, ComesBackAsItWas) {
    const TemporaryFolder folder;
    write_room_file(folder / "room.json", some_room());
    const RoomGeometry back = read_room_file(folder / "room.json");
    const auto off = [](const View& a, const View& b) {
        return glm::length(a.principal_px - b.principal_px);
    };
    EXPECT_LT(off(back.projector, some_room().projector), 1e-9);  // half a pixel there and back
    EXPECT_LT(off(back.camera, some_room().camera), 1e-9);
    RoomGeometry rounded = back;
    rounded.projector.principal_px = some_room().projector.principal_px;
    rounded.camera.principal_px = some_room().camera.principal_px;
    EXPECT_EQ(rounded, some_room());
}

TEST(RoomFile, NamesWhatIsWrong) {
    const TemporaryFolder folder;
    write_room_file(folder / "room.json", some_room());
    const Json good = read_json_file(folder / "room.json");
    const auto refused = [&](const char* field, const std::function<void(Json&)>& spoil) {
        Json json = good;
        spoil(json);
        EXPECT_TRUE(
            fails_with([&] { parse_room(json.dump(), "room.json"); }, {"room.json", field}));
    };
    refused("format_version", [](Json& json) { json["format_version"] = 2; });
    refused("kind", [](Json& json) { json["kind"] = "pose"; });
    refused("projector.width", [](Json& json) { json["projector"]["width"] = 0; });
    refused("camera.rotation", [](Json& json) { json["camera"]["rotation"][0] = 7; });
    refused("agreement", [](Json& json) { json["agreement"] = 1.5; });
    refused("inliers", [](Json& json) { json["inliers"] = -1; });
    refused("made_of", [](Json& json) { json.erase("made_of"); });
    EXPECT_THROW(parse_room("{", "room.json"), FileError);
}

}  // namespace
}  // namespace livery
