#include "mesh/ply_header.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/utf8.h"
#include "mesh/text_cursor.h"

namespace livery {

namespace {

struct TypeName {
    std::string_view name, other_name;
    PlyType type;
    std::size_t bytes;
};
constexpr std::array kTypes{TypeName{"char", "int8", PlyType::int8, 1},
                            TypeName{"uchar", "uint8", PlyType::uint8, 1},
                            TypeName{"short", "int16", PlyType::int16, 2},
                            TypeName{"ushort", "uint16", PlyType::uint16, 2},
                            TypeName{"int", "int32", PlyType::int32, 4},
                            TypeName{"uint", "uint32", PlyType::uint32, 4},
                            TypeName{"float", "float32", PlyType::float32, 4},
                            TypeName{"double", "float64", PlyType::float64, 8}};

/// Reads one line of the header after the other, and says what is wrong with it.
class HeaderReader {
  public:
    HeaderReader(std::string_view bytes, const std::filesystem::path& file)
        : cursor_(bytes), file_(file) {}

    PlyHeader read();

  private:
    [[noreturn]] void fail(std::string_view found, std::string expected) const {
        throw FileError(file_,
                        fmt::format("header, line {}", cursor_.line()),
                        found.empty() ? "nothing" : fmt::format("\"{}\"", printable(found, 40)),
                        std::move(expected));
    }
    PlyType type() {
        const std::string_view word = cursor_.word();
        for (const TypeName& one : kTypes) {
            if (word == one.name || word == one.other_name) return one.type;
        }
        fail(word, "a type: char, uchar, short, ushort, int, uint, float or double");
    }
    std::string name(const char* expected) {
        const std::string_view word = cursor_.word();
        if (word.empty()) fail(word, expected);
        return printable(word, 40);
    }
    void read_format(PlyHeader& header);
    void read_element(PlyHeader& header);
    void read_property(PlyHeader& header);

    TextCursor cursor_;
    const std::filesystem::path& file_;
};

void HeaderReader::read_format(PlyHeader& header) {
    const std::string_view encoding = cursor_.word();
    if (encoding == "ascii") {
        header.encoding = PlyEncoding::ascii;
    } else if (encoding == "binary_little_endian") {
        header.encoding = PlyEncoding::little_endian;
    } else if (encoding == "binary_big_endian") {
        header.encoding = PlyEncoding::big_endian;
    } else {
        fail(encoding, "ascii, binary_little_endian or binary_big_endian");
    }
    const std::string_view version = cursor_.word();
    if (version != "1.0") fail(version, "version 1.0, the only one there is");
}

void HeaderReader::read_element(PlyHeader& header) {
    PlyElement element;
    element.name = name("an element's name");
    const std::string_view word = cursor_.word();
    std::uint64_t count = 0;
    if (!read_number(word, count)) fail(word, "how many of it there are");
    element.count = count;
    for (const PlyElement& other : header.elements) {
        if (other.name == element.name) fail(element.name, "each element once");
    }
    header.elements.push_back(std::move(element));
}

void HeaderReader::read_property(PlyHeader& header) {
    if (header.elements.empty()) fail("property", "an element before its properties");
    PlyElement& element = header.elements.back();
    PlyProperty property;
    TextCursor ahead = cursor_;
    property.is_list = ahead.word() == "list";
    if (property.is_list) {
        cursor_ = ahead;
        property.count_type = type();
        if (!is_whole(property.count_type)) fail("list of float", "a whole number as its length");
    }
    property.type = type();
    property.name = name("a property's name");
    for (const PlyProperty& other : element.properties) {
        if (other.name == property.name) fail(property.name, "each property once");
    }
    element.properties.push_back(std::move(property));
}

PlyHeader HeaderReader::read() {
    PlyHeader header;
    bool has_format = false;
    cursor_.next_line();
    while (true) {
        if (cursor_.at_end()) fail("", "end_header");
        const std::string_view keyword = cursor_.word();
        if (keyword == "end_header") break;
        if (keyword == "format") {
            read_format(header);
            has_format = true;
        } else if (keyword == "element") {
            read_element(header);
        } else if (keyword == "property") {
            read_property(header);
        } else if (keyword == "comment" || keyword == "obj_info") {
            cursor_.rest_of_line();
        } else if (!keyword.empty()) {
            fail(keyword, "format, element, property, comment or end_header");
        }
        if (!cursor_.at_line_end()) fail(cursor_.word(), "the end of the line");
        cursor_.next_line();
    }
    if (!has_format) throw FileError(file_, "header", "no format", "\"format ascii 1.0\" or so");
    if (!cursor_.at_line_end()) fail(cursor_.word(), "the end of the line");
    cursor_.next_line();
    header.body = cursor_.rest();
    header.body_first_line = cursor_.line();
    return header;
}

/// The fewest bytes that one of it takes: a digit and a blank a number, empty lists.
std::size_t least_size(const PlyElement& element, PlyEncoding encoding) {
    std::size_t size = 0;
    for (const PlyProperty& property : element.properties) {
        if (encoding == PlyEncoding::ascii) {
            size += 2;
        } else {
            size += size_of(property.is_list ? property.count_type : property.type);
        }
    }
    return size;
}

}  // namespace

bool is_whole(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

std::size_t size_of(PlyType type) { return kTypes[static_cast<std::size_t>(type)].bytes; }

PlyHeader read_ply_header(std::string_view bytes, const std::filesystem::path& file) {
    PlyHeader header = HeaderReader(bytes, file).read();
    std::size_t left = header.body.size();
    // The last number of a text needs no blank behind it.
    if (header.encoding == PlyEncoding::ascii) ++left;
    for (const PlyElement& element : header.elements) {
        const std::size_t size = least_size(element, header.encoding);
        if (size == 0) continue;
        if (element.count > left / size) {
            throw FileError(file,
                            fmt::format("element {}", element.name),
                            fmt::format("{} declared in {} bytes", element.count, left),
                            fmt::format("at most {} (is the file cut off?)", left / size));
        }
        left -= element.count * size;
    }
    return header;
}

}  // namespace livery
