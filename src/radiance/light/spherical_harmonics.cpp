#include "radiance/light/spherical_harmonics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"

namespace livery {

FourierTransform::FourierTransform(std::size_t length, double sign) {
    for (std::size_t i = 1, j = 0; i < length; ++i) {
        std::size_t bit = length >> 1u;
        for (; j & bit; bit >>= 1u) j ^= bit;
        j ^= bit;
        if (i >= j) continue;
        swaps_.push_back(static_cast<std::uint32_t>(i));
        swaps_.push_back(static_cast<std::uint32_t>(j));
    }
    for (std::size_t size = 2; size <= length; size *= 2) {
        for (std::size_t k = 0; k < size / 2; ++k) {
            turns_.push_back(std::polar(1.0,
                                        sign * 2.0 * std::numbers::pi * static_cast<double>(k) /
                                            static_cast<double>(size)));
        }
    }
}

void FourierTransform::run(std::vector<std::complex<double>>& x) const {
    for (std::size_t k = 0; k < swaps_.size(); k += 2) std::swap(x[swaps_[k]], x[swaps_[k + 1]]);
    const std::complex<double>* turn = turns_.data();
    for (std::size_t size = 2; size <= x.size(); size *= 2) {
        const std::size_t half = size / 2;
        for (std::size_t begin = 0; begin < x.size(); begin += size) {
            for (std::size_t k = 0; k < half; ++k) {
                std::complex<double>& a = x[begin + k];
                std::complex<double>& b = x[begin + k + half];
                // Written out: the library's product looks for NaN after each multiplication
                const double re = b.real() * turn[k].real() - b.imag() * turn[k].imag();
                const double im = b.real() * turn[k].imag() + b.imag() * turn[k].real();
                b = {a.real() - re, a.imag() - im};
                a = {a.real() + re, a.imag() + im};
            }
        }
        turn += half;
    }
}

namespace {

using Complex = std::complex<double>;

/// Legendre functions under this add nothing that a float would show: near the poles high orders
/// are that small over most degrees.
constexpr double kNegligible = 1e-13;

/// Normalised associated Legendre functions, degrees m upward, by the three-term recurrence in the
/// degree. What depends on neither row nor picture is worked out once.
class Legendre {
  public:
    explicit Legendre(int degree) : degree_(degree) {
        const auto orders = static_cast<std::size_t>(degree + 1);
        steps_.resize(orders * (orders + 1) / 2);
        double log_start = 0.5 * std::log(1.0 / (4.0 * std::numbers::pi));
        for (int order = 0; order <= degree; ++order) {
            const double m = order;
            if (order > 0) log_start += 0.5 * std::log1p(-0.5 / m);
            log_start_.push_back(log_start + 0.5 * std::log(2.0 * m + 1.0));
            Step* step = &steps_[begin_of(order)];
            for (double l = m + 1.0; l <= degree; ++l) {
                *step++ = {std::sqrt((4.0 * l * l - 1.0) / (l * l - m * m)),
                           std::sqrt(((l - 1.0) * (l - 1.0) - m * m) /
                                     (4.0 * (l - 1.0) * (l - 1.0) - 1.0))};
            }
        }
    }

    /// Values of degrees m, m + 1, ... at one polar angle; those before the returned index, which
    /// is even, are negligible.
    std::size_t values(int m, double cosine, double sine, std::vector<double>& into) const {
        const auto count = static_cast<std::size_t>(degree_ - m + 1);
        const Step* step = &steps_[begin_of(m)];
        double previous = 0.0;
        double current = std::exp(log_start_[static_cast<std::size_t>(m)] + m * std::log(sine));
        std::size_t first = count;
        for (std::size_t k = 0; k < count; ++k) {
            into[k] = current;
            if (first == count && std::abs(current) > kNegligible) first = k;
            const double next = step[k].scale * (cosine * current - step[k].back * previous);
            previous = current;
            current = next;
        }
        return first & ~std::size_t{1};
    }

  private:
    struct Step {
        double scale = 0.0, back = 0.0;
    };
    std::size_t begin_of(int m) const {
        const auto order = static_cast<std::size_t>(m), all = static_cast<std::size_t>(degree_ + 1);
        return order * all - order * (order - 1) / 2;
    }
    int degree_;
    std::vector<double> log_start_;
    std::vector<Step> steps_;  ///< of each order, from its own degree upward
};

double polar_angle(int row, int rows) { return std::numbers::pi * (row + 0.5) / rows; }

/// Fejer's first rule: exact for polynomials in the cosine of a lower degree than there are rows.
double row_weight(int row, int rows) {
    const double theta = polar_angle(row, rows);
    // cos(2 k theta) by Chebyshev's recurrence
    const double twice = 2.0 * std::cos(2.0 * theta);
    double before = 1.0, now = 0.5 * twice, sum = 1.0;
    for (int k = 1; k <= rows / 2; ++k) {
        sum -= 2.0 * now / (4.0 * k * k - 1.0);
        const double next = twice * now - before;
        before = now;
        now = next;
    }
    return 2.0 / rows * sum;
}

void check_width(int width, int least) {
    check_argument(
        width >= least && std::has_single_bit(static_cast<unsigned>(width)),
        fmt::format(
            "sphere pictures need a power of two of at least {} columns, not {}", least, width));
}

/// A complex number as one register of the processor's smallest vector unit holds it.
using Pair = double __attribute__((vector_size(16)));

/// The three complex numbers that a step of either direction works on.
struct Triple {
    Pair red{}, green{}, blue{};

    void add(double scale, const Triple& other) {
        const Pair both{scale, scale};
        red += both * other.red;
        green += both * other.green;
        blue += both * other.blue;
    }
    Complex at(std::size_t channel) const {
        const Pair value = channel == 0 ? red : channel == 1 ? green : blue;
        return {value[0], value[1]};
    }
    void set(std::size_t channel, Complex value) {
        (channel == 0 ? red : channel == 1 ? green : blue) = Pair{value.real(), value.imag()};
    }
};
Triple sum_of(const Triple& a, const Triple& b, double sign) {
    Triple result = a;
    result.add(sign, b);
    return result;
}

/// Fourier series of each row up to `orders`, times the quadrature weight of its texels:
/// [order][row].
std::vector<Triple> series_of_rows(const ImageF& picture, std::size_t orders) {
    const auto rows = static_cast<std::size_t>(picture.height);
    const auto columns = static_cast<std::size_t>(picture.width);
    const FourierTransform transform(columns, -1.0);
    // Column j is at azimuth 2 pi (j + 1/2) / width
    std::vector<Complex> half_column;
    for (std::size_t m = 0; m < orders; ++m) {
        half_column.push_back(std::polar(
            1.0, -std::numbers::pi * static_cast<double>(m) / static_cast<double>(columns)));
    }
    std::vector<Triple> series(rows * orders);
    parallel_for(rows, 16, [&](std::size_t begin, std::size_t end) {
        // Two real lines make one complex one: their series are its even and odd parts
        std::vector<Complex> red_green(columns), blue(columns);
        const auto split = [&](const std::vector<Complex>& both, std::size_t m, double sign) {
            const Complex mirrored = std::conj(both[(columns - m) % columns]);
            const Complex part = 0.5 * (both[m] + sign * mirrored);
            return sign > 0.0 ? part : Complex(part.imag(), -part.real());
        };
        for (std::size_t y = begin; y < end; ++y) {
            const int row = static_cast<int>(y);
            const double weight =
                row_weight(row, picture.height) * 2.0 * std::numbers::pi / picture.width;
            const float* texel = picture.pixel(0, row);
            for (std::size_t x = 0; x < columns; ++x, texel += 3) {
                red_green[x] = Complex(static_cast<double>(texel[0]) * weight,
                                       static_cast<double>(texel[1]) * weight);
                blue[x] = static_cast<double>(texel[2]) * weight;
            }
            transform.run(red_green);
            transform.run(blue);
            for (std::size_t m = 0; m < orders; ++m) {
                Triple& to = series[m * rows + y];
                to.set(0, split(red_green, m, 1.0) * half_column[m]);
                to.set(1, split(red_green, m, -1.0) * half_column[m]);
                to.set(2, blue[m] * half_column[m]);
            }
        }
    });
    return series;
}

}  // namespace

SphericalHarmonics analyse_sphere(const ImageF& picture, int degree) {
    check_width(picture.width, 2 * (degree + 1));
    check_argument(
        picture.height > degree && picture.channels == 3,
        fmt::format("degree {} needs more than {} rows of three channels", degree, picture.height));
    const auto rows = static_cast<std::size_t>(picture.height);
    const auto orders = static_cast<std::size_t>(degree + 1);
    const std::vector<Triple> series = series_of_rows(picture, orders);
    const Legendre legendre(degree);

    SphericalHarmonics result;
    result.degree = degree;
    for (auto& channel : result.coefficients) {
        channel.assign(result.index(degree, degree) + 1, Complex(0.0));
    }
    parallel_for(orders, 4, [&](std::size_t begin, std::size_t end) {
        std::vector<double> p(orders);
        std::vector<Triple> sums(orders);
        for (std::size_t order = begin; order < end; ++order) {
            const int m = static_cast<int>(order);
            const std::size_t count = orders - order;
            std::fill(sums.begin(), sums.end(), Triple{});
            // A row and its mirror image across the equator have the same values, odd degrees past
            // m with the sign changed.
            for (std::size_t y = 0; y < (rows + 1) / 2; ++y) {
                const double theta = polar_angle(static_cast<int>(y), picture.height);
                const Triple& north = series[order * rows + y];
                const std::size_t mirrored = rows - 1 - y;
                const Triple south = mirrored == y ? Triple{} : series[order * rows + mirrored];
                const Triple even = sum_of(north, south, 1.0), odd = sum_of(north, south, -1.0);
                std::size_t k = legendre.values(m, std::cos(theta), std::sin(theta), p);
                for (; k + 1 < count; k += 2) {
                    sums[k].add(p[k], even);
                    sums[k + 1].add(p[k + 1], odd);
                }
                if (k < count) sums[k].add(p[k], even);
            }
            for (std::size_t k = 0; k < count; ++k) {
                const std::size_t at = result.index(m + static_cast<int>(k), m);
                for (std::size_t c = 0; c < 3; ++c) result.coefficients[c][at] = sums[k].at(c);
            }
        }
    });
    return result;
}

std::vector<ImageF> synthesise_sphere(const SphericalHarmonics& harmonics,
                                      std::span<const std::vector<double>> kernels,
                                      int width,
                                      int height) {
    std::size_t longest = 0;
    for (const auto& kernel : kernels) longest = std::max(longest, kernel.size());
    const int degree = std::min(harmonics.degree, static_cast<int>(longest) - 1);
    check_width(width, 2 * (degree + 1));
    const auto rows = static_cast<std::size_t>(height), columns = static_cast<std::size_t>(width);
    const auto orders = static_cast<std::size_t>(degree + 1);
    const Legendre legendre(degree);
    const FourierTransform transform(columns, 1.0);

    // Coefficients under each kernel, both signs of m at once, at azimuth 2 pi (j + 1/2) / width:
    // [m and l as in the harmonics][kernel]
    const std::size_t kernel_count = kernels.size();
    const auto begin_of = [&](std::size_t m) { return m * orders - m * (m - 1) / 2; };
    std::vector<Triple> scaled(begin_of(orders) * kernel_count);
    std::vector<std::size_t> degrees(kernel_count);
    for (std::size_t k = 0; k < kernel_count; ++k) degrees[k] = std::min(kernels[k].size(), orders);
    parallel_for(orders, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m) {
            const Complex turn =
                std::polar(m == 0 ? 1.0 : 2.0, std::numbers::pi * static_cast<double>(m) / width);
            for (std::size_t l = m; l < orders; ++l) {
                const std::size_t at = harmonics.index(static_cast<int>(l), static_cast<int>(m));
                Triple unscaled;
                for (std::size_t c = 0; c < 3; ++c) {
                    unscaled.set(c, harmonics.coefficients[c][at] * turn);
                }
                Triple* to = &scaled[(begin_of(m) + l - m) * kernel_count];
                for (std::size_t k = 0; k < kernel_count; ++k) {
                    if (l < degrees[k]) to[k].add(kernels[k][l], unscaled);
                }
            }
        }
    });

    std::vector<ImageF> pictures(kernel_count, ImageF(width, height, 3));
    parallel_for((rows + 1) / 2, 2, [&](std::size_t begin, std::size_t end) {
        std::vector<double> p(orders);
        // Series of a row and of its mirror image across the equator: [kernel][m]
        std::vector<Triple> north(kernel_count * orders), south(kernel_count * orders);
        std::vector<Complex> line(columns);
        // Of two real lines at once: x + i y of two Hermitian series
        const auto add_line = [&](const Triple* series, std::size_t channel, Complex factor) {
            line[0] += factor * series[0].at(channel).real();
            for (std::size_t m = 1; m < orders; ++m) {
                const Complex half = 0.5 * series[m].at(channel);
                const Complex turned(factor.real() * half.real() - factor.imag() * half.imag(),
                                     factor.real() * half.imag() + factor.imag() * half.real());
                const Complex mirrored(factor.real() * half.real() + factor.imag() * half.imag(),
                                       factor.imag() * half.real() - factor.real() * half.imag());
                line[m] += turned;
                line[columns - m] += mirrored;
            }
        };
        for (std::size_t y = begin; y < end; ++y) {
            const double theta = polar_angle(static_cast<int>(y), height);
            const double cosine = std::cos(theta), sine = std::sin(theta);
            for (std::size_t m = 0; m < orders; ++m) {
                const std::size_t first = legendre.values(static_cast<int>(m), cosine, sine, p);
                for (std::size_t k = 0; k < kernel_count; ++k) {
                    const std::size_t count = degrees[k] > m ? degrees[k] - m : 0;
                    const Triple* from = &scaled[begin_of(m) * kernel_count + k];
                    Triple even, odd;
                    std::size_t l = first;
                    for (; l + 1 < count; l += 2) {
                        even.add(p[l], from[l * kernel_count]);
                        odd.add(p[l + 1], from[(l + 1) * kernel_count]);
                    }
                    if (l < count) even.add(p[l], from[l * kernel_count]);
                    north[k * orders + m] = sum_of(even, odd, 1.0);
                    south[k * orders + m] = sum_of(even, odd, -1.0);
                }
            }
            const std::size_t mirrored = rows - 1 - y;
            for (std::size_t k = 0; k < kernel_count; ++k) {
                for (std::size_t c = 0; c < 3; ++c) {
                    std::fill(line.begin(), line.end(), Complex(0.0));
                    add_line(&north[k * orders], c, 1.0);
                    add_line(&south[k * orders], c, Complex(0.0, 1.0));
                    transform.run(line);
                    float* to_north = pictures[k].pixel(0, static_cast<int>(y)) + c;
                    float* to_south = pictures[k].pixel(0, static_cast<int>(mirrored)) + c;
                    for (std::size_t x = 0; x < columns; ++x) {
                        to_north[3 * x] = static_cast<float>(line[x].real());
                        if (mirrored != y) to_south[3 * x] = static_cast<float>(line[x].imag());
                    }
                }
            }
        }
    });
    return pictures;
}

}  // namespace livery
