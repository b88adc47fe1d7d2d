#include <cmath>

#include "appearance/subsurface/radial_profile.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    double before = -1.0;
    for (const livery::ProfileSample& one : livery::parse_profile_csv(text, "profile.csv")) {
        livery::fuzz::require(std::isfinite(one.rd), "finite");
        livery::fuzz::require(one.r_mm > before, "radii rise");
        before = one.r_mm;
    }
}
