// The paints that people choose from by name: the shipped ones, then the user's own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "appearance/material.h"

namespace livery {

/// Where the user's own paints lie (`materials` in the user's folder); need not exist.
std::filesystem::path user_materials_folder();

/// The families of the shipped paints, in the order in which they are shown.
const std::vector<std::string>& paint_families();

/// As a file was when it was looked at; the size is -1 where there was none.
struct FileStamp {
    std::filesystem::file_time_type changed_at{};
    std::int64_t bytes = -1;
    bool operator==(const FileStamp&) const = default;
};

/// A paint that is named by its file.
struct PaintFile {
    Material material;
    std::string problem;  ///< why there is none; empty: there is
};

/// All paints that a name can mean, as they were at one moment: never changed once it is made, so
/// that threads and documents share it. What a measured paint was measured in takes a second to
/// read; until somebody asks for that (read_paint_library) the paint is there unread (is_read()).
struct PaintLibrary {
    std::vector<Material> shipped;  ///< by family, in a family by file name
    std::vector<Material> media;    ///< the shipped translucent ones, by file name
    std::vector<Material> users;    ///< by file name, all read
    std::vector<Material> unread;   ///< the user's that are not
    /// One line for each of the user's files that was left out (unreadable, or a name that another
    /// paint has), with the fix. The others are there all the same.
    std::vector<std::string> problems;
    /// Outside these folders, as far as somebody asked for them; by absolute path.
    std::map<std::filesystem::path, PaintFile> files;
    /// What was read of measured files, by absolute path; their stand-ins where it could not be.
    std::map<std::filesystem::path, std::shared_ptr<const MeasuredPaint>> measured;
    std::map<std::filesystem::path, FileStamp> stamps;  ///< of every file it was made of

    /// By name; case, hyphens and underlines do not matter. Null: none.
    const Material* find(const std::string& name) const;
    /// The names that differ least, nearest first.
    std::vector<std::string> nearest(const std::string& name, std::size_t count) const;
};

/// What a name means in a library.
struct NamedPaint {
    Material material;    ///< black where there is none, and where it is not read yet
    std::string problem;  ///< why there is none, with the nearest names; empty: there is
};
/// A paint by its name, or by its file. A file that nobody asked for yet is an unread paint.
NamedPaint look_up(const PaintLibrary& library, const std::string& name_or_file);

/// Whether a name can only be a file's: with a folder, or the ending of a material or of measured
/// reflectance.
bool names_paint_file(const std::string& name_or_file);

/// The paint as the library has read it; itself where it has not.
Material resolved(Material material, const PaintLibrary& library);

/// Reads one folder. Throws FileError (unreadable, or two of one name).
std::vector<Material> read_paint_folder(const std::filesystem::path& folder);

/// Looks at both folders, at what `before` was made of and at `wanted`: files of paints and of
/// measured reflectance, which are read. Of `before` everything measured whose file is as it was is
/// taken over, and where nothing changed `before` itself comes back. Throws FileError when a
/// shipped paint cannot be read. Any thread; without `wanted` it waits for no measured file but
/// those of `before` that changed.
std::shared_ptr<const PaintLibrary> read_paint_library(
    const std::shared_ptr<const PaintLibrary>& before = nullptr,
    const std::set<std::filesystem::path>& wanted = {});
/// The same with every paint of the user's read.
std::shared_ptr<const PaintLibrary> read_whole_paint_library();

/// For a program that runs once: a file if there is one of that name (of a material, or of measured
/// reflectance), else a paint of the library by its name, read. Throws FileError with the nearest
/// names.
Material find_material(const std::string& name_or_file, const PaintLibrary& library);
/// In the library as it is now.
Material find_material(const std::string& name_or_file);

/// "Solid-Red" and "solid red" are one name: this one.
std::string plain_paint_name(std::string name);
/// Whether two names mean the same paint.
bool same_paint_name(const std::string& a, const std::string& b);

/// Writes a paint into the user's folder under its name, and returns the file. Never replaces one.
/// Throws std::invalid_argument on an empty name or parameters out of range, Refused (with the fix)
/// when the library has a paint of that name, FileError when it cannot be written.
std::filesystem::path save_to_library(const Material& material);

}  // namespace livery
