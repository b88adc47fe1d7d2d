#include "core/json.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "core/paths.h"
#include "core/utf8.h"

namespace livery {

namespace {

/// "line 3, column 7" of a byte offset.
std::string place_in(const std::string& text, std::size_t byte) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
    const auto line = std::count(text.begin(), end, '\n') + 1;
    const auto last_break = std::find(std::make_reverse_iterator(end), text.rend(), '\n');
    const auto column = last_break - std::make_reverse_iterator(end);
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// Numbers in files are at most this in size where nothing narrower is said, so that squares and
/// products of a few of them stay finite in double.
constexpr double kLargest = 1e12;

/// What reading would have to build, found before anything of it is built.
struct JsonExtent {
    std::size_t depth =
        0;  ///< brackets open at the deepest place; whoever prints recurses this far
    std::size_t values = 1;  ///< at most
};

JsonExtent extent_of(const std::string& text) {
    JsonExtent extent;
    std::size_t depth = 0;
    bool in_text = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if (in_text) {
            if (c == '\\') {
                ++k;
            } else if (c == '"') {
                in_text = false;
            }
        } else if (c == '"') {
            in_text = true;
        } else if (c == ',') {
            ++extent.values;
        } else if (c == '[' || c == '{') {
            ++extent.values;
            extent.depth = std::max(extent.depth, ++depth);
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
    return extent;
}

/// Where a number stands that no double can hold; the parser names it, but not its place.
std::string place_of_number(const std::string& text, const std::string& number) {
    const auto at = text.find(number);
    return at == std::string::npos ? "" : place_in(text, at + 1);
}

/// "1e999" of "... number overflow parsing '1e999'".
std::string quoted_in(const std::string& message) {
    const auto first = message.find('\''), last = message.rfind('\'');
    return first < last ? message.substr(first + 1, last - first - 1) : message;
}

}  // namespace

Json parse_json(const std::string& text, const std::filesystem::path& file) {
    if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
        throw FileError(file, "", "an empty file", "a JSON object");
    }
    constexpr std::size_t max_depth = 200, max_values = 4'000'000;
    const JsonExtent extent = extent_of(text);
    if (extent.depth > max_depth) {
        throw FileError(file,
                        "",
                        std::to_string(extent.depth) + " brackets inside one another",
                        "at most " + std::to_string(max_depth));
    }
    if (extent.values > max_values) {
        throw FileError(file,
                        "",
                        std::to_string(extent.values) + " values",
                        "at most " + std::to_string(max_values));
    }
    try {
        Json json = Json::parse(text);
        if (!json.is_object()) throw FileError(file, "", json.type_name(), "a JSON object");
        return json;
    } catch (const nlohmann::json::parse_error& error) {
        throw FileError(
            file, place_in(text, error.byte), "text that is not JSON", "a complete JSON object");
    } catch (const nlohmann::json::out_of_range& error) {
        const std::string number = quoted_in(error.what());
        throw FileError(file,
                        place_of_number(text, number),
                        "the number " + printable(number, 40),
                        "numbers that a double can hold, up to 1.8e308");
    } catch (const nlohmann::json::exception& error) {
        throw FileError(file, "", error.what(), "a JSON object");
    }
}

Json read_json_file(const std::filesystem::path& file, std::size_t max_bytes) {
    return parse_json(read_text_file(file, max_bytes), file);
}

void write_json_file(const std::filesystem::path& file, const Json& json) {
    write_text_file(file, json.dump(2) + "\n");
}

JsonReader::JsonReader(std::filesystem::path file, const Json& value, std::string field)
    : file_(std::move(file)), value_(&value), field_(std::move(field)) {}

bool JsonReader::has(std::string_view key) const {
    return value_->is_object() && value_->contains(key);
}

JsonReader JsonReader::operator[](std::string_view key) const {
    if (!value_->is_object()) fail(found(), "an object");
    const std::string name = field_.empty() ? std::string(key) : field_ + "." + std::string(key);
    const auto member = value_->find(key);
    if (member == value_->end()) throw FileError(file_, name, "nothing", "this field");
    return {file_, *member, name};
}

JsonReader JsonReader::at(std::size_t index) const {
    if (index >= size()) {
        fail(std::to_string(size()) + " elements", "at least " + std::to_string(index + 1));
    }
    return {file_, (*value_)[index], field_ + "[" + std::to_string(index) + "]"};
}

std::size_t JsonReader::size() const {
    if (!value_->is_array()) fail(found(), "an array");
    return value_->size();
}

std::vector<std::string> JsonReader::keys() const {
    if (!value_->is_object()) fail(found(), "an object");
    std::vector<std::string> names;
    for (const auto& [key, member] : value_->items()) names.push_back(key);
    return names;
}

double JsonReader::number() const { return number_between(-kLargest, kLargest); }

double JsonReader::number_between(double low, double high) const {
    if (!value_->is_number()) fail(found(), "a number");
    const double value = value_->get<double>();
    if (!(value >= low && value <= high)) {
        std::ostringstream expected;
        expected << "a number between " << low << " and " << high;
        fail(found(), expected.str());
    }
    return value;
}

int JsonReader::integer(int low, int high) const {
    if (!value_->is_number()) fail(found(), "a number");
    const auto value = value_->get<double>();
    if (value != std::floor(value) || value < low || value > high) {
        fail(found(),
             "a whole number between " + std::to_string(low) + " and " + std::to_string(high));
    }
    return static_cast<int>(value);
}

bool JsonReader::boolean() const {
    if (!value_->is_boolean()) fail(found(), "true or false");
    return value_->get<bool>();
}

std::string JsonReader::text() const {
    if (!value_->is_string()) fail(found(), "a text");
    return value_->get<std::string>();
}

std::size_t JsonReader::one_of(std::initializer_list<std::string_view> texts) const {
    const std::string given = text();
    std::string expected;
    for (const std::string_view& known : texts) {
        const auto index = static_cast<std::size_t>(&known - texts.begin());
        if (known == given) return index;
        if (index > 0) expected += index + 1 == texts.size() ? " or " : ", ";
        expected += known;
    }
    fail(found(), expected);
}

std::vector<double> JsonReader::numbers(std::size_t count) const {
    if (!value_->is_array() || value_->size() != count) {
        fail(value_->is_array() ? std::to_string(value_->size()) + " elements" : found(),
             std::to_string(count) + " numbers");
    }
    std::vector<double> values(count);
    for (std::size_t k = 0; k < count; ++k) values[k] = at(k).number();
    return values;
}

glm::dvec3 JsonReader::vec3() const {
    const auto v = numbers(3);
    return {v[0], v[1], v[2]};
}

glm::dmat3 JsonReader::matrix3() const {
    const auto v = numbers(9);
    return {v[0], v[3], v[6], v[1], v[4], v[7], v[2], v[5], v[8]};
}

void JsonReader::allow_only(std::initializer_list<std::string_view> allowed,
                            std::initializer_list<std::string_view> and_these) const {
    std::vector<std::string_view> all(allowed);
    all.insert(all.end(), and_these);
    for (const auto& key : keys()) {
        if (std::find(all.begin(), all.end(), key) != all.end()) continue;
        std::string names;
        for (const auto& name : all) names += (names.empty() ? "" : ", ") + std::string(name);
        fail("the unknown field \"" + key + "\"", "only " + names);
    }
}

void JsonReader::require_format_version(int newest_known) const {
    const auto version = (*this)["format_version"];
    const double value = version.number();
    if (value > newest_known) {
        version.fail(version.found() + " (written by a newer Livery)",
                     "at most " + std::to_string(newest_known));
    }
    version.integer(1, newest_known);
}

void JsonReader::fail(std::string found, std::string expected) const {
    throw FileError(file_, field_, std::move(found), std::move(expected));
}

std::string JsonReader::found() const {
    std::string text = value_->dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > 40) text = text.substr(0, 37) + "...";
    return text;
}

Json json_from(const glm::dmat3& matrix) {
    Json json = Json::array();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) json.push_back(matrix[column][row]);
    }
    return json;
}

Json json_from(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

}  // namespace livery
