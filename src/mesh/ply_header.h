// What a PLY file says that it holds. Internal to mesh/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace livery {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
bool is_whole(PlyType type);
std::size_t size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;  ///< of a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::string_view body;            ///< of the bytes, after "end_header"
    std::size_t body_first_line = 1;  ///< lines count from 1
};

/// Refuses what the rest of the bytes cannot hold, before anybody asks for memory. Throws
/// FileError.
PlyHeader read_ply_header(std::string_view bytes, const std::filesystem::path& file);

}  // namespace livery
