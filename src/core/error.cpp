#include "core/error.h"

#include "core/utf8.h"

namespace livery {

namespace {

std::string file_message(const std::filesystem::path& file,
                         const std::string& field,
                         const std::string& found,
                         const std::string& expected) {
    // What stands in a bad file gets into messages: in one line, and not all of it.
    constexpr std::size_t longest = 600;
    std::string text = printable(file.string(), longest);
    if (!field.empty()) text += ": " + printable(field, longest);
    text += ": found " + printable(found, longest) + ", expected " + printable(expected, longest);
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
