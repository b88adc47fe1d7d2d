#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>

#include <fmt/format.h>
#include <glm/mat3x3.hpp>

#include "appearance/measured/measured_samples.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/text/csv.h"

namespace livery {

namespace {

constexpr std::size_t kLargestFile_bytes = std::size_t{256} << 20u;
constexpr std::size_t kMaxWavelengths = 512;
constexpr std::size_t kFewestSamples = 8;
constexpr double kHorizon = 0.5 * std::numbers::pi + 1e-4;  ///< files round to few digits

/// Numbers of a text one after the other, past comments, with the line that each stands on.
class NumberStream {
  public:
    NumberStream(std::string_view text, const std::filesystem::path& file)
        : rest_(text), file_(file) {}

    bool at_end() {
        skip();
        return rest_.empty();
    }
    double next(const std::string& what, const char* expected) {
        if (at_end()) throw FileError(file_, place(), "the end of the file", what);
        const auto word = rest_.substr(0, rest_.find_first_of(" \t\r\n,"));
        double value = 0.0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} || stop != word.data() + word.size() || !std::isfinite(value)) {
            throw FileError(file_,
                            place() + ": " + what,
                            "'" + std::string(word.substr(0, 40)) + "'",
                            expected);
        }
        rest_.remove_prefix(word.size());
        return value;
    }
    std::string place() const { return "line " + std::to_string(line_); }

  private:
    void skip() {
        while (!rest_.empty()) {
            const char c = rest_.front();
            if (c == '#') {
                rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
            } else if (c == '\n' || c == ' ' || c == '\t' || c == '\r' || c == ',') {
                if (c == '\n') ++line_;
                rest_.remove_prefix(1);
            } else {
                return;
            }
        }
    }

    std::string_view rest_;
    const std::filesystem::path& file_;
    std::size_t line_ = 1;
};

bool below_horizon(double theta_rad) { return theta_rad < 0.0 || theta_rad > kHorizon; }

constexpr const char* kAngle = "an angle to the normal from 0 to pi/2, in radians";
constexpr const char* kValue = "a reflectance per steradian of at most 1e9";

}  // namespace

void check_samples(const MeasuredSamples& samples, const std::filesystem::path& file) {
    if (samples.pairs.size() >= kFewestSamples) return;
    throw FileError(
        file,
        "",
        fmt::format("{} usable samples ({} negative)", samples.pairs.size(), samples.masked),
        fmt::format("{} or more", kFewestSamples));
}

void check_wavelengths(std::span<const double> wavelengths,
                       const std::filesystem::path& file,
                       const std::string& field) {
    for (std::size_t k = 1; k < wavelengths.size(); ++k) {
        if (wavelengths[k] > wavelengths[k - 1]) continue;
        throw FileError(file,
                        field,
                        fmt::format("{} nm after {} nm", wavelengths[k], wavelengths[k - 1]),
                        "rising wavelengths");
    }
    if (wavelengths.size() < 2 || wavelengths.front() > 400.0 || wavelengths.back() < 700.0) {
        throw FileError(file,
                        field,
                        wavelengths.empty()
                            ? "none"
                            : fmt::format("{} to {} nm", wavelengths.front(), wavelengths.back()),
                        "400 to 700 nm at least");
    }
}

MeasuredSamples read_spectral_samples(const std::filesystem::path& file) {
    return parse_spectral_samples(read_text_file(file, kLargestFile_bytes), file);
}

MeasuredSamples parse_spectral_samples(const std::string& text, const std::filesystem::path& file) {
    NumberStream numbers(text, file);
    const double count = numbers.next("the number of wavelengths", "a whole number");
    if (count != std::floor(count) || count < 2.0 || count > double{kMaxWavelengths}) {
        throw FileError(file,
                        numbers.place() + ": the number of wavelengths",
                        fmt::format("{}", count),
                        fmt::format("a whole number from 2 to {}", kMaxWavelengths));
    }
    MeasuredSamples samples;
    for (int k = 0; k < static_cast<int>(count); ++k) {
        samples.wavelengths_nm.push_back(numbers.next("wavelengths", "a wavelength in nm"));
    }
    check_wavelengths(samples.wavelengths_nm, file, numbers.place() + ": wavelengths");
    std::vector<double> row(samples.wavelengths_nm.size());
    while (!numbers.at_end()) {
        const auto angle = [&](const char* name, bool polar) {
            const double value = numbers.next(name, "a finite number");
            if (polar && below_horizon(value)) {
                throw FileError(
                    file, numbers.place() + ": " + name, fmt::format("{}", value), kAngle);
            }
            return value;
        };
        const double theta_i = angle("theta_i", true);
        const double phi_i = angle("phi_i", false);
        const double theta_o = angle("theta_o", true);
        const double phi_o = angle("phi_o", false);
        bool negative = false;
        for (std::size_t k = 0; k < row.size(); ++k) {
            const std::string name = fmt::format("the value at {} nm", samples.wavelengths_nm[k]);
            row[k] = numbers.next(name, "a finite number");
            if (row[k] > kLargestReflectance) {
                throw FileError(
                    file, numbers.place() + ": " + name, fmt::format("{}", row[k]), kValue);
            }
            negative = negative || row[k] < 0.0;
        }
        if (negative) {
            ++samples.masked;
            continue;
        }
        samples.pairs.push_back(
            {direction_from_angles(theta_i, phi_i), direction_from_angles(theta_o, phi_o)});
        samples.values.insert(samples.values.end(), row.begin(), row.end());
    }
    check_samples(samples, file);
    return samples;
}

std::string measured_csv(std::span<const DirectionPair> pairs,
                         std::span<const glm::dvec3> values_rec709,
                         std::span<const std::string> comments) {
    check_argument(
        pairs.size() == values_rec709.size(),
        fmt::format("measured_csv: {} values for {} pairs", values_rec709.size(), pairs.size()));
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    for (const std::string& comment : comments) fmt::format_to(out, "# {}\n", comment);
    fmt::format_to(out, "theta_i,phi_i,theta_o,phi_o,r,g,b\n");
    const auto angles = [](const glm::dvec3& w) {
        return fmt::format(
            "{:.6f},{:.6f}", std::atan2(std::hypot(w.x, w.y), w.z), std::atan2(w.y, w.x));
    };
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const glm::dvec3& value = values_rec709[k];
        fmt::format_to(out,
                       "{},{},{:.6g},{:.6g},{:.6g}\n",
                       angles(pairs[k].wi),
                       angles(pairs[k].wo),
                       value.x,
                       value.y,
                       value.z);
    }
    return {text.data(), text.size()};
}

MeasuredSamples read_measured_csv(const std::filesystem::path& file) {
    return parse_measured_csv(read_text_file(file, kLargestFile_bytes), file);
}

MeasuredSamples parse_measured_csv(const std::string& text, const std::filesystem::path& file) {
    constexpr const char* kColumns =
        "theta_i, phi_i, theta_o, phi_o and r, g, b or wavelengths in nm";
    CsvReader csv(text, file, kMaxWavelengths + 4);
    const std::size_t theta_i = csv.column("theta_i", kColumns);
    const std::size_t phi_i = csv.column("phi_i", kColumns);
    const std::size_t theta_o = csv.column("theta_o", kColumns);
    const std::size_t phi_o = csv.column("phi_o", kColumns);
    MeasuredSamples samples;
    std::vector<std::size_t> columns;
    const bool colours = csv.find("r") || csv.find("g") || csv.find("b");
    if (colours) {
        for (const char* name : {"r", "g", "b"}) columns.push_back(csv.column(name, kColumns));
    }
    for (std::size_t c = 0; c < csv.names().size(); ++c) {
        if (c == theta_i || c == phi_i || c == theta_o || c == phi_o) continue;
        if (std::find(columns.begin(), columns.end(), c) != columns.end()) continue;
        std::string_view name = csv.names()[c];
        if (name.ends_with("nm")) name.remove_suffix(2);
        while (name.ends_with(' ')) name.remove_suffix(1);
        double nm = 0.0;
        const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), nm);
        if (colours || error != std::errc{} || stop != name.data() + name.size() ||
            !std::isfinite(nm)) {
            throw FileError(
                file, "header", "a column '" + csv.names()[c].substr(0, 40) + "'", kColumns);
        }
        columns.push_back(c);
        samples.wavelengths_nm.push_back(nm);
    }
    if (!colours) check_wavelengths(samples.wavelengths_nm, file, "header: wavelengths");
    std::vector<double> row(columns.size());
    while (csv.next()) {
        for (const std::size_t polar : {theta_i, theta_o}) {
            if (below_horizon(csv.number(polar))) csv.fail(polar, kAngle);
        }
        for (std::size_t k = 0; k < columns.size(); ++k) {
            row[k] = csv.number(columns[k]);
            if (std::abs(row[k]) > kLargestReflectance) csv.fail(columns[k], kValue);
        }
        if (colours) {
            // A negative channel of Rec.709 is only a saturated colour; a negative X, Y or Z is no
            // light at all.
            const glm::dvec3 xyz = xyz_from_rec709() * glm::dvec3(row[0], row[1], row[2]);
            for (int c = 0; c < 3; ++c) row[static_cast<std::size_t>(c)] = xyz[c];
            const double rounding = 1e-4 * *std::max_element(row.begin(), row.end());
            for (double& value : row) {
                if (value < 0.0 && value >= -rounding) value = 0.0;
            }
        }
        if (*std::min_element(row.begin(), row.end()) < 0.0) {
            ++samples.masked;
            continue;
        }
        samples.pairs.push_back({direction_from_angles(csv.number(theta_i), csv.number(phi_i)),
                                 direction_from_angles(csv.number(theta_o), csv.number(phi_o))});
        samples.values.insert(samples.values.end(), row.begin(), row.end());
    }
    check_samples(samples, file);
    return samples;
}

}  // namespace livery
