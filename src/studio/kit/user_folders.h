// Where people keep things: as their desktop has it, else their home folder.
#pragma once

#include <filesystem>

namespace livery {

std::filesystem::path home_folder();  ///< the root when the user has none
std::filesystem::path pictures_folder();
std::filesystem::path documents_folder();

}  // namespace livery
