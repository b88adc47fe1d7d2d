#include "fuzz/fuzz.h"
#include "jobs/calibrate/calibration_folder.h"

LIVERY_FUZZ(text) {
    const livery::CalibrationOrigin origin = livery::parse_origin(text, "origin.json");
    livery::fuzz::require(origin.capture_seconds >= 0.0 && origin.solve_seconds >= 0.0, "times");
    if (!origin.ends) return;
    livery::fuzz::require(origin.ends->exposure_s > 0.0, "an exposure");
    livery::fuzz::require(origin.ends->late >= 0, "a count");
}
