#include "calibration/camera_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"

namespace livery {
namespace {

constexpr int kCameraLevels = 256, kBlockSide = 4, kMostBlocks = 20000;
/// What is clipped, also by the noise, tells nothing.
constexpr double kLeastValue = 2.0, kMostValue = 250.0;
/// A block with an edge in it has no one light.
constexpr double kMostSpread = 16.0;
constexpr double kLeastRange = 4.0, kMostResidual = 0.03, kMostExposureError = 0.1;

/// A block of pixels of one channel that saw one light in every photograph.
struct LightPlace {
    std::vector<double> value;  ///< in each photograph; negative: clipped, or not of one light
};

/// The mean of a block: finer than the file's steps, and quieter than a pixel.
double value_of_block(const ImageF& image, int x, int y, int channel) {
    double sum = 0.0, least = 255.0, most = 0.0;
    for (int dy = 0; dy < kBlockSide; ++dy)
        for (int dx = 0; dx < kBlockSide; ++dx) {
            const double value = image.at(x + dx, y + dy, channel);
            sum += value;
            least = std::min(least, value);
            most = std::max(most, value);
        }
    const bool one_light =
        least >= kLeastValue && most <= kMostValue && most - least <= kMostSpread;
    return one_light ? sum / (kBlockSide * kBlockSide) : -1.0;
}

std::vector<LightPlace> places_of(const std::vector<Photograph>& photographs) {
    const ImageF& first = photographs.front().image;
    for (const Photograph& photograph : photographs)
        check_argument(photograph.image.width == first.width &&
                           photograph.image.height == first.height &&
                           photograph.image.channels == first.channels,
                       "photographs of different sizes");
    const int across = first.width / kBlockSide, blocks = across * (first.height / kBlockSide);
    // Odd, so that it does not walk down one column.
    const int step = (blocks * first.channels / kMostBlocks) | 1;
    std::vector<LightPlace> places;
    for (int block = 0; block < blocks; block += step)
        for (int channel = 0; channel < first.channels; ++channel) {
            LightPlace place;
            int usable = 0;
            for (const Photograph& photograph : photographs) {
                place.value.push_back(value_of_block(photograph.image,
                                                     block % across * kBlockSide,
                                                     block / across * kBlockSide,
                                                     channel));
                usable += place.value.back() >= 0.0 ? 1 : 0;
            }
            // One alone says nothing of the curve.
            if (usable >= 2) places.push_back(std::move(place));
        }
    return places;
}

/// A file value has the same noise everywhere, and light goes about as a power of it: its logarithm
/// is known in proportion to the value.
double weight_of(double value) { return value * value / (128.0 * 128.0); }

/// ln light of a value that lies between two levels, as a row of the unknowns.
struct LevelWeights {
    int below;
    double above_share;
};
LevelWeights row_of(double value) {
    const int below = std::clamp(static_cast<int>(value), 1, kCameraLevels - 2);
    return {below, value - below};
}

double at(const Eigen::VectorXd& unknowns, double value) {
    const LevelWeights row = row_of(value);
    return (1.0 - row.above_share) * unknowns[row.below] +
           row.above_share * unknowns[row.below + 1];
}

/// The unknowns: ln light of each level, then how far each exposure is from what it says, in
/// logarithms: shutters repeat to some tenths of a percent.
struct Problem {
    const std::vector<LightPlace>& places;
    std::vector<double> log_exposure;
    Eigen::MatrixXd normal;
    Eigen::VectorXd right;

    Problem(const std::vector<LightPlace>& of_places, const std::vector<Photograph>& photographs)
        : places(of_places) {
        for (const Photograph& photograph : photographs)
            log_exposure.push_back(std::log(photograph.exposure_s));
        const auto size = kCameraLevels + static_cast<Eigen::Index>(photographs.size());
        normal.setZero(size, size);
        right.setZero(size);
    }

    /// Adds weight (a.x - value)^2.
    void add(const Eigen::VectorXd& a, double value, double weight) {
        normal.noalias() += weight * a * a.transpose();
        right += weight * value * a;
    }

    // --- ln light(value) - ln exposure - error is one number at each place ---
    void add_places() {
        // As many independent looks as this, each good to a hundredth: neighbouring blocks have
        // their faults in common.
        constexpr double kTotal = 200.0 * 1e4;
        double sum = 0.0;
        for (const LightPlace& place : places)
            for (const double value : place.value) sum += value >= 0.0 ? weight_of(value) : 0.0;
        if (!(sum > 0.0)) return;
        for (const LightPlace& place : places) add_place(place, kTotal / sum);
    }

    /// The light of the place is eliminated: what is left is the spread about the weighted mean.
    void add_place(const LightPlace& place, double scale) {
        struct Entry {
            Eigen::Index index;
            double factor;
        };
        std::vector<Entry> mean;
        double mean_value = 0.0, weights = 0.0;
        for (std::size_t k = 0; k < place.value.size(); ++k) {
            if (place.value[k] < 0.0) continue;
            const double weight = scale * weight_of(place.value[k]);
            const LevelWeights row = row_of(place.value[k]);
            const std::array entries{Entry{row.below, 1.0 - row.above_share},
                                     Entry{row.below + 1, row.above_share},
                                     Entry{kCameraLevels + static_cast<Eigen::Index>(k), -1.0}};
            for (const Entry& a : entries) {
                for (const Entry& b : entries)
                    normal(a.index, b.index) += weight * a.factor * b.factor;
                right[a.index] += weight * log_exposure[k] * a.factor;
                mean.push_back({a.index, weight * a.factor});
            }
            mean_value += weight * log_exposure[k];
            weights += weight;
        }
        for (const Entry& a : mean) {
            for (const Entry& b : mean) normal(a.index, b.index) -= a.factor * b.factor / weights;
            right[a.index] -= a.factor * mean_value / weights;
        }
    }

    // --- smooth: over the logarithm of the value a power is straight ---
    void add_smoothness() {
        constexpr double kWeight = 1.0;
        const auto size = normal.rows();
        for (int level = 2; level < kCameraLevels - 1; ++level) {
            const double before = std::log(level / (level - 1.0)),
                         after = std::log((level + 1.0) / level), step = 0.5 * (before + after);
            Eigen::VectorXd bend = Eigen::VectorXd::Zero(size);
            bend[level - 1] = 1.0 / (before * step);
            bend[level + 1] = 1.0 / (after * step);
            bend[level] = -bend[level - 1] - bend[level + 1];
            add(bend, 0.0, kWeight * step);
        }
    }

    // --- one scale is free, and exposures are nearly what they say ---
    void add_priors() {
        constexpr double kExposureError = 0.005;
        const auto size = normal.rows();
        const auto only = [size](Eigen::Index index) -> Eigen::VectorXd {
            return Eigen::VectorXd::Unit(size, index);
        };
        add(only(kCameraLevels - 1), 0.0, 1.0);
        add(only(0), 0.0, 1.0);
        for (Eigen::Index k = kCameraLevels; k < size; ++k)
            add(only(k), 0.0, 1.0 / (kExposureError * kExposureError));
    }
};

/// Root mean square of what each photograph says of a place's light against all of them, weighted
/// as the fit was, as a share of the light.
double residual_of(const Problem& problem, const Eigen::VectorXd& unknowns) {
    double square = 0.0, weights = 0.0;
    for (const LightPlace& place : problem.places) {
        double sum = 0.0, sum_square = 0.0, weight_sum = 0.0;
        for (std::size_t k = 0; k < place.value.size(); ++k) {
            if (place.value[k] < 0.0) continue;
            const double weight = weight_of(place.value[k]);
            const double light = at(unknowns, place.value[k]) - problem.log_exposure[k] -
                                 unknowns[kCameraLevels + static_cast<Eigen::Index>(k)];
            sum += weight * light;
            sum_square += weight * light * light;
            weight_sum += weight;
        }
        square += sum_square - sum * sum / weight_sum;
        weights += weight_sum;
    }
    return std::sqrt(std::max(square, 0.0) / weights);
}

}  // namespace

CameraResponse fit_camera_response(const std::vector<Photograph>& photographs) {
    check_argument(photographs.size() >= 2, "a response needs several exposures");
    const auto by_exposure = [](const Photograph& a, const Photograph& b) {
        return a.exposure_s < b.exposure_s;
    };
    const auto [shortest, longest] =
        std::minmax_element(photographs.begin(), photographs.end(), by_exposure);
    check_argument(shortest->exposure_s > 0.0, "an exposure of no time");
    if (longest->exposure_s < kLeastRange * shortest->exposure_s)
        throw Refused(fmt::format("the exposures differ by a factor of {:.2g} only",
                                  longest->exposure_s / shortest->exposure_s),
                      "let the program set the exposure: turn the dial to M");
    const std::vector<LightPlace> places = places_of(photographs);
    if (places.empty())
        throw Refused("nothing in the photographs is neither black nor clipped in two of them",
                      "point the camera at what the projector lights, and set its exposure so that "
                      "white is not clipped");

    Problem problem(places, photographs);
    problem.add_places();
    problem.add_smoothness();
    problem.add_priors();
    const Eigen::VectorXd unknowns = problem.normal.ldlt().solve(problem.right);

    CameraResponse response;
    response.residual = residual_of(problem, unknowns);
    const double exposure_error =
        unknowns.tail(unknowns.size() - kCameraLevels).cwiseAbs().maxCoeff();
    if (!(response.residual < kMostResidual && exposure_error < kMostExposureError))
        throw Refused(fmt::format("the photographs do not follow their exposures: after the fit "
                                  "their light differs by {:.1f}%, their exposures are up to "
                                  "{:.0f}% from what they say",
                                  100.0 * response.residual,
                                  100.0 * std::expm1(exposure_error)),
                      "switch automatic exposure, automatic ISO and picture optimisers (active "
                      "D-lighting, HDR) off, and keep the light still");
    response.linear_from_file.assign(kCameraLevels, 0.0);
    for (int level = 1; level < kCameraLevels; ++level) {
        const auto index = static_cast<std::size_t>(level);
        response.linear_from_file[index] =
            std::max(std::exp(unknowns[level] - unknowns[kCameraLevels - 1]),
                     response.linear_from_file[index - 1]);
    }
    return response;
}

std::vector<Photograph> photograph_exposures(const BenchPorts& bench,
                                             int width,
                                             int height,
                                             const Progress& progress) {
    constexpr std::array kOfOwn{1.0, 4.0, 2.0, 1.4, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125, 0.0625};
    bench.show(Image8(width, height, 3, 255));
    const double own_s = bench.photograph(0.0).exposure_s;
    std::vector<Photograph> photographs;
    for (const double factor : kOfOwn) {
        progress.update(static_cast<double>(photographs.size()) / kOfOwn.size(),
                        "photographing white at other exposures");
        photographs.push_back(bench.photograph(factor * own_s));
    }
    return photographs;
}

}  // namespace livery
