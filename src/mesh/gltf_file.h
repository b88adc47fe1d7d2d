// glTF 2.0 containers and their numbers, checked: what read_gltf builds on. Internal to scene/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.h"
#include "mesh/mesh.h"

namespace livery {

/// An opened file: its JSON, and its buffers, each as long as declared.
struct GltfFile {
    struct Buffer {
        std::size_t content = 0;  ///< several may share one
        std::size_t bytes = 0;
    };
    std::filesystem::path path;
    Json json;
    std::vector<std::string> contents;
    std::vector<Buffer> buffers;

    JsonReader root() const { return {path, json}; }
    std::string_view buffer(std::size_t index) const {
        const Buffer& one = buffers[index];
        return std::string_view(contents[one.content]).substr(0, one.bytes);
    }
};

/// Opens the bytes of a .gltf (buffers beside `file` or as data URIs) or a .glb. Checks the
/// container, the version and the required extensions. Throws FileError.
GltfFile open_gltf(const std::string& bytes, const std::filesystem::path& file);

/// The whole file as one mesh in the world's frame. Throws FileError.
Mesh read_gltf(const std::string& bytes,
               const std::filesystem::path& file,
               std::vector<std::string>& notes);

/// An accessor's elements, `width` numbers each (3 for VEC3), all finite.
struct GltfNumbers {
    std::size_t width = 1;
    std::vector<double> values;

    std::size_t count() const { return values.size() / width; }
    const double* element(std::size_t index) const { return values.data() + index * width; }
};

/// What an attribute may be made of.
struct GltfElementRule {
    std::vector<std::string> types;    ///< "SCALAR", "VEC2", ...
    std::vector<int> component_types;  ///< 5126 is float
};

/// Reads accessors, each once; sparse ones and those without a buffer view (zeros) included.
class GltfAccessors {
  public:
    explicit GltfAccessors(const GltfFile& gltf) : gltf_(gltf) {}

    /// `index` is the place that names the accessor ("meshes[0].primitives[0].indices").
    const GltfNumbers& read(const JsonReader& index, const GltfElementRule& rule);

  private:
    struct Shape;
    Shape shape_of(const JsonReader& accessor, const GltfElementRule& rule) const;
    void overlay_sparse(const JsonReader& accessor, const Shape& shape, GltfNumbers& numbers) const;
    /// The first byte of `count` elements in the buffer view that `place` names.
    const char* find_bytes(const JsonReader& place,
                           std::size_t count,
                           std::size_t element_size,
                           std::size_t& stride) const;

    const GltfFile& gltf_;
    std::map<int, GltfNumbers> read_;
    std::size_t elements_read_ = 0;
};

/// Members that may be absent.
int integer_or(const JsonReader& object, std::string_view key, int low, int high, int otherwise);
std::string name_or(const JsonReader& object, const std::string& otherwise);

/// An index into one of the file's arrays ("nodes"), in range.
std::size_t index_into(const JsonReader& root, std::string_view array, const JsonReader& index);

}  // namespace livery
