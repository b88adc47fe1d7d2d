#include "core/error.h"

namespace livery {

namespace {

std::string file_message(const std::filesystem::path& file,
                         const std::string& field,
                         const std::string& found,
                         const std::string& expected) {
    std::string text = file.string();
    if (!field.empty()) text += ": " + field;
    text += ": found " + found + ", expected " + expected;
    return text;
}

}  // namespace

FileError::FileError(std::filesystem::path file,
                     std::string field,
                     std::string found,
                     std::string expected)
    : std::runtime_error(file_message(file, field, found, expected)),
      file_(std::move(file)),
      field_(std::move(field)),
      found_(std::move(found)),
      expected_(std::move(expected)) {}

Refused::Refused(std::string why, std::string fix)
    : std::runtime_error(why + "; " + fix), why_(std::move(why)), fix_(std::move(fix)) {}

}  // namespace livery
