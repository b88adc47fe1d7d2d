// Where shipped data and the user's data lie, and whole-file reading and writing.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace livery {

/// Sets the folder given by `--data`; empty clears it.
void set_data_folder(const std::filesystem::path& folder);

/// A file or folder of the shipped data ("materials", "shaders/bsdf/ggx.glsl", "assets/car.glb"):
/// below `--data`, else LIVERY_DATA, else ../share/livery beside the program (an installation and a
/// build are laid out alike). Throws FileError that says where it looked.
std::filesystem::path shipped_path(const std::filesystem::path& relative);

/// Names of the JSON files in a folder of the shipped data, without ".json", sorted: what people
/// may type instead of a file. Throws FileError when the folder is not there.
std::vector<std::string> shipped_names(const std::filesystem::path& folder);

/// "a, b, c", for messages.
std::string list_of(const std::vector<std::string>& names);

/// The user's folder: LIVERY_HOME, else XDG_DATA_HOME/livery, else ~/.local/share/livery.
std::filesystem::path user_folder();

/// The folder of the running program.
std::filesystem::path executable_folder();

/// Whole file as bytes. Throws FileError (missing, a folder, unreadable, over `max_bytes`).
std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes = 64u << 20u);

/// Atomic: a temporary file beside it, flushed, then renamed. Throws FileError (also on a full
/// disk).
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// Creates a folder for output. Throws FileError when it cannot or when a file stands there.
void make_output_folder(const std::filesystem::path& folder);

/// The same, where a new one is nobody else's to read.
void make_private_folder(const std::filesystem::path& folder);

/// Makes an empty file that nobody else may read, or takes others' rights from one that is there.
/// What cannot be done is left to whoever opens it next.
void make_private_file(const std::filesystem::path& file);

}  // namespace livery
