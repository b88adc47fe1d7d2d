// glTF 2.0 containers and their numbers, checked: what read_gltf builds on. Internal to mesh/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.h"
#include "mesh/mesh.h"

// Files and pictures are opened by open_gltf() and by OpenImageIO.
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

namespace livery {

/// An opened file: what it says, every field of a kind and in a range that glTF has, every index in
/// range; and its buffers, each as long as declared.
struct GltfFile {
    std::filesystem::path path;
    Json json;              ///< as it stands in the file; messages quote it
    tinygltf::Model model;  ///< the same, but for buffers, images and what is left out
    struct Buffer {
        std::size_t content = 0;  ///< several may share one; BufferContents::none: not there
        std::size_t bytes = 0;
    };
    std::vector<std::string> contents;
    std::vector<Buffer> buffers;

    JsonReader root() const { return {path, json}; }
    /// The bytes of a buffer view. Throws FileError: they are not there, or not within the buffer.
    std::string_view view(std::size_t index) const;
    /// Without one, elements are zeros.
    bool has_view(const tinygltf::Accessor& accessor) const;
    /// Throws FileError about a field, "nodes[3].mesh".
    [[noreturn]] void fail(std::string field, std::string found, std::string expected) const;
};

/// Opens the bytes of a .gltf (buffers beside `file` or as data URIs) or a .glb. Checks the
/// container, the version, the required extensions and every field that is read. Throws FileError.
GltfFile open_gltf(const std::string& bytes, const std::filesystem::path& file);

/// Whether each member that is read is of the kind, within the range and, where it is an index,
/// within the array that glTF 2.0 has for it. Throws FileError that names the member.
void check_gltf_fields(const JsonReader& root);

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
    std::vector<int> types;            ///< TINYGLTF_TYPE_SCALAR, …
    std::vector<int> component_types;  ///< 5126 is float
};

/// Reads accessors, each once; sparse ones and those without a buffer view (zeros) included.
class GltfAccessors {
  public:
    explicit GltfAccessors(const GltfFile& gltf) : gltf_(gltf) {}

    const GltfNumbers& read(int index, const GltfElementRule& rule);

  private:
    struct Shape;
    Shape shape_of(int index, const GltfElementRule& rule) const;
    void overlay_sparse(int index, const Shape& shape, GltfNumbers& numbers) const;
    /// The first byte of `count` elements from `offset` in a buffer view; `place` names whose.
    const char* find_bytes(const std::string& place,
                           int view,
                           std::size_t offset,
                           std::size_t count,
                           std::size_t element_size,
                           std::size_t& stride) const;

    const GltfFile& gltf_;
    std::map<int, GltfNumbers> read_;
    std::size_t elements_read_ = 0;
};

/// An index into one of the file's arrays ("nodes"), in range.
std::size_t index_into(const JsonReader& root, std::string_view array, const JsonReader& index);

}  // namespace livery
