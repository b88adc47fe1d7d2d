#include "capture/camera.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <utility>

namespace livery {

namespace {

constexpr auto kBetweenTries = std::chrono::milliseconds(500);
constexpr auto kBetweenLooks = std::chrono::milliseconds(20);

bool may_come_back(CameraTrouble trouble) {
    switch (trouble) {
        case CameraTrouble::gone:
        case CameraTrouble::silent:
        case CameraTrouble::held:
        case CameraTrouble::card_full:
            return true;
        case CameraTrouble::refused:
        case CameraTrouble::unusable:
            return false;
    }
    return false;
}

}  // namespace

TakePhotograph patient(Camera& camera, const Progress& progress, TellWait on_wait) {
    return [&camera, progress, on_wait = std::move(on_wait)](double exposure_s) {
        for (bool waited = false;; waited = true) {
            try {
                Photograph photograph = camera.photograph(exposure_s);
                if (waited) on_wait({});
                return photograph;
            } catch (const CameraFault& fault) {
                if (!may_come_back(fault.trouble())) throw;
                on_wait({fault.why(), fault.fix()});
            }
            for (auto left = kBetweenTries; left.count() > 0; left -= kBetweenLooks) {
                progress.check_stop();
                std::this_thread::sleep_for(kBetweenLooks);
            }
        }
    };
}

double seconds_of_shutter_speed(const std::string& text) {
    char* end = nullptr;
    const double first = std::strtod(text.c_str(), &end);
    if (end == text.c_str()) return -1.0;
    if (*end == '/') {
        const char* const below = end + 1;
        const double second = std::strtod(below, &end);
        return end != below && second > 0.0 && first > 0.0 ? first / second : -1.0;
    }
    const bool is_time = *end == '\0' || *end == 's' || *end == '"' || *end == ' ';
    return is_time && first > 0.0 ? first : -1.0;
}

bool is_manual(const std::string& program) {
    return program.empty() || program == "M" || program.find("anual") != std::string::npos;
}

bool is_raw_format(const std::string& format) {
    std::string upper;
    for (const char c : format)
        upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return upper.find("RAW") != std::string::npos || upper.find("NEF") != std::string::npos ||
           upper.find("DNG") != std::string::npos;
}

double open_time_s(const CameraSetting& exposure, const std::string& said) {
    const double said_s = seconds_of_shutter_speed(said);
    const auto offers = [&](double wanted_s) {
        constexpr double kRounding = 0.015;
        return std::any_of(
            exposure.choices.begin(), exposure.choices.end(), [&](const std::string& choice) {
                return std::abs(seconds_of_shutter_speed(choice) / wanted_s - 1.0) < kRounding;
            });
    };
    const bool rounded = offers(1.0 / 30.0) && offers(1.0 / 60.0) && offers(1.0 / 125.0);
    if (!(said_s > 0.0) || !rounded) return said_s;
    const double steps = offers(1.0 / 45.0) || offers(1.0 / 90.0) ? 2.0 : 3.0;
    return std::exp2(std::round(steps * std::log2(said_s)) / steps);
}

std::string nearest_time(const CameraSetting& exposure, double seconds) {
    std::string best;
    double least = 1e300;
    for (const std::string& choice : exposure.choices) {
        const double time = open_time_s(exposure, choice);
        if (!(time > 0.0)) continue;
        const double distance = std::abs(std::log(time / seconds));
        if (distance < least) {
            least = distance;
            best = choice;
        }
    }
    return best;
}

}  // namespace livery
