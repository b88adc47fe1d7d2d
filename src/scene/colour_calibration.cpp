#include "scene/colour_calibration.h"

#include <cmath>
#include <limits>
#include <span>

#include "core/hash.h"

namespace livery {

namespace {

void add(Hasher& hasher, double value) { hasher.add_bytes(&value, sizeof value); }

void add(Hasher& hasher, int value) {
    const auto wide = static_cast<std::int64_t>(value);
    hasher.add_bytes(&wide, sizeof wide);
}

/// Every NaN counts as the same: picture files need not keep its payload.
void add(Hasher& hasher, const std::vector<float>& values) {
    constexpr std::size_t block_size = 4096;
    std::vector<float> block;
    block.reserve(block_size);
    add(hasher, static_cast<double>(values.size()));
    for (const float value : values) {
        block.push_back(std::isnan(value) ? std::numeric_limits<float>::quiet_NaN() : value);
        if (block.size() < block_size) continue;
        hasher.add(std::span<const float>(block));
        block.clear();
    }
    hasher.add(std::span<const float>(block));
}

template <typename T>
void add_size(Hasher& hasher, const Image<T>& image) {
    add(hasher, image.width);
    add(hasher, image.height);
    add(hasher, image.channels);
}

void add(Hasher& hasher, const ImageF& image) {
    add_size(hasher, image);
    add(hasher, image.values);
}

}  // namespace

void seal(ColourCalibration& calibration) {
    const auto& c = calibration;
    Hasher hasher;
    hasher.add("livery colour calibration 1");
    add(hasher, c.width);
    add(hasher, c.height);
    for (const auto* text : {&c.created, &c.mode, &c.made_with, &c.xyz_origin}) hasher.add(*text);
    add(hasher, c.dark_drive);
    add(hasher, c.bright_drive);
    for (const auto* plane : {&c.unmixing, &c.dark, &c.span, &c.camera_px}) add(hasher, *plane);
    add_size(hasher, c.status);
    hasher.add(std::span<const std::uint8_t>(c.status.values));
    for (const auto& curve : c.response) {
        add(hasher, curve.drive_from_n);
        add(hasher, curve.largest_violation);
    }
    add(hasher, c.table.grid);
    for (const auto& n : c.table.n_from_drive) hasher.add(std::span<const float>(&n.x, 3));
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) add(hasher, c.xyz_from_camera[column][row]);
    }
    for (int k = 0; k < 3; ++k) add(hasher, c.camera_ambient[k]);
    for (const double residual : {c.additivity_error,
                                  c.condition_p99,
                                  c.valid_fraction,
                                  c.ambient_fraction,
                                  c.mixing_spread}) {
        add(hasher, residual);
    }
    // Calibrations without a prediction keep the id that they had before there were any.
    const double prediction[] = {
        c.predicted_fraction, c.prediction_error_median, c.prediction_error_p95};
    if (prediction[0] != 0.0 || prediction[1] != 0.0 || prediction[2] != 0.0) {
        for (const double figure : prediction) add(hasher, figure);
    }
    for (const auto& warning : c.warnings) hasher.add(warning);
    calibration.id = hasher.hex();
}

}  // namespace livery
