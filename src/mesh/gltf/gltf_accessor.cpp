#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "mesh/gltf/gltf_file.h"

namespace livery {

namespace {

/// Over everything in one file.
constexpr std::size_t kMaxElements = 1u << 25u;
/// As many are taken on a file's word: more must be there as bytes, or a small file could declare
/// more than memory holds.
constexpr std::size_t kBelievedElements = 1u << 20u;

enum ComponentType {
    byte = TINYGLTF_COMPONENT_TYPE_BYTE,
    ubyte = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
    int16 = TINYGLTF_COMPONENT_TYPE_SHORT,
    uint16 = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
    uint32 = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
    real = TINYGLTF_COMPONENT_TYPE_FLOAT
};

std::size_t size_of(int component_type) {
    return static_cast<std::size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)));
}

template <typename T>
double native(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

double load_component(int type, const char* bytes) {
    switch (type) {
        case byte:
            return native<std::int8_t>(bytes);
        case ubyte:
            return native<std::uint8_t>(bytes);
        case int16:
            return native<std::int16_t>(bytes);
        case uint16:
            return native<std::uint16_t>(bytes);
        case uint32:
            return native<std::uint32_t>(bytes);
        default:
            return native<float>(bytes);
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

const char* name_of(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return "SCALAR";
        case TINYGLTF_TYPE_VEC2:
            return "VEC2";
        case TINYGLTF_TYPE_VEC3:
            return "VEC3";
        default:
            return "VEC4";
    }
}

template <typename Name>
std::string join(const std::vector<int>& values, const Name& name) {
    std::string text;
    for (const int value : values) text += (text.empty() ? "" : " or ") + name(value);
    return text;
}

bool is_one_of(int value, const std::vector<int>& values) {
    return std::find(values.begin(), values.end(), value) != values.end();
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

GltfAccessors::Shape GltfAccessors::shape_of(int index, const GltfElementRule& rule) const {
    const auto k = static_cast<std::size_t>(index);
    const tinygltf::Accessor& accessor = gltf_.model.accessors[k];
    const auto reader = gltf_.root()["accessors"].at(k);
    std::size_t bytes = 0;
    for (const std::string& content : gltf_.contents) bytes += content.size();
    const std::size_t most = std::min(kMaxElements, kBelievedElements + bytes);
    if (accessor.count > most - elements_read_) {
        reader["count"].fail(
            std::to_string(accessor.count),
            "at most " + std::to_string(most) + " in all accessors of a file of this length");
    }
    if (!is_one_of(accessor.type, rule.types)) {
        const auto name = [](int type) { return std::string(name_of(type)); };
        reader["type"].fail(reader["type"].found(), join(rule.types, name));
    }
    if (!is_one_of(accessor.componentType, rule.component_types)) {
        const auto name = [](int type) { return std::to_string(type); };
        reader["componentType"].fail(name(accessor.componentType),
                                     join(rule.component_types, name));
    }
    if (accessor.normalized &&
        (accessor.componentType == uint32 || accessor.componentType == real)) {
        reader["normalized"].fail(
            "true", "false for component type " + std::to_string(accessor.componentType));
    }
    const int width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    return {accessor.count,
            static_cast<std::size_t>(width),
            accessor.componentType,
            accessor.normalized};
}

const char* GltfAccessors::find_bytes(const std::string& place,
                                      int view,
                                      std::size_t offset,
                                      std::size_t count,
                                      std::size_t element_size,
                                      std::size_t& stride) const {
    const auto k = static_cast<std::size_t>(view);
    const std::string_view bytes = gltf_.view(k);
    const std::size_t said = gltf_.model.bufferViews[k].byteStride;
    stride = said > 0 ? said : element_size;
    if (stride < element_size) {
        gltf_.fail("bufferViews[" + std::to_string(view) + "].byteStride",
                   std::to_string(stride),
                   "at least the element's " + std::to_string(element_size) + " bytes");
    }
    // All below 2^31, so that 64-bit sums and products stay exact.
    const std::uint64_t needed = offset + stride * (count - 1) + element_size;
    if (needed > bytes.size()) {
        gltf_.fail(
            place,
            std::to_string(count) + " elements that need " + std::to_string(needed) + " bytes",
            "at most the buffer view's " + std::to_string(bytes.size()));
    }
    return bytes.data() + offset;
}

void GltfAccessors::overlay_sparse(int index, const Shape& shape, GltfNumbers& numbers) const {
    const auto& sparse = gltf_.model.accessors[static_cast<std::size_t>(index)].sparse;
    const std::string field = "accessors[" + std::to_string(index) + "].sparse";
    const auto count = static_cast<std::size_t>(sparse.count);
    if (count > shape.count) {
        gltf_.fail(field + ".count",
                   std::to_string(count),
                   "a whole number between 1 and " + std::to_string(shape.count));
    }
    Shape places;
    places.component_type = sparse.indices.componentType;
    if (!is_one_of(places.component_type, {ubyte, uint16, uint32})) {
        gltf_.fail(field + ".indices.componentType",
                   std::to_string(places.component_type),
                   "5121 or 5123 or 5125");
    }
    std::size_t place_stride = 0, value_stride = 0;
    const char* place = find_bytes(field + ".indices",
                                   sparse.indices.bufferView,
                                   static_cast<std::size_t>(sparse.indices.byteOffset),
                                   count,
                                   places.element_size(),
                                   place_stride);
    const char* value = find_bytes(field + ".values",
                                   sparse.values.bufferView,
                                   static_cast<std::size_t>(sparse.values.byteOffset),
                                   count,
                                   shape.element_size(),
                                   value_stride);
    double last = -1.0;
    for (std::size_t k = 0; k < count; ++k, place += place_stride, value += value_stride) {
        const double at = places.decode(place);
        if (at <= last || at >= static_cast<double>(shape.count)) {
            gltf_.fail(field + ".indices",
                       std::to_string(static_cast<std::uint64_t>(at)),
                       "rising indices below " + std::to_string(shape.count));
        }
        last = at;
        double* element = numbers.values.data() + static_cast<std::size_t>(at) * shape.width;
        for (std::size_t c = 0; c < shape.width; ++c) {
            element[c] = shape.decode(value + c * size_of(shape.component_type));
        }
    }
}

const GltfNumbers& GltfAccessors::read(int index, const GltfElementRule& rule) {
    const Shape shape = shape_of(index, rule);
    if (const auto known = read_.find(index); known != read_.end()) return known->second;

    const tinygltf::Accessor& accessor = gltf_.model.accessors[static_cast<std::size_t>(index)];
    const std::string field = "accessors[" + std::to_string(index) + "]";
    std::size_t stride = 0;
    const char* bytes = nullptr;
    if (gltf_.has_view(accessor)) {
        bytes = find_bytes(field,
                           accessor.bufferView,
                           accessor.byteOffset,
                           shape.count,
                           shape.element_size(),
                           stride);
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
    if (accessor.sparse.isSparse) overlay_sparse(index, shape, numbers);
    for (std::size_t k = 0; k < numbers.values.size(); ++k) {
        if (std::isfinite(numbers.values[k])) continue;
        gltf_.fail(field,
                   "a number that is not finite in element " + std::to_string(k / shape.width),
                   "finite numbers");
    }
    return read_.emplace(index, std::move(numbers)).first->second;
}

}  // namespace livery
