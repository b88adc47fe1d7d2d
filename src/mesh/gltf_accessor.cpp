#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "mesh/gltf_file.h"

namespace livery {

namespace {

constexpr int kMaxInt = std::numeric_limits<int>::max();
/// Over everything in one file.
constexpr std::size_t kMaxElements = 1u << 25u;
/// As many are taken on a file's word: more must be there as bytes, or a small file could declare
/// more than memory holds.
constexpr std::size_t kBelievedElements = 1u << 20u;

enum ComponentType {
    byte = 5120,
    ubyte = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    real = 5126
};

std::size_t size_of(int component_type) {
    switch (component_type) {
        case byte:
        case ubyte:
            return 1;
        case int16:
        case uint16:
            return 2;
        default:
            return 4;
    }
}

template <typename T>
double load(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

double load_component(int type, const char* bytes) {
    switch (type) {
        case byte:
            return load<std::int8_t>(bytes);
        case ubyte:
            return load<std::uint8_t>(bytes);
        case int16:
            return load<std::int16_t>(bytes);
        case uint16:
            return load<std::uint16_t>(bytes);
        case uint32:
            return load<std::uint32_t>(bytes);
        default:
            return load<float>(bytes);
    }
}

/// What a normalised integer of the type is divided by; signed ones stop at -1.
double full_scale(int type) {
    switch (type) {
        case byte:
            return 127.0;
        case ubyte:
            return 255.0;
        case int16:
            return 32767.0;
        case uint16:
            return 65535.0;
        default:
            return 1.0;
    }
}

std::size_t width_of(const std::string& type) {
    if (type == "SCALAR") return 1;
    return static_cast<std::size_t>(type.back() - '0');  // VEC2, VEC3, VEC4
}

std::string join(const std::vector<std::string>& names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : " or ") + name;
    return text;
}

JsonReader member_at(const JsonReader& root, std::string_view array, const JsonReader& index) {
    return root[array].at(index_into(root, array, index));
}

}  // namespace

struct GltfAccessors::Shape {
    std::size_t count = 0;
    std::size_t width = 1;
    int component_type = real;
    bool normalized = false;

    std::size_t element_size() const { return width * size_of(component_type); }
    double decode(const char* bytes) const {
        const double value = load_component(component_type, bytes);
        return normalized ? std::max(value / full_scale(component_type), -1.0) : value;
    }
};

GltfAccessors::Shape GltfAccessors::shape_of(const JsonReader& accessor,
                                             const GltfElementRule& rule) const {
    Shape shape;
    shape.count = static_cast<std::size_t>(accessor["count"].integer(1, kMaxInt));
    std::size_t bytes = 0;
    for (const std::string& content : gltf_.contents) bytes += content.size();
    const std::size_t most = std::min(kMaxElements, kBelievedElements + bytes);
    if (shape.count > most - elements_read_) {
        accessor["count"].fail(
            std::to_string(shape.count),
            "at most " + std::to_string(most) + " in all accessors of a file of this length");
    }
    const auto type = accessor["type"];
    if (std::find(rule.types.begin(), rule.types.end(), type.text()) == rule.types.end()) {
        type.fail(type.found(), join(rule.types));
    }
    shape.width = width_of(type.text());
    const auto component = accessor["componentType"];
    shape.component_type = component.integer(0, kMaxInt);
    const auto& allowed = rule.component_types;
    if (std::find(allowed.begin(), allowed.end(), shape.component_type) == allowed.end()) {
        std::vector<std::string> names;
        for (const int one : allowed) names.push_back(std::to_string(one));
        component.fail(component.found(), join(names));
    }
    shape.normalized = accessor.has("normalized") && accessor["normalized"].boolean();
    if (shape.normalized && (shape.component_type == uint32 || shape.component_type == real)) {
        accessor["normalized"].fail("true", "false for component type " + component.found());
    }
    return shape;
}

const char* GltfAccessors::find_bytes(const JsonReader& place,
                                      std::size_t count,
                                      std::size_t element_size,
                                      std::size_t& stride) const {
    const auto view = member_at(gltf_.root(), "bufferViews", place["bufferView"]);
    const auto buffer_index = view["buffer"];
    member_at(gltf_.root(), "buffers", buffer_index);
    const std::string_view buffer =
        gltf_.buffer(static_cast<std::size_t>(buffer_index.integer(0, kMaxInt)));

    // All below 2^31, so that 64-bit sums and products stay exact.
    const auto view_offset =
        static_cast<std::uint64_t>(integer_or(view, "byteOffset", 0, kMaxInt, 0));
    const auto view_size = static_cast<std::uint64_t>(view["byteLength"].integer(1, kMaxInt));
    if (view_offset + view_size > buffer.size()) {
        view["byteLength"].fail(
            std::to_string(view_size) + " from byte " + std::to_string(view_offset),
            "an end within the buffer's " + std::to_string(buffer.size()) + " bytes");
    }
    stride = element_size;
    if (view.has("byteStride")) {
        stride = static_cast<std::size_t>(view["byteStride"].integer(1, 252));
        if (stride < element_size) {
            view["byteStride"].fail(
                std::to_string(stride),
                "at least the element's " + std::to_string(element_size) + " bytes");
        }
    }
    const auto offset = static_cast<std::uint64_t>(integer_or(place, "byteOffset", 0, kMaxInt, 0));
    const std::uint64_t needed = offset + stride * (count - 1) + element_size;
    if (needed > view_size) {
        place.fail(
            std::to_string(count) + " elements that need " + std::to_string(needed) + " bytes",
            "at most the buffer view's " + std::to_string(view_size));
    }
    return buffer.data() + view_offset + offset;
}

void GltfAccessors::overlay_sparse(const JsonReader& accessor,
                                   const Shape& shape,
                                   GltfNumbers& numbers) const {
    const auto sparse = accessor["sparse"];
    const auto count =
        static_cast<std::size_t>(sparse["count"].integer(1, static_cast<int>(shape.count)));
    Shape places;
    const auto component = sparse["indices"]["componentType"];
    places.component_type = component.integer(0, kMaxInt);
    if (places.component_type != ubyte && places.component_type != uint16 &&
        places.component_type != uint32) {
        component.fail(component.found(), "5121 or 5123 or 5125");
    }
    std::size_t place_stride = 0, value_stride = 0;
    const char* place = find_bytes(sparse["indices"], count, places.element_size(), place_stride);
    const char* value = find_bytes(sparse["values"], count, shape.element_size(), value_stride);
    double last = -1.0;
    for (std::size_t k = 0; k < count; ++k, place += place_stride, value += value_stride) {
        const double index = places.decode(place);
        if (index <= last || index >= static_cast<double>(shape.count)) {
            sparse["indices"].fail(std::to_string(static_cast<std::uint64_t>(index)),
                                   "rising indices below " + std::to_string(shape.count));
        }
        last = index;
        double* element = numbers.values.data() + static_cast<std::size_t>(index) * shape.width;
        for (std::size_t c = 0; c < shape.width; ++c) {
            element[c] = shape.decode(value + c * size_of(shape.component_type));
        }
    }
}

const GltfNumbers& GltfAccessors::read(const JsonReader& index, const GltfElementRule& rule) {
    const auto accessor = member_at(gltf_.root(), "accessors", index);
    const Shape shape = shape_of(accessor, rule);
    const int key = index.integer(0, kMaxInt);
    if (const auto known = read_.find(key); known != read_.end()) return known->second;

    std::size_t stride = 0;
    const char* bytes = nullptr;
    if (accessor.has("bufferView")) {
        bytes = find_bytes(accessor, shape.count, shape.element_size(), stride);
    }
    elements_read_ += shape.count;
    GltfNumbers numbers;
    numbers.width = shape.width;
    numbers.values.assign(shape.count * shape.width, 0.0);
    for (std::size_t k = 0; bytes && k < shape.count; ++k) {
        for (std::size_t c = 0; c < shape.width; ++c) {
            numbers.values[k * shape.width + c] =
                shape.decode(bytes + k * stride + c * size_of(shape.component_type));
        }
    }
    if (accessor.has("sparse")) overlay_sparse(accessor, shape, numbers);
    for (std::size_t k = 0; k < numbers.values.size(); ++k) {
        if (std::isfinite(numbers.values[k])) continue;
        accessor.fail("a number that is not finite in element " + std::to_string(k / shape.width),
                      "finite numbers");
    }
    return read_.emplace(key, std::move(numbers)).first->second;
}

}  // namespace livery
