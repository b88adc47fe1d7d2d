// check_gltf_fields: what glTF 2.0 says of each member that is read, as tables.
#include <limits>
#include <span>
#include <string_view>

#include "mesh/gltf/gltf_file.h"

namespace livery {

namespace {

enum class Kind {
    object,
    objects,    ///< an array of them
    object_of,  ///< any names, each an index
    index,
    indices,
    whole,
    number,
    numbers,
    text,
    boolean
};

struct Member {
    std::string_view key;
    Kind kind = Kind::object;
    std::span<const Member> members{};  ///< of objects
    std::string_view array{};           ///< into which an index points
    double low = 0.0, high = 0.0;
    std::size_t count = 0;  ///< of numbers
    bool required = false;
    int step = 1;  ///< of whole numbers
};

constexpr double kMaxInt = std::numeric_limits<int>::max();
constexpr double kLargest = 1e12;

constexpr Member required(Member member) {
    member.required = true;
    return member;
}
constexpr Member object(std::string_view key, std::span<const Member> members) {
    return {.key = key, .kind = Kind::object, .members = members};
}
constexpr Member objects(std::string_view key, std::span<const Member> members) {
    return {.key = key, .kind = Kind::objects, .members = members};
}
constexpr Member index(std::string_view key, std::string_view array) {
    return {.key = key, .kind = Kind::index, .array = array};
}
constexpr Member indices(std::string_view key, std::string_view array) {
    return {.key = key, .kind = Kind::indices, .array = array};
}
constexpr Member whole(std::string_view key, double low, double high, int step = 1) {
    return {.key = key, .kind = Kind::whole, .low = low, .high = high, .step = step};
}
constexpr Member number(std::string_view key, double low, double high) {
    return {.key = key, .kind = Kind::number, .low = low, .high = high};
}
constexpr Member numbers(std::string_view key,
                         std::size_t count,
                         double low = -kLargest,
                         double high = kLargest) {
    return {.key = key, .kind = Kind::numbers, .low = low, .high = high, .count = count};
}
constexpr Member text(std::string_view key) { return {.key = key, .kind = Kind::text}; }
constexpr Member boolean(std::string_view key) { return {.key = key, .kind = Kind::boolean}; }

constexpr Member kBuffer[] = {required(whole("byteLength", 1, kMaxInt)), text("uri")};
constexpr Member kBufferView[] = {required(index("buffer", "buffers")),
                                  whole("byteOffset", 0, kMaxInt),
                                  required(whole("byteLength", 1, kMaxInt)),
                                  whole("byteStride", 4, 252, 4)};

constexpr Member kSparseIndices[] = {required(index("bufferView", "bufferViews")),
                                     whole("byteOffset", 0, kMaxInt),
                                     required(whole("componentType", 5120, 5126))};
constexpr Member kSparseValues[] = {required(index("bufferView", "bufferViews")),
                                    whole("byteOffset", 0, kMaxInt)};
constexpr Member kSparse[] = {required(whole("count", 1, kMaxInt)),
                              required(object("indices", kSparseIndices)),
                              required(object("values", kSparseValues))};
constexpr Member kAccessor[] = {index("bufferView", "bufferViews"),
                                whole("byteOffset", 0, kMaxInt),
                                required(whole("componentType", 5120, 5130)),
                                boolean("normalized"),
                                required(whole("count", 1, kMaxInt)),
                                required(text("type")),
                                object("sparse", kSparse)};

constexpr Member kVariantMapping[] = {required(index("material", "materials")),
                                      required(indices("variants", ""))};
constexpr Member kPrimitiveVariants[] = {required(objects("mappings", kVariantMapping))};
constexpr Member kPrimitiveExtensions[] = {object("KHR_materials_variants", kPrimitiveVariants)};
constexpr Member kPrimitive[] = {
    required({.key = "attributes", .kind = Kind::object_of, .array = "accessors"}),
    index("indices", "accessors"),
    index("material", "materials"),
    whole("mode", 0, 6),
    object("extensions", kPrimitiveExtensions)};
constexpr Member kMesh[] = {text("name"), required(objects("primitives", kPrimitive))};

constexpr Member kVisibility[] = {boolean("visible")};
constexpr Member kNodeExtensions[] = {object("KHR_node_visibility", kVisibility)};
constexpr Member kNode[] = {text("name"),
                            index("mesh", "meshes"),
                            indices("children", "nodes"),
                            numbers("matrix", 16),
                            numbers("rotation", 4),
                            numbers("scale", 3),
                            numbers("translation", 3),
                            object("extensions", kNodeExtensions)};
constexpr Member kScene[] = {indices("nodes", "nodes")};

constexpr Member kTransform[] = {numbers("offset", 2),
                                 number("rotation", -1e4, 1e4),
                                 numbers("scale", 2),
                                 whole("texCoord", 0, 99)};
constexpr Member kTextureInfoExtensions[] = {object("KHR_texture_transform", kTransform)};
constexpr Member kTextureInfo[] = {required(index("index", "textures")),
                                   whole("texCoord", 0, 99),
                                   number("scale", -kLargest, kLargest),
                                   number("strength", 0, 1),
                                   object("extensions", kTextureInfoExtensions)};
constexpr Member kRoughness[] = {numbers("baseColorFactor", 4, 0, 1),
                                 object("baseColorTexture", kTextureInfo),
                                 number("metallicFactor", 0, 1),
                                 number("roughnessFactor", 0, 1),
                                 object("metallicRoughnessTexture", kTextureInfo)};
constexpr Member kClearcoat[] = {number("clearcoatFactor", 0, 1),
                                 object("clearcoatTexture", kTextureInfo),
                                 number("clearcoatRoughnessFactor", 0, 1),
                                 object("clearcoatRoughnessTexture", kTextureInfo),
                                 object("clearcoatNormalTexture", kTextureInfo)};
constexpr Member kSpecular[] = {number("specularFactor", 0, 1),
                                numbers("specularColorFactor", 3, 0, 1e6)};
constexpr Member kIor[] = {number("ior", 0, 100)};
constexpr Member kAnisotropy[] = {number("anisotropyStrength", 0, 1),
                                  number("anisotropyRotation", -1e4, 1e4)};
constexpr Member kIridescence[] = {number("iridescenceFactor", 0, 1),
                                   number("iridescenceIor", 1, 100),
                                   number("iridescenceThicknessMinimum", 0, 1e6),
                                   number("iridescenceThicknessMaximum", 0, 1e6)};
constexpr Member kMaterialExtensions[] = {object("KHR_materials_clearcoat", kClearcoat),
                                          object("KHR_materials_specular", kSpecular),
                                          object("KHR_materials_ior", kIor),
                                          object("KHR_materials_anisotropy", kAnisotropy),
                                          object("KHR_materials_iridescence", kIridescence)};
constexpr Member kMaterial[] = {text("name"),
                                object("pbrMetallicRoughness", kRoughness),
                                object("normalTexture", kTextureInfo),
                                object("occlusionTexture", kTextureInfo),
                                object("emissiveTexture", kTextureInfo),
                                numbers("emissiveFactor", 3, 0, 1e9),
                                text("alphaMode"),
                                object("extensions", kMaterialExtensions)};

constexpr Member kWebp[] = {index("source", "images")};
constexpr Member kTextureExtensions[] = {object("EXT_texture_webp", kWebp)};
constexpr Member kTexture[] = {index("sampler", "samplers"),
                               index("source", "images"),
                               object("extensions", kTextureExtensions)};
constexpr Member kSampler[] = {whole("wrapS", 0, 65535), whole("wrapT", 0, 65535)};
constexpr Member kImage[] = {text("uri"), text("mimeType"), index("bufferView", "bufferViews")};

constexpr Member kVariant[] = {required(text("name"))};
constexpr Member kVariantsMembers[] = {required(objects("variants", kVariant))};
constexpr Member kExtensions[] = {object("KHR_materials_variants", kVariantsMembers)};
constexpr Member kRoot[] = {objects("buffers", kBuffer),
                            objects("bufferViews", kBufferView),
                            objects("accessors", kAccessor),
                            objects("images", kImage),
                            objects("samplers", kSampler),
                            objects("textures", kTexture),
                            objects("materials", kMaterial),
                            objects("meshes", kMesh),
                            objects("nodes", kNode),
                            objects("scenes", kScene),
                            index("scene", "scenes"),
                            object("extensions", kExtensions)};

/// Variants are numbered within an extension; every other index counts the root's arrays.
std::size_t checked_index(const JsonReader& root, const Member& member, const JsonReader& at) {
    if (!member.array.empty()) return index_into(root, member.array, at);
    const bool any = root.has("extensions") && root["extensions"].has("KHR_materials_variants");
    if (!any) at.fail(at.found(), "no index: there are no variants");
    return index_into(root["extensions"]["KHR_materials_variants"], "variants", at);
}

void check_members(const JsonReader& root,
                   const JsonReader& object,
                   std::span<const Member> members);

void check_member(const JsonReader& root, const JsonReader& at, const Member& member) {
    switch (member.kind) {
        case Kind::object:
            return check_members(root, at, member.members);
        case Kind::objects:
            for (std::size_t k = 0; k < at.size(); ++k) {
                check_members(root, at.at(k), member.members);
            }
            return;
        case Kind::object_of:
            for (const std::string& key : at.keys()) checked_index(root, member, at[key]);
            return;
        case Kind::index:
            checked_index(root, member, at);
            return;
        case Kind::indices:
            for (std::size_t k = 0; k < at.size(); ++k) checked_index(root, member, at.at(k));
            return;
        case Kind::whole: {
            const int value =
                at.integer(static_cast<int>(member.low), static_cast<int>(member.high));
            if (value % member.step != 0) {
                at.fail(at.found(), "a multiple of " + std::to_string(member.step));
            }
            return;
        }
        case Kind::number:
            at.number_between(member.low, member.high);
            return;
        case Kind::numbers:
            at.numbers(member.count);
            for (std::size_t k = 0; k < member.count; ++k) {
                at.at(k).number_between(member.low, member.high);
            }
            return;
        case Kind::text:
            at.text();
            return;
        case Kind::boolean:
            at.boolean();
            return;
    }
}

void check_members(const JsonReader& root,
                   const JsonReader& object,
                   std::span<const Member> members) {
    if (!object.is_object()) object.fail(object.found(), "an object");
    for (const Member& member : members) {
        if (member.required || object.has(member.key)) {
            check_member(root, object[member.key], member);
        }
    }
}

}  // namespace

std::size_t index_into(const JsonReader& root, std::string_view array, const JsonReader& index) {
    const std::size_t count = root.has(array) ? root[array].size() : 0;
    if (count == 0) index.fail(index.found(), "no index: there are no " + std::string(array));
    return static_cast<std::size_t>(index.integer(0, static_cast<int>(count) - 1));
}

void check_gltf_fields(const JsonReader& root) { check_members(root, root, kRoot); }

}  // namespace livery
