// What cameras call their settings' values.
#pragma once

#include <string>

#include "capture/camera.h"

namespace livery {

/// Seconds of a shutter speed as cameras write it: "1/60", "0.1000s", "0.4", "2\"". Negative:
/// "bulb", "auto" and what else is no time.
double seconds_of_shutter_speed(const std::string& text);

/// Of the dial.
bool is_manual(const std::string& program);
/// Of its files: RAW, alone or beside a JPEG.
bool is_raw_format(const std::string& format);
/// How long the shutter is open where the camera says this; negative: no time. The series 1/30,
/// 1/60, 1/125 is of exact halves (1/32, 1/64, 1/128), with thirds or halves of a stop between,
/// said in round numbers that are up to 7% off (ISO 516).
double open_time_s(const CameraSetting& exposure, const std::string& said);
/// The offered time nearest to this, in ratio; empty: it offers none.
std::string nearest_time(const CameraSetting& exposure, double seconds);

}  // namespace livery
