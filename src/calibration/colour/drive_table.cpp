#include "calibration/colour/drive_table.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Cholesky>

#include "core/error.h"
#include "core/mutation.h"
#include "core/worst_error.h"

namespace livery {
namespace {

constexpr int kGrid = 17;
constexpr int kKnots = 32;  // of each curve, besides 0 at 0
// 0..2: one channel; 3..5: the smaller of two; 6: the smallest of three
constexpr int kCurves = 7;
constexpr int kUnknowns = kCurves * kKnots;
constexpr double kModelSigma = 0.002;  // of N: what photographs do not repeat better than

/// Knots lie closer where light is little, as the eye needs it.
double knot(int j) { return static_cast<double>(j * j) / (kKnots * kKnots); }

/// What one sample asks of the unknowns: two knots a curve.
struct Row {
    std::array<int, 2 * kCurves> column{};
    std::array<double, 2 * kCurves> value{};
    int count = 0;

    void add(int curve, double at) {
        const double root = std::sqrt(std::clamp(at, 0.0, 1.0)) * kKnots;
        const int low = std::clamp(static_cast<int>(root), 0, kKnots - 1);
        const double fraction = (at - knot(low)) / (knot(low + 1) - knot(low));
        if (low > 0) push(curve * kKnots + low - 1, 1.0 - fraction);
        push(curve * kKnots + low, fraction);
    }

  private:
    void push(int c, double v) {
        column[static_cast<std::size_t>(count)] = c;
        value[static_cast<std::size_t>(count++)] = v;
    }
};

Row row_of(const glm::dvec3& light) {
    Row row;
    for (int k = 0; k < 3; ++k) row.add(k, light[k]);
    row.add(3, std::min(light.x, light.y));
    row.add(4, std::min(light.y, light.z));
    row.add(5, std::min(light.x, light.z));
    row.add(6, std::min({light.x, light.y, light.z}));
    return row;
}

using Matrix = Eigen::MatrixXd;

/// Smoothness: slopes from knot to knot differ by about `sigma`; size: values are about 0.3.
void add_priors(Matrix& normal) {
    for (int curve = 0; curve < kCurves; ++curve) {
        const int first = curve * kKnots - 1;  // column of knot 0, which is held at 0
        for (int j = 1; j < kKnots; ++j) {
            const double left = 1.0 / (knot(j) - knot(j - 1)),
                         right = 1.0 / (knot(j + 1) - knot(j));
            const std::array<double, 3> slope_change{left, -left - right, right};
            constexpr double kSigma = 0.1;
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) {
                    if (j - 1 + a == 0 || j - 1 + b == 0) continue;
                    normal(first + j - 1 + a, first + j - 1 + b) +=
                        slope_change[static_cast<std::size_t>(a)] *
                        slope_change[static_cast<std::size_t>(b)] / (kSigma * kSigma);
                }
        }
        // Two channels add to each other more rarely than all three.
        const double sigma = curve == 6 ? 0.5 : curve >= 3 ? 0.1 : 0.03;
        for (int j = 1; j <= kKnots; ++j) normal(first + j, first + j) += 1.0 / (sigma * sigma);
    }
}

/// Response of one channel from the samples in which it shines alone.
LevelCurve single_channel(const std::vector<TableSample>& samples, std::size_t channel) {
    LevelCurve curve;
    int distinct = 0;
    for (const TableSample& sample : samples) {
        bool alone = true;
        for (std::size_t k = 0; k < 3; ++k) alone &= k == channel || sample.drive[k] == 0;
        if (!alone) continue;
        const std::size_t level = sample.drive[channel];
        const double weight = 1.0 / (sample.variance + 1e-9);
        distinct += curve.weight[level] == 0.0;
        const double total = curve.weight[level] + weight;
        curve.n[level] += weight / total * (sample.n[static_cast<int>(channel)] - curve.n[level]);
        curve.weight[level] = total;
    }
    constexpr std::array<const char*, 3> kNames{"red", "green", "blue"};
    if (distinct < 6)
        throw Refused(
            "the mosaics show only " + std::to_string(distinct) + " levels of " + kNames[channel] +
                " alone on the mock-up",
            "photograph more mosaics, or make the mock-up larger in the projector's picture");
    return smooth_levels(curve);
}

}  // namespace

TableFit fit_drive_table(const std::vector<TableSample>& samples) {
    TableFit fit;
    std::array<std::array<double, 256>, 3> light;  // 0 to 1
    glm::dvec3 full(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
        const LevelCurve curve = single_channel(samples, k);
        fit.response[k] = invert_levels(curve, 0, 255);
        const std::vector<double> n = isotonic_regression(curve.n, curve.weight);
        full[static_cast<int>(k)] = n[255] - n[0];
        for (std::size_t i = 0; i < 256; ++i) light[k][i] = (n[i] - n[0]) / (n[255] - n[0]);
    }

    // What remains beside the channels' own light, by least squares
    Matrix normal = Matrix::Zero(kUnknowns, kUnknowns);
    Matrix right = Matrix::Zero(kUnknowns, 3);
    add_priors(normal);
    const auto light_of = [&](const TableSample& s) {
        return glm::dvec3(light[0][s.drive[0]], light[1][s.drive[1]], light[2][s.drive[2]]);
    };
    for (const TableSample& sample : samples) {
        const glm::dvec3 p = light_of(sample);
        const Row row = row_of(p);
        const double weight = 1.0 / (sample.variance + kModelSigma * kModelSigma);
        const glm::dvec3 rest = sample.n - LIVERY_MUTATED(drive_table_fit, full * p);
        for (int a = 0; a < row.count; ++a) {
            const int i = row.column[static_cast<std::size_t>(a)];
            const double wa = weight * row.value[static_cast<std::size_t>(a)];
            for (int c = 0; c < 3; ++c) right(i, c) += wa * rest[c];
            for (int b = 0; b < row.count; ++b)
                normal(i, row.column[static_cast<std::size_t>(b)]) +=
                    wa * row.value[static_cast<std::size_t>(b)];
        }
    }
    const Matrix knots = normal.llt().solve(right);
    const auto n_of = [&](const glm::dvec3& p) {
        const Row row = row_of(p);
        glm::dvec3 n = full * p;
        for (int a = 0; a < row.count; ++a) {
            const int i = row.column[static_cast<std::size_t>(a)];
            n += row.value[static_cast<std::size_t>(a)] *
                 glm::dvec3(knots(i, 0), knots(i, 1), knots(i, 2));
        }
        return n;
    };

    double square = 0.0, count = 0.0;
    for (const TableSample& sample : samples) {
        const glm::dvec3 error = n_of(light_of(sample)) - sample.n;
        // Noise is no fault of the fit.
        square += worse_of(0.0, glm::dot(error, error) / 3.0 - sample.variance);
        count += 1.0;
    }
    fit.rms_error = std::sqrt(square / std::max(count, 1.0));
    if (fit.rms_error > 0.02)
        throw Refused("the mosaics of colours do not follow one table: they differ from it by " +
                          std::to_string(100.0 * fit.rms_error).substr(0, 4) + "% of white",
                      "switch the projector to its sRGB or cinema mode, its colour enhancement and "
                      "dynamic contrast off, and photograph again");

    fit.table.grid = kGrid;
    for (int b = 0; b < kGrid; ++b)
        for (int g = 0; g < kGrid; ++g)
            for (int r = 0; r < kGrid; ++r) {
                glm::dvec3 p;
                const std::array<int, 3> node{r, g, b};
                for (std::size_t k = 0; k < 3; ++k) {
                    const double drive = 255.0 * node[k] / (kGrid - 1);
                    const auto low = std::min<std::size_t>(static_cast<std::size_t>(drive), 254);
                    const double fraction = drive - static_cast<double>(low);
                    p[static_cast<int>(k)] =
                        light[k][low] + fraction * (light[k][low + 1] - light[k][low]);
                }
                fit.table.n_from_drive.emplace_back(n_of(p));
            }
    return fit;
}

}  // namespace livery
