// read_obj: polygons of Wavefront OBJ, a part for each object and material.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/paths.h"
#include "core/utf8.h"
#include "mesh/beside.h"
#include "mesh/obj_materials.h"
#include "mesh/scan_file.h"
#include "mesh/text_cursor.h"

namespace livery {

namespace {

constexpr std::size_t kMaxLibraryBytes = 16u << 20u;

/// What a part is called after; empty: the file did not say.
struct PartKey {
    std::string object, group, material;
    auto operator<=>(const PartKey&) const = default;
};

/// A list's length so far, and the largest index that faces used before it was there.
struct Reach {
    std::size_t largest = 0, line = 0;
    void use(std::size_t index, std::size_t at_line) {
        if (index > largest) largest = index, line = at_line;
    }
};

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::filesystem::path& file)
        : cursor_(text), file_(file) {
        cursor_.joins_lines = true;
        cursor_.comments_begin_with = '#';
    }
    ScanFile read();

  private:
    [[noreturn]] void fail(std::size_t line,
                           std::string_view what,
                           std::string found,
                           std::string expected) const {
        throw FileError(
            file_, fmt::format("line {}: {}", line, what), std::move(found), std::move(expected));
    }
    static std::string quoted(std::string_view word) {
        return word.empty() ? "nothing" : fmt::format("\"{}\"", printable(word, 40));
    }
    double number(std::string_view what, std::string_view word) const {
        double value = 0.0;
        if (!read_number(word, value)) fail(cursor_.line(), what, quoted(word), "a number");
        return value;
    }
    void check_room(std::string_view what, std::size_t count) const {
        if (count < kMaxScanElements) return;
        fail(cursor_.line(), what, "one more", fmt::format("at most {}", kMaxScanElements));
    }
    void read_position();
    void read_normal();
    void read_uv();
    void read_face();
    std::uint32_t index(std::string_view what, std::string_view digits, std::size_t count, Reach&);
    ScanCorner corner(std::string_view word);
    void read_library();
    void read_keyword(std::string_view keyword);
    void check_reach(std::string_view what, const Reach& reach, std::size_t count) const;
    void name_parts();
    std::uint16_t part();

    TextCursor cursor_;
    const std::filesystem::path& file_;
    ScanFile scan_;
    PartKey here_;
    std::map<PartKey, std::uint16_t> part_of_;
    bool part_is_known_ = false;
    std::uint16_t part_here_ = 0;
    Reach positions_, normals_, uvs_;
    /// Polygons wait until all positions are there.
    std::vector<ScanCorner> polygon_corners_, face_;
    std::vector<std::pair<std::size_t, std::uint16_t>> polygons_;  ///< end and part
    ObjColours colours_;
    std::set<std::string> unread_;
    std::size_t small_faces_ = 0;
    bool has_colours_ = false;
};

void ObjReader::read_position() {
    check_room("v", scan_.positions.size());
    glm::dvec3 position;
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = cursor_.word();
        position[axis] = number("v", word);
        if (!std::isfinite(position[axis])) {
            fail(cursor_.line(),
                 "v",
                 fmt::format("{} at vertex {}", quoted(word), scan_.positions.size() + 1),
                 "a finite number");
        }
    }
    // A weight, or a colour and sometimes its alpha.
    int more = 0;
    for (; !cursor_.at_line_end(); ++more) number("v", cursor_.word());
    has_colours_ = has_colours_ || more >= 3;
    scan_.positions.push_back(position);
}

void ObjReader::read_normal() {
    check_room("vn", scan_.normals.size());
    glm::vec3 normal;
    for (int axis = 0; axis < 3; ++axis) {
        normal[axis] = static_cast<float>(number("vn", cursor_.word()));
    }
    scan_.normals.push_back(normal);
}

void ObjReader::read_uv() {
    check_room("vt", scan_.uvs.size());
    const double u = number("vt", cursor_.word());
    const double v = cursor_.at_line_end() ? 0.0 : number("vt", cursor_.word());
    // OBJ's v rises; ours falls.
    scan_.uvs.emplace_back(u, 1.0 - v);
}

/// Counts from 1; negative: back from what was read last.
std::uint32_t ObjReader::index(std::string_view what,
                               std::string_view digits,
                               std::size_t count,
                               Reach& reach) {
    std::int64_t value = 0;
    if (!read_number(digits, value) || value == 0) {
        fail(cursor_.line(), "f", quoted(digits), fmt::format("the number of a {}", what));
    }
    if (value < 0) {
        if (static_cast<std::uint64_t>(-(value + 1)) >= count) {
            fail(cursor_.line(),
                 "f",
                 fmt::format("{} {}", what, value),
                 fmt::format("one of the {} above", count));
        }
        return static_cast<std::uint32_t>(static_cast<std::int64_t>(count) + value);
    }
    const auto index = static_cast<std::uint64_t>(value);
    if (index > kMaxScanElements) {
        fail(cursor_.line(),
             "f",
             fmt::format("{} {}", what, value),
             fmt::format("at most {}", kMaxScanElements));
    }
    if (index > count) reach.use(index, cursor_.line());
    return static_cast<std::uint32_t>(index - 1);
}

/// "7", "7/3", "7//5" or "7/3/5": position, texture, normal.
ScanCorner ObjReader::corner(std::string_view word) {
    ScanCorner corner;
    const auto cut = [&word] {
        const std::size_t slash = std::min(word.find('/'), word.size());
        const std::string_view first = word.substr(0, slash);
        word.remove_prefix(std::min(slash + 1, word.size()));
        return first;
    };
    const std::string_view whole = word, position = cut(), uv = cut(), normal = cut();
    if (!word.empty()) fail(cursor_.line(), "f", quoted(whole), "a corner such as 7/3/5");
    corner.position = index("v", position, scan_.positions.size(), positions_);
    if (!uv.empty()) corner.uv = index("vt", uv, scan_.uvs.size(), uvs_);
    if (!normal.empty()) corner.normal = index("vn", normal, scan_.normals.size(), normals_);
    return corner;
}

std::uint16_t ObjReader::part() {
    if (part_is_known_) return part_here_;
    const auto [entry, is_new] =
        part_of_.try_emplace(here_, static_cast<std::uint16_t>(part_of_.size()));
    if (is_new && part_of_.size() > 0xffff) {
        fail(cursor_.line(), "f", "part 65536", "65535 parts or less");
    }
    part_is_known_ = true;
    return part_here_ = entry->second;
}

void ObjReader::read_face() {
    const std::uint16_t part_here = part();
    face_.clear();
    while (!cursor_.at_line_end()) {
        face_.push_back(corner(cursor_.word()));
        if (face_.size() <= kMaxPolygonCorners) continue;
        fail(cursor_.line(),
             "f",
             fmt::format("more than {} corners", kMaxPolygonCorners),
             "fewer of them");
    }
    check_room("f", 3 * scan_.triangles.size() + polygon_corners_.size());
    if (face_.size() < 3) {
        ++small_faces_;
    } else if (face_.size() == 3) {
        scan_.triangles.push_back({face_[0], face_[1], face_[2]});
        scan_.triangle_part.push_back(part_here);
    } else {
        polygon_corners_.insert(polygon_corners_.end(), face_.begin(), face_.end());
        polygons_.emplace_back(polygon_corners_.size(), part_here);
    }
}

void ObjReader::read_library() {
    const std::string name(cursor_.rest_of_line());
    const auto library = path_beside(file_, name);
    if (!library) {
        scan_.notes.push_back(fmt::format(
            "the material library \"{}\" is not beside the file or below its folder; not read",
            printable(name, 100)));
        return;
    }
    std::error_code error;
    if (!std::filesystem::exists(*library, error)) {
        scan_.notes.push_back(
            fmt::format("the material library \"{}\" is missing; its colours are not known",
                        printable(name, 100)));
        return;
    }
    read_obj_colours(read_text_file(*library, kMaxLibraryBytes), *library, colours_, scan_.notes);
}

void ObjReader::read_keyword(std::string_view keyword) {
    if (keyword == "v") return read_position();
    if (keyword == "f" || keyword == "fo") return read_face();
    if (keyword == "vn") return read_normal();
    if (keyword == "vt") return read_uv();
    if (keyword == "mtllib") return read_library();
    const auto name = [this] {
        part_is_known_ = false;
        return printable(cursor_.rest_of_line(), 200);
    };
    if (keyword == "o") {
        here_.object = name();
    } else if (keyword == "g") {
        here_.group = name();
    } else if (keyword == "usemtl") {
        here_.material = name();
    } else if (keyword != "s" && unread_.size() < 20) {
        unread_.insert(printable(keyword, 20));
    }
}

void ObjReader::check_reach(std::string_view what, const Reach& reach, std::size_t count) const {
    if (reach.largest <= count) return;
    fail(reach.line,
         "f",
         fmt::format("{} {}", what, reach.largest),
         fmt::format("1 to {}, the number there are", count));
}

/// Objects, or groups where there are no objects, are named only where there are several.
void ObjReader::name_parts() {
    std::vector<PartKey> keys(part_of_.size());
    std::set<std::string> objects, groups;
    for (const auto& [key, index] : part_of_) {
        keys[index] = key;
        objects.insert(key.object);
        groups.insert(key.group);
    }
    const bool by_object = objects.size() > 1 || !objects.contains("");
    const auto body_of = [&](const PartKey& key) { return by_object ? key.object : key.group; };
    const bool several = (by_object ? objects : groups).size() > 1;
    std::map<std::string, std::set<std::string>> materials_of;
    for (const PartKey& key : keys) materials_of[body_of(key)].insert(key.material);

    // Groups do not part what objects or materials already do, so keys can fall together.
    std::map<std::string, std::uint16_t> part_named;
    std::vector<std::uint16_t> part_of_key;
    for (const PartKey& key : keys) {
        const std::string body = body_of(key);
        std::string name = several && !body.empty() ? body : key.material;
        if (several && !body.empty() && materials_of[body].size() > 1) {
            name += "/" + (key.material.empty() ? "no material" : key.material);
        }
        if (name.empty()) name = body.empty() ? "scan" : body;
        const auto [entry, is_new] =
            part_named.try_emplace(name, static_cast<std::uint16_t>(scan_.parts.size()));
        part_of_key.push_back(entry->second);
        if (!is_new) continue;
        Part part{name, key.material, glm::dvec3(0.5)};
        if (const auto known = colours_.find(key.material); known != colours_.end()) {
            part.base_colour_rec709 = known->second;
        }
        scan_.parts.push_back(std::move(part));
    }
    for (std::uint16_t& part : scan_.triangle_part) part = part_of_key[part];
}

ScanFile ObjReader::read() {
    for (; !cursor_.at_end(); cursor_.next_line()) {
        const std::string_view keyword = cursor_.word();
        if (!keyword.empty()) read_keyword(keyword);
    }
    check_reach("v", positions_, scan_.positions.size());
    check_reach("vn", normals_, scan_.normals.size());
    check_reach("vt", uvs_, scan_.uvs.size());
    std::size_t at = 0;
    for (const auto& [end, part] : polygons_) {
        face_.assign(polygon_corners_.begin() + static_cast<std::ptrdiff_t>(at),
                     polygon_corners_.begin() + static_cast<std::ptrdiff_t>(end));
        if (!add_polygon(scan_, face_, part)) refuse_polygons(file_);
        at = end;
    }
    name_parts();

    std::string unread;
    for (const std::string& keyword : unread_) unread += (unread.empty() ? "" : ", ") + keyword;
    if (!unread.empty()) {
        scan_.notes.push_back(fmt::format("lines that are not read: {}", unread));
    }
    if (has_colours_) scan_.notes.emplace_back("vertex colours are not read");
    if (small_faces_ > 0) {
        scan_.notes.push_back(
            fmt::format("{} faces of fewer than three corners dropped", small_faces_));
    }
    return std::move(scan_);
}

}  // namespace

ScanFile read_obj(std::string_view text, const std::filesystem::path& file) {
    return ObjReader(text, file).read();
}

}  // namespace livery
