#include <cmath>

#include <glm/matrix.hpp>

#include "fuzz/fuzz.h"
#include "scene/room.h"

LIVERY_FUZZ(text) {
    const livery::RoomGeometry room = livery::parse_room(text, "room.json");
    for (const livery::View* view : {&room.projector, &room.camera}) {
        livery::fuzz::require(view->width > 0 && view->height > 0, "pixels");
        livery::fuzz::require(
            std::abs(glm::determinant(view->view_from_world.rotation) - 1.0) < 1e-3, "a rotation");
    }
    livery::fuzz::require(room.agreement >= 0.0 && room.agreement <= 1.0, "a share");
    livery::fuzz::require(room.free_turns >= 0 && room.free_turns <= 3, "turns");
}
