// The three kinds of failure. "No answer" is std::optional or a mask and needs no type here.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace livery {

/// A bad file or device. The message is one line of UTF-8 that names the file, the field, what was
/// found and what was expected; what is long is cut off.
class FileError : public std::runtime_error {
  public:
    FileError(std::filesystem::path file,
              std::string field,
              std::string found,
              std::string expected);
    const std::filesystem::path& file() const { return file_; }
    const std::string& field() const { return field_; }
    const std::string& found() const { return found_; }
    const std::string& expected() const { return expected_; }

  private:
    std::filesystem::path file_;
    std::string field_, found_, expected_;
};

/// Ran, and the answer is "no" (a calibration refused, nothing decoded): why, and the fix.
class Refused : public std::runtime_error {
  public:
    Refused(std::string why, std::string fix);
    const std::string& why() const { return why_; }
    const std::string& fix() const { return fix_; }

  private:
    std::string why_, fix_;
};

/// The user stopped the work (Ctrl-C, the Cancel button).
class Cancelled : public std::runtime_error {
  public:
    Cancelled() : std::runtime_error("stopped") {}
};

/// Throws std::invalid_argument when a caller broke a function's contract; `what` holds the values.
inline void check_argument(bool ok, std::string_view what) {
    if (!ok) throw std::invalid_argument(std::string(what));
}

}  // namespace livery
