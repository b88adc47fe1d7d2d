#include "core/system/zip_file.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>

#include <zlib.h>

#include "core/error.h"

namespace livery {

namespace {

constexpr std::size_t kLargestArchive_bytes = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMost16 = std::numeric_limits<std::uint16_t>::max();
constexpr unsigned kVersion = 20;  // Of the format: deflated files, folders.
constexpr unsigned kMadeOnUnix = 3u << 8u;
constexpr unsigned kUtf8Names = 1u << 11u;
constexpr unsigned kStored = 0, kDeflated = 8;
constexpr std::uint32_t kRegularFile = 0100644u << 16u;  // Rights as Unix has them.

void append_number(std::string& bytes, std::uint64_t value, int count) {
    for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xffu);
}

/// Deflated without a header of zlib's own.
std::string deflated(const std::string& bytes) {
    z_stream stream{};
    if (::deflateInit2(
            &stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) !=
        Z_OK) {
        throw std::bad_alloc();
    }
    std::string packed(::deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    ::deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    ::deflateEnd(&stream);
    return packed;
}

/// Date and time as MS-DOS has them: two seconds fine, from 1980 on.
std::uint32_t dos_time(std::time_t changed) {
    std::tm parts{};
    ::localtime_r(&changed, &parts);
    const auto of = [](int value) { return static_cast<std::uint32_t>(std::max(value, 0)); };
    const std::uint32_t date = std::min(of(parts.tm_year - 80), 127u) << 9u |
                               of(parts.tm_mon + 1) << 5u | of(parts.tm_mday);
    const std::uint32_t time =
        of(parts.tm_hour) << 11u | of(parts.tm_min) << 5u | of(parts.tm_sec / 2);
    return date << 16u | time;
}

void check_name(const std::string& name, std::set<std::string>& names) {
    const bool leads_out = ("/" + name + "/").find("/../") != std::string::npos;
    const bool good = !name.empty() && name.front() != '/' && name.back() != '/' &&
                      name.find('\\') == std::string::npos && !leads_out &&
                      name.size() <= kMost16 && names.insert(name).second;
    check_argument(good,
                   "zip_of: found the name \"" + name +
                       "\", expected each once, relative and within the archive");
}

}  // namespace

std::string zip_of(const std::vector<ZipEntry>& entries, std::time_t changed) {
    check_argument(entries.size() <= kMost16, "zip_of: found more than 65535 files");
    std::string archive, directory;
    std::set<std::string> names;
    const std::uint32_t time = dos_time(changed);
    for (const ZipEntry& entry : entries) {
        check_name(entry.name, names);
        check_argument(entry.bytes.size() + archive.size() < kLargestArchive_bytes - (1u << 20u),
                       "zip_of: found more than 4 GB at " + entry.name);
        const auto* content = reinterpret_cast<const Bytef*>(entry.bytes.data());
        const uLong sum = ::crc32(0, content, static_cast<uInt>(entry.bytes.size()));
        const std::string packed = deflated(entry.bytes);
        const bool packs = packed.size() < entry.bytes.size();
        const std::string& stored = packs ? packed : entry.bytes;

        // What the file's own header and the directory at the end both say.
        std::string told;
        append_number(told, kVersion, 2);
        append_number(told, kUtf8Names, 2);
        append_number(told, packs ? kDeflated : kStored, 2);
        append_number(told, time, 4);
        append_number(told, sum, 4);
        append_number(told, stored.size(), 4);
        append_number(told, entry.bytes.size(), 4);
        append_number(told, entry.name.size(), 2);
        append_number(told, 0, 2);  // no extra field

        directory += "PK\x01\x02";
        append_number(directory, kMadeOnUnix | kVersion, 2);
        directory += told;
        append_number(directory, 0, 2);  // no comment
        append_number(directory, 0, 2);  // the first disk
        append_number(directory, 0, 2);  // not known to be text
        append_number(directory, kRegularFile, 4);
        append_number(directory, archive.size(), 4);
        directory += entry.name;

        archive += "PK\x03\x04" + told + entry.name + stored;
    }
    const std::size_t directory_at = archive.size();
    archive += directory + "PK\x05\x06";
    append_number(archive, 0, 4);  // one disk
    append_number(archive, entries.size(), 2);
    append_number(archive, entries.size(), 2);
    append_number(archive, directory.size(), 4);
    append_number(archive, directory_at, 4);
    append_number(archive, 0, 2);  // no comment
    return archive;
}

}  // namespace livery
