#include "appearance/measured/measured_merl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "appearance/measured/measured_samples.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr auto kH = static_cast<std::size_t>(kMerlBins[0]);
constexpr auto kD = static_cast<std::size_t>(kMerlBins[1]);
constexpr auto kPhi = static_cast<std::size_t>(kMerlBins[2]);
constexpr std::size_t kCount = kH * kD * kPhi;
constexpr std::size_t kHeaderBytes = 3 * sizeof(std::int32_t);
constexpr std::size_t kFileBytes = kHeaderBytes + 3 * kCount * sizeof(double);
constexpr std::array<double, 3> kScale{1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

static_assert(std::endian::native == std::endian::little, "MERL's files are little-endian");

std::size_t bin_at(std::size_t h, std::size_t d, std::size_t phi) {
    return phi + kPhi * (d + kD * h);
}

std::string name_of_bin(std::size_t bin) {
    return fmt::format(
        "theta_h {}, theta_d {}, phi_d {}", bin / (kPhi * kD), bin / kPhi % kD, bin % kPhi);
}

void check_header(std::string_view bytes, const std::filesystem::path& file) {
    std::array<std::int32_t, 3> bins{};
    if (bytes.size() < kHeaderBytes) {
        throw FileError(file,
                        "header",
                        std::to_string(bytes.size()) + " bytes",
                        "a MERL table: three 32-bit numbers 90, 90, 180, then doubles");
    }
    std::memcpy(bins.data(), bytes.data(), kHeaderBytes);
    if (!std::equal(bins.begin(), bins.end(), kMerlBins.begin())) {
        throw FileError(file,
                        "header",
                        fmt::format("{} x {} x {} bins", bins[0], bins[1], bins[2]),
                        "90 x 90 x 180, an isotropic MERL table");
    }
    if (bytes.size() != kFileBytes) {
        throw FileError(file,
                        "",
                        std::to_string(bytes.size()) + " bytes",
                        std::to_string(kFileBytes) + " of three planes of doubles");
    }
}

/// Gives each hole the nearest measurement along theta_d, and where there is none along theta_h.
void fill_holes(MerlTable& table) {
    std::vector<bool> known = table.measured;
    const auto fill_line = [&](std::size_t count, const auto& bin) {
        // The last and the next known bin of each hole, nearer first.
        std::size_t begin = 0;
        std::vector<bool> was(count);
        for (std::size_t k = 0; k < count; ++k) was[k] = known[bin(k)];
        while (begin < count && !was[begin]) ++begin;
        if (begin == count) return;
        std::size_t last = begin;
        for (std::size_t k = 0; k < count; ++k) {
            if (was[k]) {
                last = k;
                continue;
            }
            std::size_t next = k;
            while (next < count && !was[next]) ++next;
            const bool take_next = next < count && (k < last || next - k < k - last);
            table.values[bin(k)] = table.values[bin(take_next ? next : last)];
            known[bin(k)] = true;
        }
    };
    for (std::size_t h = 0; h < kH; ++h) {
        for (std::size_t phi = 0; phi < kPhi; ++phi) {
            fill_line(kD, [&](std::size_t d) { return bin_at(h, d, phi); });
        }
    }
    for (std::size_t d = 0; d < kD; ++d) {
        for (std::size_t phi = 0; phi < kPhi; ++phi) {
            fill_line(kH, [&](std::size_t h) { return bin_at(h, d, phi); });
        }
    }
    // What is left is one phi_d without any: its neighbours' around the half vector.
    for (std::size_t h = 0; h < kH; ++h) {
        for (std::size_t d = 0; d < kD; ++d) {
            fill_line(kPhi, [&](std::size_t phi) { return bin_at(h, d, phi); });
        }
    }
}

/// The bins whose theta_h is below a thousandth: which of them a pair of directions falls into is
/// noise, for phi_d turns with the half vector's azimuth.
void settle_centre(MerlTable& table) {
    for (std::size_t h = 0; h < kH; ++h) {
        const double u = (static_cast<double>(h) + 0.5) / static_cast<double>(kH);
        if (0.5 * std::numbers::pi * u * u > 1e-3) break;
        for (std::size_t d = 0; d < kD; ++d) {
            glm::dvec3 sum(0.0), filled(0.0);
            double count = 0.0;
            for (std::size_t phi = 0; phi < kPhi; ++phi) {
                const std::size_t bin = bin_at(h, d, phi);
                filled += table.values[bin];
                if (!table.measured[bin]) continue;
                sum += table.values[bin];
                count += 1.0;
            }
            const glm::dvec3 mean = count > 0.0 ? sum / count : filled / static_cast<double>(kPhi);
            for (std::size_t phi = 0; phi < kPhi; ++phi) table.values[bin_at(h, d, phi)] = mean;
        }
    }
}

/// Two neighbours on an axis whose bins have their middles at k + 1/2, and the share of the second.
struct Between {
    std::size_t first, second;
    double share;
};

Between between(double bins_from_zero, std::size_t count, bool goes_round) {
    const double at = bins_from_zero - 0.5;
    const double low = std::floor(at);
    const auto last = static_cast<double>(count - 1);
    if (goes_round) {
        const auto wrapped = [&](double k) {
            return static_cast<std::size_t>(k < 0.0 ? k + last + 1.0 : k > last ? 0.0 : k);
        };
        return {wrapped(low), wrapped(low + 1.0), at - low};
    }
    const auto clamped = [&](double k) {
        return static_cast<std::size_t>(std::clamp(k, 0.0, last));
    };
    return {clamped(low), clamped(low + 1.0), at - low};
}

/// Angles in bins from zero.
glm::dvec3 bins_of(glm::dvec3 angles) {
    const double per_right_angle = 2.0 / std::numbers::pi;
    return {static_cast<double>(kH) * std::sqrt(std::clamp(angles.x * per_right_angle, 0.0, 1.0)),
            static_cast<double>(kD) * std::clamp(angles.y * per_right_angle, 0.0, 1.0),
            static_cast<double>(kPhi) * angles.z / std::numbers::pi};
}

}  // namespace

MerlTable read_merl_file(const std::filesystem::path& file) {
    return parse_merl(read_text_file(file, kFileBytes + 1), file);
}

MerlTable parse_merl(std::string_view bytes, const std::filesystem::path& file) {
    check_header(bytes, file);
    MerlTable table;
    table.values.resize(kCount);
    table.measured.assign(kCount, true);
    for (std::size_t c = 0; c < 3; ++c) {
        const char* plane = bytes.data() + kHeaderBytes + c * kCount * sizeof(double);
        for (std::size_t k = 0; k < kCount; ++k) {
            double raw = 0.0;
            std::memcpy(&raw, plane + k * sizeof(double), sizeof raw);
            const double value = raw * kScale[c];
            if (!std::isfinite(raw) || value > kLargestReflectance) {
                throw FileError(
                    file,
                    fmt::format(
                        "{} of bin {}", std::array{"red", "green", "blue"}[c], name_of_bin(k)),
                    fmt::format("{}", raw),
                    "a finite reflectance, negative where there is none");
            }
            if (raw < 0.0) table.measured[k] = false;
            table.values[k][static_cast<glm::length_t>(c)] = std::max(value, 0.0);
        }
    }
    table.masked =
        static_cast<std::size_t>(std::count(table.measured.begin(), table.measured.end(), false));
    if (table.masked == kCount) {
        throw FileError(file, "", "no measurement: a negative channel in every bin", "some");
    }
    fill_holes(table);
    settle_centre(table);
    return table;
}

glm::dvec3 merl_value(const MerlTable& table, glm::dvec3 angles) {
    const glm::dvec3 at = bins_of(angles);
    const Between h = between(at.x, kH, false);
    const Between d = between(at.y, kD, false);
    const Between phi = between(at.z, kPhi, true);
    const auto along_phi = [&](std::size_t bin_h, std::size_t bin_d) {
        return (1.0 - phi.share) * table.values[bin_at(bin_h, bin_d, phi.first)] +
               phi.share * table.values[bin_at(bin_h, bin_d, phi.second)];
    };
    const auto along_d = [&](std::size_t bin_h) {
        if (at.y >= 0.5) {
            return (1.0 - d.share) * along_phi(bin_h, d.first) +
                   d.share * along_phi(bin_h, d.second);
        }
        // Below the first bin's middle: toward what does not depend on phi_d.
        glm::dvec3 mean(0.0);
        for (std::size_t k = 0; k < kPhi; ++k) mean += table.values[bin_at(bin_h, 0, k)];
        return (1.0 - 2.0 * at.y) * (mean / static_cast<double>(kPhi)) +
               2.0 * at.y * along_phi(bin_h, 0);
    };
    return (1.0 - h.share) * along_d(h.first) + h.share * along_d(h.second);
}

bool merl_measured(const MerlTable& table, glm::dvec3 angles) {
    const glm::dvec3 at = bins_of(angles);
    const auto bin = [](double k, std::size_t count) {
        return std::min(static_cast<std::size_t>(k), count - 1);
    };
    return table.measured[bin_at(bin(at.x, kH), bin(at.y, kD), bin(at.z, kPhi))];
}

}  // namespace livery
