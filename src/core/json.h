// Reading JSON with errors that name the file and the field. Include only in *_io.cpp and cli/:
// the library behind it costs seconds a file to compile.
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

namespace livery {

using Json = nlohmann::ordered_json;

/// Parses a file. Throws FileError (missing, empty, malformed with line and column, over
/// `max_bytes`, not an object).
Json read_json_file(const std::filesystem::path& file, std::size_t max_bytes = 64u << 20u);

/// The same for a text that came from elsewhere; `origin` stands in messages where a file would.
Json parse_json(const std::string& text, const std::filesystem::path& origin);

/// Writes atomically: to a temporary file beside it, then renames. Throws FileError.
void write_json_file(const std::filesystem::path& file, const Json& json);

/// A place in a parsed file. Every accessor throws FileError that names the full field path
/// ("lights[2].radiance"), what was found and what was expected. Non-owning.
class JsonReader {
  public:
    JsonReader(std::filesystem::path file, const Json& value, std::string field = "");

    bool has(std::string_view key) const;
    JsonReader operator[](std::string_view key) const;  ///< an object's member; must exist
    JsonReader at(std::size_t index) const;             ///< an array's element; must exist
    std::size_t size() const;                           ///< of an array; throws for anything else
    std::vector<std::string> keys() const;              ///< of an object

    bool is_object() const { return value_->is_object(); }
    bool is_array() const { return value_->is_array(); }
    bool is_text() const { return value_->is_string(); }
    bool is_number() const { return value_->is_number(); }

    double number() const;  ///< finite
    double number_between(double low, double high) const;
    int integer(int low, int high) const;
    bool boolean() const;
    std::string text() const;
    /// Which of these texts it is; throws with all of them for any other.
    std::size_t one_of(std::initializer_list<std::string_view> texts) const;
    std::vector<double> numbers(std::size_t count) const;  ///< exactly `count`, all finite
    glm::dvec3 vec3() const;
    glm::dmat3 matrix3() const;  ///< nine numbers, row by row

    /// Refuses members not in the list, so that a misspelt option is never ignored.
    void allow_only(std::initializer_list<std::string_view> allowed,
                    std::initializer_list<std::string_view> and_these = {}) const;
    /// Refuses a missing, wrong or newer "format_version", by name.
    void require_format_version(int newest_known) const;

    [[noreturn]] void fail(std::string found, std::string expected) const;
    std::string found() const;  ///< this value in a few words, for messages
    const std::filesystem::path& file() const { return file_; }
    const std::string& field() const { return field_; }

  private:
    std::filesystem::path file_;
    const Json* value_;
    std::string field_;
};

/// Nine numbers, row by row, and three numbers.
Json json_from(const glm::dmat3& matrix);
Json json_from(const glm::dvec3& vector);

/// Places and sizes end here: a thousand kilometres, in which float still tells a tenth of a metre.
inline constexpr double kFarthest_mm = 1e9;
/// Directions, of any length but none.
inline constexpr double kLongestDirection = 1e6;

/// Exactly `count` numbers between the two. Throws FileError that names the element.
inline std::vector<double> numbers_between(const JsonReader& list,
                                           std::size_t count,
                                           double low,
                                           double high) {
    if (!list.is_array() || list.size() != count) return list.numbers(count);  // says so
    std::vector<double> values(count);
    for (std::size_t k = 0; k < count; ++k) values[k] = list.at(k).number_between(low, high);
    return values;
}

/// A vector of which no component is larger in size.
inline glm::dvec3 vec3_within(const JsonReader& list, double largest) {
    const auto values = numbers_between(list, 3, -largest, largest);
    return {values[0], values[1], values[2]};
}

/// A place in the world, mm.
inline glm::dvec3 place_mm(const JsonReader& list) { return vec3_within(list, kFarthest_mm); }

}  // namespace livery
