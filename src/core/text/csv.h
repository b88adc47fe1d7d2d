// Tables of numbers as comma-separated text, line by line, with errors that name the line and the
// column.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace livery {

/// Reads a header of column names, then one row a line. Empty lines and lines that start with # are
/// left out; blanks and quotation marks around a cell are not part of it. The text must outlive it.
class CsvReader {
  public:
    /// Throws FileError: no header, more than `max_columns` names, an empty or repeated name.
    CsvReader(std::string_view text, std::filesystem::path file, std::size_t max_columns = 1024);

    const std::vector<std::string>& names() const { return names_; }
    std::optional<std::size_t> find(std::string_view name) const;
    /// Throws FileError when there is no such column; `expected` says which there should be.
    std::size_t column(std::string_view name, std::string_view expected) const;

    /// The next row; false after the last. Throws FileError when it has not as many cells as the
    /// header.
    bool next();
    std::string_view text(std::size_t column) const { return cells_[column]; }
    /// A cell of the row as a finite number. Throws FileError.
    double number(std::size_t column) const;
    /// FileError about a cell of the row.
    [[noreturn]] void fail(std::size_t column, std::string_view expected) const;
    /// "line 12", for errors about the whole row.
    std::string place() const { return "line " + std::to_string(line_); }
    const std::filesystem::path& file() const { return file_; }

  private:
    bool next_line(std::string_view& line);
    void split(std::string_view line);

    std::string_view rest_;
    std::filesystem::path file_;
    std::size_t line_ = 0;
    std::vector<std::string> names_;
    std::vector<std::string_view> cells_;
};

}  // namespace livery
