// The bytes of a glTF file: a GLB's chunks, and what its URIs name. Internal to mesh/.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/json.h"

namespace livery {

struct GlbChunks {
    std::string json;
    std::optional<std::string> binary;
};
/// Throws FileError that names the header or the chunk.
GlbChunks split_glb(const std::string& bytes, const std::filesystem::path& file);

/// What a URI names: bytes inside it, a file beside the model or below its folder, or neither where
/// it is not to be opened (on the network, absolute, above the folder).
struct GltfUri {
    std::optional<std::string> inside;
    std::optional<std::filesystem::path> beside;
};
/// Throws FileError: not base64, a wrong %.
GltfUri resolve_gltf_uri(const JsonReader& uri);

/// The contents of buffers: a file that several of them name is read once, as far as the longest
/// of them goes.
class BufferContents {
  public:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    /// `contents` is filled; `binary` is a GLB's second chunk.
    BufferContents(std::filesystem::path gltf,
                   std::optional<std::string> binary,
                   std::vector<std::string>& contents)
        : gltf_(std::move(gltf)), binary_(std::move(binary)), contents_(contents) {}

    /// Which of the contents a buffer is, of which `declared` bytes are wanted; `none` where it
    /// names nothing, or nothing that is to be opened. Throws FileError.
    std::size_t find(const JsonReader& buffer, std::size_t index, std::size_t declared);

  private:
    /// As much as is wanted of a file that may hold more; all of one that holds less.
    std::string read_wanted(const std::filesystem::path& file, std::size_t declared) const;
    std::size_t add(std::string bytes);
    void count(std::size_t bytes);

    std::filesystem::path gltf_;
    std::optional<std::string> binary_;
    std::vector<std::string>& contents_;
    std::map<std::filesystem::path, std::size_t> of_file_;
    std::size_t bytes_ = 0;
};

}  // namespace livery
