// The paints that people choose from by name: the shipped ones, then the user's own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "appearance/material.h"

namespace livery {

/// Where the user's own paints lie (`materials` in the user's folder); need not exist.
std::filesystem::path user_materials_folder();

/// The families of the shipped paints, in the order in which they are shown.
const std::vector<std::string>& paint_families();

struct PaintLibrary {
    std::vector<Material> shipped;  ///< by family, in a family by file name
    std::vector<Material> users;    ///< by file name
    /// One line for each of the user's files that was left out (unreadable, or a name that another
    /// paint has), with the fix. The others are there all the same.
    std::vector<std::string> problems;
    /// Measured files of the user's paints that were left out because they were not to be waited
    /// for (OnlyMeasuredInMemory); empty otherwise.
    std::vector<std::filesystem::path> unread;

    /// By name; case, hyphens and underlines do not matter. Null: none.
    const Material* find(const std::string& name) const;
    /// The names that differ least, nearest first.
    std::vector<std::string> nearest(const std::string& name, std::size_t count) const;
};

/// Reads the shipped paints alone. Throws FileError.
std::vector<Material> read_shipped_paints();

/// Reads both folders. Throws FileError when a shipped paint cannot be read.
PaintLibrary read_paint_library();

/// "Solid-Red" and "solid red" are one name: this one.
std::string plain_paint_name(std::string name);
/// Whether two names mean the same paint.
bool same_paint_name(const std::string& a, const std::string& b);

/// Writes a paint into the user's folder under its name, and returns the file. Never replaces one.
/// Throws std::invalid_argument on an empty name or parameters out of range, Refused (with the fix)
/// when the library has a paint of that name, FileError when it cannot be written.
std::filesystem::path save_to_library(const Material& material);

}  // namespace livery
