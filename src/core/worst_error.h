// The worst of many errors, where one of them may be no number: std::max(worst, NaN) keeps `worst`,
// `NaN > worst` is false and a sort with NaN in it is undefined, so that the one result that is
// certainly wrong would be the only one not to count.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <initializer_list>
#include <limits>

namespace livery {

/// The error, infinite where it is no number: larger than every other, and in order.
template <std::floating_point T>
T worst_if_nan(T error) {
    return std::isnan(error) ? std::numeric_limits<T>::infinity() : error;
}

/// The larger of both; what is no number is the largest.
template <std::floating_point T>
T worse_of(T worst, T error) {
    return std::max(worst_if_nan(worst), worst_if_nan(error));
}
/// The largest of one or more.
template <std::floating_point T>
T worse_of(std::initializer_list<T> errors) {
    T worst = -std::numeric_limits<T>::infinity();
    for (const T error : errors) worst = worse_of(worst, error);
    return worst;
}

}  // namespace livery
