#include "capture/exposures.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "core/pictures/exposure_settings.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr std::size_t kMostNamedPhotographs = 12;

/// Of each file. One that cannot be read says nothing here: whoever loads it says what is wrong.
std::vector<ExposureSettings> settings_of(const std::vector<Capture*>& captures) {
    std::vector<ExposureSettings> settings(captures.size());
    for (std::size_t k = 0; k < captures.size(); ++k) {
        try {
            settings[k] = read_exposure_settings(captures[k]->file);
        } catch (const FileError&) {
            continue;
        }
    }
    return settings;
}

ExposureSettings without_time(ExposureSettings settings) {
    settings.time_s = 0.0;
    return settings;
}

void check_gain(const std::vector<Capture*>& captures,
                const std::vector<ExposureSettings>& settings) {
    const auto differ = [&](std::size_t a, std::size_t b) {
        return are_exposed_otherwise(without_time(settings[a]), without_time(settings[b]));
    };
    const auto says = [&](std::size_t k) {
        return without_time(settings[k]) != ExposureSettings{};
    };
    const std::size_t usual = usual_of(captures.size(), [&](std::size_t a, std::size_t b) {
        return says(a) && says(b) && !differ(a, b);
    });
    std::string named;
    std::size_t odd = 0;
    for (std::size_t k = 0; k < captures.size(); ++k) {
        if (!differ(k, usual)) continue;
        if (++odd > kMostNamedPhotographs) continue;
        named += fmt::format("{}{} ({})",
                             named.empty() ? "" : ", ",
                             captures[k]->file.filename().string(),
                             text_of(without_time(settings[k])));
    }
    if (odd == 0) return;
    if (odd > kMostNamedPhotographs)
        named += fmt::format(" and {} more", odd - kMostNamedPhotographs);
    throw Refused(fmt::format("photographs at another ISO or aperture than the others ({}), by "
                              "their EXIF: {}",
                              text_of(without_time(settings[usual])),
                              named),
                  "the camera's automatic was on: turn its dial to M, with automatic ISO off, and "
                  "photograph these pictures again");
}

}  // namespace

void complete_exposures(const std::vector<Capture*>& captures,
                        const std::filesystem::path& manifest,
                        PhotographUse use) {
    const std::vector<ExposureSettings> settings = settings_of(captures);
    check_gain(captures, settings);
    std::vector<Capture*> unknown;
    double known_s = 0.0;
    bool differ = false;
    for (std::size_t k = 0; k < captures.size(); ++k) {
        double& exposure_s = captures[k]->exposure_s;
        if (!(exposure_s > 0.0)) exposure_s = settings[k].time_s;
        if (!(exposure_s > 0.0)) {
            unknown.push_back(captures[k]);
        } else if (known_s == 0.0) {
            known_s = exposure_s;
        } else {
            differ = differ || are_exposed_otherwise({exposure_s, 0, 0}, {known_s, 0, 0});
        }
    }
    if (unknown.empty()) return;
    const Capture& first = *unknown.front();
    const bool has_manifest = !first.exposure_field.empty();
    const bool nobody_says = unknown.size() == captures.size();
    if (use == PhotographUse::light ? has_manifest || !nobody_says : differ) {
        const std::string name = first.file.filename().string();
        read_exposure_settings(first.file);  // throws where it cannot be read at all
        throw FileError(
            manifest,
            has_manifest ? first.exposure_field : name,
            fmt::format(
                "nothing, and no exposure time in the EXIF of {}{}",
                name,
                unknown.size() == 1 ? "" : fmt::format(" (nor of {} others)", unknown.size() - 1)),
            has_manifest
                ? "seconds: fill in exposure_s, of every photograph or once beside captures"
                : "EXIF as in the others, or a manifest.json with exposure_s");
    }
    for (Capture* capture : unknown) capture->exposure_s = nobody_says ? 1.0 : known_s;
}

void complete_exposures(std::vector<Capture>& captures,
                        const std::filesystem::path& manifest,
                        PhotographUse use) {
    std::vector<Capture*> all;
    for (Capture& capture : captures) all.push_back(&capture);
    complete_exposures(all, manifest, use);
}

}  // namespace livery
