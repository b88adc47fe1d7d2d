#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/LU>

#include "appearance/measured/half_difference.h"
#include "appearance/measured/measured_samples.h"
#include "core/error.h"
#include "core/statistics.h"

namespace livery {

namespace {

/// Samples that take part in a value: enough for each direction around, few enough to be quick.
constexpr std::size_t kNeighbours = 24;
/// What is interpolated is log(value + this): per steradian, below what the instruments resolve.
constexpr double kFaintestSample = 1e-4;
/// Samples nearer than this are one, which has their mean: repeated, or light and eye exchanged.
constexpr double kSame = 1e-6;

template <typename Point>
double distance2(const Point& a, const Point& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

}  // namespace

/// A cone over theta_h whose turn is 2 phi_d, which closes after the pi that reciprocity leaves.
/// The root spreads narrow lobes. The turn counts less the smaller theta_d: at 0 nothing is left of
/// it.
SampleInterpolator::Point SampleInterpolator::point_of(glm::dvec3 angles) {
    const double per_right_angle = 2.0 / std::numbers::pi;
    const double radius = std::sqrt(std::clamp(angles.x * per_right_angle, 0.0, 1.0));
    const double turn = std::sin(angles.y);
    return {radius * std::sqrt(1.0 - 0.5 * turn * turn),
            radius * std::numbers::sqrt2 * 0.5 * turn * std::cos(2.0 * angles.z),
            radius * std::numbers::sqrt2 * 0.5 * turn * std::sin(2.0 * angles.z),
            angles.y * per_right_angle};
}

SampleInterpolator::SampleInterpolator(const MeasuredSamples& samples)
    : channels_(samples.channels()) {
    check_argument(!samples.pairs.empty(), "SampleInterpolator: no samples");
    std::vector<Point> points;
    for (const DirectionPair& pair : samples.pairs) {
        points.push_back(point_of(f64::half_difference(pair.wi, pair.wo)));
    }
    // Equal on a lattice of that step. Two on either side of a step's end stay two; evaluate() then
    // takes one of them.
    std::vector<std::array<std::int64_t, kAxes>> steps(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        for (std::size_t axis = 0; axis < kAxes; ++axis) {
            steps[k][axis] = std::llround(points[k][axis] / kSame);
        }
    }
    std::vector<std::size_t> sorted(points.size());
    std::iota(sorted.begin(), sorted.end(), std::size_t{0});
    std::sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
        return steps[a] < steps[b];
    });
    for (std::size_t first = 0, end = 0; first < sorted.size(); first = end) {
        std::vector<double> sum(channels_, 0.0);
        for (end = first; end < sorted.size() && steps[sorted[end]] == steps[sorted[first]];
             ++end) {
            for (std::size_t c = 0; c < channels_; ++c) {
                sum[c] += samples.values[sorted[end] * channels_ + c];
            }
        }
        points_.push_back(points[sorted[first]]);
        const auto count = static_cast<double>(end - first);
        for (const double total : sum)
            logarithms_.push_back(std::log(total / count + kFaintestSample));
    }
    order_.resize(points_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    build_tree(0, points_.size(), 0);
    std::vector<double> distances;
    std::vector<Near> heap;
    for (const Point& point : points_) {
        heap.clear();
        find_nearest(point, 0, points_.size(), 0, 2, heap);
        distances.push_back(std::sqrt(heap.front().distance2));
    }
    spacing_ = median(std::move(distances));
}

void SampleInterpolator::build_tree(std::size_t begin, std::size_t end, std::size_t axis) {
    if (end - begin < 2) return;
    const std::size_t middle = begin + (end - begin) / 2;
    std::vector<std::size_t> range(end - begin);
    std::iota(range.begin(), range.end(), begin);
    std::nth_element(
        range.begin(),
        range.begin() + static_cast<std::ptrdiff_t>(middle - begin),
        range.end(),
        [&](std::size_t a, std::size_t b) { return points_[a][axis] < points_[b][axis]; });
    std::vector<Point> points;
    std::vector<std::size_t> order;
    for (const std::size_t k : range) {
        points.push_back(points_[k]);
        order.push_back(order_[k]);
    }
    std::copy(points.begin(), points.end(), points_.begin() + static_cast<std::ptrdiff_t>(begin));
    std::copy(order.begin(), order.end(), order_.begin() + static_cast<std::ptrdiff_t>(begin));
    build_tree(begin, middle, (axis + 1) % kAxes);
    build_tree(middle + 1, end, (axis + 1) % kAxes);
}

void SampleInterpolator::find_nearest(const Point& at,
                                      std::size_t begin,
                                      std::size_t end,
                                      std::size_t axis,
                                      std::size_t count,
                                      std::vector<Near>& heap) const {
    if (begin == end) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const Near candidate{distance2(points_[middle], at), middle};
    if (heap.size() < count) {
        heap.push_back(candidate);
        std::push_heap(heap.begin(), heap.end());
    } else if (candidate < heap.front()) {
        std::pop_heap(heap.begin(), heap.end());
        heap.back() = candidate;
        std::push_heap(heap.begin(), heap.end());
    }
    const double across = at[axis] - points_[middle][axis];
    const std::size_t next = (axis + 1) % kAxes;
    const bool lower = across < 0.0;
    if (lower) {
        find_nearest(at, begin, middle, next, count, heap);
    } else {
        find_nearest(at, middle + 1, end, next, count, heap);
    }
    if (heap.size() < count || across * across < heap.front().distance2) {
        if (lower) {
            find_nearest(at, middle + 1, end, next, count, heap);
        } else {
            find_nearest(at, begin, middle, next, count, heap);
        }
    }
}

void SampleInterpolator::evaluate(glm::dvec3 half_difference, std::span<double> values) const {
    check_argument(values.size() == channels_, "SampleInterpolator: one value a channel");
    const Point at = point_of(half_difference);
    std::vector<Near> near;
    near.reserve(kNeighbours);
    find_nearest(at, 0, points_.size(), 0, kNeighbours, near);
    std::sort_heap(near.begin(), near.end());
    for (std::size_t k = 1; k < near.size();) {
        const bool same = std::any_of(
            near.begin(), near.begin() + static_cast<std::ptrdiff_t>(k), [&](const Near& other) {
                return distance2(points_[other.point], points_[near[k].point]) < kSame * kSame;
            });
        if (same) {
            near.erase(near.begin() + static_cast<std::ptrdiff_t>(k));
        } else {
            ++k;
        }
    }
    // Radial basis |x| with a constant, over the neighbours: the weights that a sum over them
    // takes.
    const std::size_t n = near.size();
    const auto size = static_cast<Eigen::Index>(n + 1);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Ones(size, size);
    Eigen::VectorXd target = Eigen::VectorXd::Ones(size);
    for (std::size_t row = 0; row < n; ++row) {
        const auto i = static_cast<Eigen::Index>(row);
        for (std::size_t column = 0; column < n; ++column) {
            matrix(i, static_cast<Eigen::Index>(column)) =
                std::sqrt(distance2(points_[near[row].point], points_[near[column].point]));
        }
        target[i] = std::sqrt(near[row].distance2);
    }
    matrix(size - 1, size - 1) = 0.0;
    const Eigen::VectorXd weights = matrix.partialPivLu().solve(target);
    if (!weights.allFinite()) {
        throw std::logic_error("SampleInterpolator: neighbours that are one point");
    }
    const auto logarithm = [&](std::size_t neighbour, std::size_t channel) {
        return logarithms_[order_[near[neighbour].point] * channels_ + channel];
    };
    for (std::size_t c = 0; c < channels_; ++c) {
        double sum = 0.0, low = logarithm(0, c), high = low;
        for (std::size_t k = 0; k < n; ++k) {
            const double value = logarithm(k, c);
            sum += weights[static_cast<Eigen::Index>(k)] * value;
            low = std::min(low, value);
            high = std::max(high, value);
        }
        values[c] = std::max(std::exp(std::clamp(sum, low, high)) - kFaintestSample, 0.0);
    }
}

double SampleInterpolator::distance_to_nearest(glm::dvec3 half_difference) const {
    std::vector<Near> nearest;
    find_nearest(point_of(half_difference), 0, points_.size(), 0, 1, nearest);
    return std::sqrt(nearest.front().distance2);
}

}  // namespace livery
