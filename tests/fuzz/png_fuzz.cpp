#include <sstream>

#include "core/pictures/png_damage.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(bytes) {
    using namespace livery;
    std::istringstream stream(bytes);
    const std::string damage = png_damage(stream);
    fuzz::require(damage == printable(damage), "a message is one line of UTF-8");
}
