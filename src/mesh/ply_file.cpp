// read_ply: vertices, faces and strips, written as text or as bytes of either order.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"
#include "core/utf8.h"
#include "mesh/ply_header.h"
#include "mesh/scan_file.h"
#include "mesh/text_cursor.h"

namespace livery {

namespace {

/// What a vertex is made of; `unread` takes all the rest.
enum Slot : std::size_t { x, y, z, nx, ny, nz, u, v, unread, slot_count };

Slot slot_of(const PlyProperty& property) {
    struct Named {
        std::string_view name;
        Slot slot;
    };
    constexpr std::array names{Named{"x", x},
                               Named{"y", y},
                               Named{"z", z},
                               Named{"nx", nx},
                               Named{"ny", ny},
                               Named{"nz", nz},
                               Named{"u", u},
                               Named{"s", u},
                               Named{"texture_u", u},
                               Named{"v", v},
                               Named{"t", v},
                               Named{"texture_v", v}};
    if (property.is_list) return unread;
    for (const Named& named : names) {
        if (property.name == named.name) return named.slot;
    }
    return unread;
}

/// Numbers as words, a line an element.
class TextSource {
  public:
    TextSource(const PlyHeader& header, const std::filesystem::path& file)
        : cursor_(header.body), first_line_(header.body_first_line), file_(file) {}

    void begin_row(const PlyElement&, std::size_t) {
        while (!cursor_.at_end() && cursor_.at_line_end()) cursor_.next_line();
    }
    void end_row() {
        if (!cursor_.at_line_end()) {
            fail("",
                 fmt::format("\"{}\" at its end", printable(cursor_.word(), 40)),
                 "no more numbers than the header says");
        }
    }
    double number(const PlyProperty& property, PlyType type) {
        const std::string_view word = cursor_.word();
        double value = 0.0;
        const bool is_number = read_number(word, value);
        if (!is_number || (is_whole(type) && value != std::floor(value))) {
            fail(property.name,
                 word.empty() ? "no more numbers" : fmt::format("\"{}\"", printable(word, 40)),
                 is_whole(type) ? "a whole number" : "a number");
        }
        return value;
    }
    /// Most numbers that can still come.
    std::size_t room(PlyType) const { return cursor_.rest().size() / 2 + 1; }
    [[noreturn]] void fail(const std::string& what, std::string found, std::string expected) const {
        const std::size_t line = first_line_ + cursor_.line() - 1;
        throw FileError(file_,
                        fmt::format("line {}{}{}", line, what.empty() ? "" : ": ", what),
                        std::move(found),
                        std::move(expected));
    }
    bool has_more() {
        while (!cursor_.at_end() && cursor_.at_line_end()) cursor_.next_line();
        return !cursor_.at_end();
    }

  private:
    TextCursor cursor_;
    std::size_t first_line_;
    const std::filesystem::path& file_;
};

template <typename T, bool swapped>
double load(const char* bytes) {
    std::array<char, sizeof(T)> own;
    std::memcpy(own.data(), bytes, sizeof(T));
    if constexpr (swapped) std::reverse(own.begin(), own.end());
    return static_cast<double>(std::bit_cast<T>(own));
}

/// Numbers as bytes; `swapped`: in the other order than this machine's.
template <bool swapped>
class BinarySource {
  public:
    BinarySource(const PlyHeader& header, const std::filesystem::path& file)
        : bytes_(header.body), file_(file) {}

    void begin_row(const PlyElement& element, std::size_t row) {
        element_ = &element;
        row_ = row;
    }
    void end_row() {}
    double number(const PlyProperty& property, PlyType type) {
        const std::size_t size = size_of(type);
        if (size > bytes_.size()) {
            fail(property.name, "the file's end", fmt::format("{} more bytes", size));
        }
        const char* const at = bytes_.data();
        bytes_.remove_prefix(size);
        switch (type) {
            case PlyType::int8:
                return load<std::int8_t, swapped>(at);
            case PlyType::uint8:
                return load<std::uint8_t, swapped>(at);
            case PlyType::int16:
                return load<std::int16_t, swapped>(at);
            case PlyType::uint16:
                return load<std::uint16_t, swapped>(at);
            case PlyType::int32:
                return load<std::int32_t, swapped>(at);
            case PlyType::uint32:
                return load<std::uint32_t, swapped>(at);
            case PlyType::float32:
                return load<float, swapped>(at);
            default:
                return load<double, swapped>(at);
        }
    }
    std::size_t room(PlyType type) const { return bytes_.size() / size_of(type); }
    [[noreturn]] void fail(const std::string& what, std::string found, std::string expected) const {
        throw FileError(
            file_,
            fmt::format("{} {}{}{}", element_->name, row_, what.empty() ? "" : ": ", what),
            std::move(found),
            std::move(expected));
    }
    bool has_more() const { return !bytes_.empty(); }

  private:
    std::string_view bytes_;
    const std::filesystem::path& file_;
    const PlyElement* element_ = nullptr;
    std::size_t row_ = 0;
};

/// A list's length, checked against what is left.
template <typename Source>
std::size_t list_length(Source& source, const PlyProperty& property) {
    const double length = source.number(property, property.count_type);
    const auto room = static_cast<double>(source.room(property.type));
    if (!(length >= 0.0 && length <= room)) {
        source.fail(property.name,
                    fmt::format("a list of {:.0f}", length),
                    fmt::format("at most the {:.0f} that can follow", room));
    }
    return static_cast<std::size_t>(length);
}

template <typename Source>
void skip(Source& source, const PlyProperty& property) {
    const std::size_t count = property.is_list ? list_length(source, property) : 1;
    for (std::size_t k = 0; k < count; ++k) source.number(property, property.type);
}

void note_unread(const PlyElement& element, const std::vector<bool>& read, ScanFile& scan) {
    std::string names;
    bool colours = false;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
        if (read[k]) continue;
        const std::string& name = element.properties[k].name;
        const bool is_colour = name == "red" || name == "green" || name == "blue" ||
                               name == "alpha" || name.starts_with("diffuse_") || name == "r" ||
                               name == "g" || name == "b";
        colours = colours || is_colour;
        if (!is_colour) names += (names.empty() ? "" : ", ") + name;
    }
    if (colours) scan.notes.push_back(fmt::format("{} colours are not read", element.name));
    if (!names.empty()) {
        scan.notes.push_back(
            fmt::format("{} properties that are not read: {}", element.name, names));
    }
}

template <typename Source>
void read_vertices(Source& source, const PlyElement& element, ScanFile& scan) {
    std::array<bool, slot_count> present{};
    std::vector<Slot> slots;
    for (const PlyProperty& property : element.properties) {
        // Of s, u and texture_u the first counts.
        const Slot slot = slot_of(property);
        slots.push_back(present[slot] ? unread : slot);
        present[slot] = true;
    }
    const bool has_normals = present[nx] && present[ny] && present[nz];
    const bool has_uvs = present[u] && present[v];
    std::vector<bool> read;
    for (const Slot slot : slots) {
        read.push_back(slot <= z || (slot <= nz && has_normals) ||
                       ((slot == u || slot == v) && has_uvs));
    }
    note_unread(element, read, scan);

    scan.positions.reserve(element.count);
    if (has_normals) scan.normals.reserve(element.count);
    if (has_uvs) scan.uvs.reserve(element.count);
    std::array<double, slot_count> values{};
    for (std::size_t row = 0; row < element.count; ++row) {
        source.begin_row(element, row);
        for (std::size_t k = 0; k < slots.size(); ++k) {
            const PlyProperty& property = element.properties[k];
            if (property.is_list) {
                skip(source, property);
            } else {
                values[slots[k]] = source.number(property, property.type);
            }
        }
        for (const Slot slot : {x, y, z}) {
            if (std::isfinite(values[slot])) continue;
            source.fail(std::string(1, "xyz"[slot]),
                        fmt::format("{} at vertex {}", values[slot], row),
                        "a finite number");
        }
        source.end_row();
        scan.positions.emplace_back(values[x], values[y], values[z]);
        if (has_normals) scan.normals.emplace_back(values[nx], values[ny], values[nz]);
        // PLY's v rises; ours falls.
        if (has_uvs) scan.uvs.emplace_back(values[u], 1.0 - values[v]);
    }
}

/// The list of corners that makes faces or strips; none when the element has no such list.
const PlyProperty* corners_of(const PlyElement& element, const std::filesystem::path& file) {
    for (const PlyProperty& property : element.properties) {
        if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
        if (property.is_list && is_whole(property.type)) return &property;
        throw FileError(file,
                        fmt::format("element {}", element.name),
                        fmt::format("\"{}\" that is no list of whole numbers", property.name),
                        "a list such as \"property list uchar int vertex_indices\"");
    }
    throw FileError(file,
                    fmt::format("element {}", element.name),
                    "no list \"vertex_indices\"",
                    "one, such as \"property list uchar int vertex_indices\"");
}

/// How many vertices the header promises; faces may come before them.
std::size_t vertex_count_of(const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
        if (element.name == "vertex") return element.count;
    }
    return 0;
}

ScanCorner corner_of(std::uint32_t vertex, const ScanFile& scan) {
    const auto if_any = [&](bool any) { return any ? vertex : ScanCorner::none; };
    return {vertex, if_any(!scan.normals.empty()), if_any(!scan.uvs.empty())};
}

/// The corners of all faces or strips, one list after the other; -1 (in strips) becomes `none`.
struct CornerLists {
    std::vector<std::uint32_t> corners;
    std::vector<std::size_t> ends;
};

template <typename Source>
CornerLists read_lists(Source& source,
                       const PlyElement& element,
                       std::size_t vertex_count,
                       const std::filesystem::path& file) {
    const bool strips = element.name == "tristrips";
    const PlyProperty* const wanted = corners_of(element, file);
    CornerLists lists;
    lists.ends.reserve(element.count);
    lists.corners.reserve(3 * element.count);
    for (std::size_t row = 0; row < element.count; ++row) {
        source.begin_row(element, row);
        for (const PlyProperty& property : element.properties) {
            if (&property != wanted) {
                skip(source, property);
                continue;
            }
            const std::size_t length = list_length(source, property);
            if (length > kMaxScanElements - lists.corners.size()) {
                source.fail(property.name,
                            fmt::format("{} more corners", length),
                            fmt::format("at most {} in the whole file", kMaxScanElements));
            }
            for (std::size_t k = 0; k < length; ++k) {
                const double index = source.number(property, property.type);
                if (strips && index == -1.0) {
                    lists.corners.push_back(ScanCorner::none);
                } else if (index >= 0.0 && index < static_cast<double>(vertex_count)) {
                    lists.corners.push_back(static_cast<std::uint32_t>(index));
                } else {
                    source.fail(property.name,
                                fmt::format("the vertex {:.0f}", index),
                                fmt::format("0 to {}", static_cast<double>(vertex_count) - 1.0));
                }
            }
        }
        source.end_row();
        lists.ends.push_back(lists.corners.size());
    }
    return lists;
}

void add_faces(const CornerLists& lists, const std::filesystem::path& file, ScanFile& scan) {
    std::vector<ScanCorner> polygon;
    std::size_t at = 0, dropped = 0;
    scan.triangles.reserve(scan.triangles.size() + lists.ends.size());
    for (std::size_t face = 0; face < lists.ends.size(); ++face) {
        polygon.clear();
        for (; at < lists.ends[face]; ++at) polygon.push_back(corner_of(lists.corners[at], scan));
        if (polygon.size() > kMaxPolygonCorners) {
            throw FileError(file,
                            fmt::format("face {}", face),
                            fmt::format("{} corners", polygon.size()),
                            fmt::format("at most {}", kMaxPolygonCorners));
        }
        if (polygon.size() < 3) ++dropped;
        if (!add_polygon(scan, polygon, 0)) refuse_polygons(file);
    }
    if (dropped > 0) {
        scan.notes.push_back(fmt::format("{} faces of fewer than three corners dropped", dropped));
    }
}

void add_strips(const CornerLists& lists, ScanFile& scan) {
    std::size_t at = 0;
    for (const std::size_t end : lists.ends) {
        std::size_t first = at;
        for (; at < end; ++at) {
            if (lists.corners[at] == ScanCorner::none) {
                first = at + 1;
            } else if (at >= first + 2) {
                // Every second triangle of a strip runs the other way.
                const std::size_t odd = (at - first) % 2;
                const auto corner = [&](std::size_t k) {
                    return corner_of(lists.corners[k], scan);
                };
                scan.triangles.push_back({corner(at - 2 + odd), corner(at - 1 - odd), corner(at)});
                scan.triangle_part.push_back(0);
            }
        }
    }
}

template <typename Source>
void read_body(Source source,
               const PlyHeader& header,
               const std::filesystem::path& file,
               ScanFile& scan) {
    const std::size_t vertex_count = vertex_count_of(header);
    CornerLists faces, strips;
    for (const PlyElement& element : header.elements) {
        if (element.name == "vertex") {
            read_vertices(source, element, scan);
        } else if (element.name == "face" || element.name == "tristrips") {
            if (element.count == 0) continue;
            std::vector<bool> read;
            for (const PlyProperty& property : element.properties) {
                read.push_back(&property == corners_of(element, file));
            }
            note_unread(element, read, scan);
            auto& lists = element.name == "face" ? faces : strips;
            lists = read_lists(source, element, vertex_count, file);
        } else {
            if (element.count > 0) {
                scan.notes.push_back(fmt::format("the element {} is not read", element.name));
            }
            if (element.properties.empty()) continue;
            for (std::size_t row = 0; row < element.count; ++row) {
                source.begin_row(element, row);
                for (const PlyProperty& property : element.properties) skip(source, property);
                source.end_row();
            }
        }
    }
    if (source.has_more()) scan.notes.emplace_back("what follows the last element is not read");
    add_faces(faces, file, scan);
    add_strips(strips, scan);
}

void check_elements(const PlyHeader& header, const std::filesystem::path& file) {
    const auto vertex = std::find_if(header.elements.begin(),
                                     header.elements.end(),
                                     [](const PlyElement& one) { return one.name == "vertex"; });
    if (vertex == header.elements.end()) {
        throw FileError(file, "header", "no element vertex", "one with x, y and z");
    }
    for (const PlyElement& element : header.elements) {
        if (element.count <= kMaxScanElements) continue;
        throw FileError(file,
                        fmt::format("element {}", element.name),
                        std::to_string(element.count),
                        fmt::format("at most {}", kMaxScanElements));
    }
    std::array<bool, slot_count> present{};
    for (const PlyProperty& property : vertex->properties) {
        present[slot_of(property)] = true;
    }
    for (const Slot slot : {x, y, z}) {
        if (present[slot]) continue;
        throw FileError(file,
                        "element vertex",
                        fmt::format("no property {}", "xyz"[slot]),
                        "x, y and z as single numbers");
    }
}

}  // namespace

ScanFile read_ply(std::string_view bytes, const std::filesystem::path& file) {
    const PlyHeader header = read_ply_header(bytes, file);
    check_elements(header, file);
    ScanFile scan;
    scan.parts.push_back({"scan", "", glm::dvec3(0.5)});
    constexpr bool little = std::endian::native == std::endian::little;
    if (header.encoding == PlyEncoding::ascii) {
        read_body(TextSource(header, file), header, file, scan);
    } else if ((header.encoding == PlyEncoding::little_endian) == little) {
        read_body(BinarySource<false>(header, file), header, file, scan);
    } else {
        read_body(BinarySource<true>(header, file), header, file, scan);
    }
    return scan;
}

}  // namespace livery
