#include "core/text/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace livery {

namespace {

constexpr std::size_t kLongestQuote = 40;

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r\"");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::string quoted(std::string_view cell) {
    return "'" + std::string(cell.substr(0, kLongestQuote)) + "'";
}

}  // namespace

CsvReader::CsvReader(std::string_view text, std::filesystem::path file, std::size_t max_columns)
    : rest_(text), file_(std::move(file)) {
    // Spreadsheets put a byte order mark first.
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    std::string_view header;
    if (!next_line(header)) throw FileError(file_, "", "nothing", "a header and rows of numbers");
    split(header);
    if (cells_.size() > max_columns) {
        throw FileError(file_,
                        place(),
                        std::to_string(cells_.size()) + " columns",
                        "at most " + std::to_string(max_columns));
    }
    for (const std::string_view cell : cells_) {
        if (cell.empty() || find(cell)) {
            throw FileError(file_,
                            place() + ", column " + std::to_string(names_.size() + 1),
                            cell.empty() ? "no name" : quoted(cell) + " a second time",
                            "a name for each column");
        }
        names_.emplace_back(cell);
    }
}

std::optional<std::size_t> CsvReader::find(std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names_.begin());
}

std::size_t CsvReader::column(std::string_view name, std::string_view expected) const {
    if (const auto found = find(name)) return *found;
    throw FileError(
        file_, "header", "no column '" + std::string(name) + "'", std::string(expected));
}

bool CsvReader::next() {
    std::string_view line;
    if (!next_line(line)) return false;
    split(line);
    if (cells_.size() != names_.size()) {
        throw FileError(file_,
                        place(),
                        std::to_string(cells_.size()) + (cells_.size() == 1 ? " cell" : " cells"),
                        std::to_string(names_.size()) + ", as in the header");
    }
    return true;
}

double CsvReader::number(std::size_t column) const {
    const std::string_view cell = cells_[column];
    double value = 0.0;
    const auto [stop, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc{} || stop != cell.data() + cell.size() || !std::isfinite(value)) {
        fail(column, "a finite number");
    }
    return value;
}

void CsvReader::fail(std::size_t column, std::string_view expected) const {
    throw FileError(file_,
                    place() + ", " + names_[column].substr(0, kLongestQuote),
                    quoted(cells_[column]),
                    std::string(expected));
}

bool CsvReader::next_line(std::string_view& line) {
    while (!rest_.empty()) {
        const auto end = rest_.find('\n');
        line = trimmed(rest_.substr(0, end));
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        ++line_;
        if (!line.empty() && line.front() != '#') return true;
    }
    return false;
}

void CsvReader::split(std::string_view line) {
    cells_.clear();
    while (true) {
        const auto comma = line.find(',');
        cells_.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return;
        line.remove_prefix(comma + 1);
    }
}

}  // namespace livery
