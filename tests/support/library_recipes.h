// Where the library's measured paints come from: which table each was fitted to, with which models.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "appearance/fit/fit_search.h"
#include "appearance/material.h"

namespace livery {

enum class PaintSource {
    sgd,     ///< a MERL material by Bagher, Soler and Holzschuch's parameters
    abc,     ///< a MERL material by Low, Kronander, Ynnerman and Unger's
    cornell  ///< a file of Cornell's Light Measurement Laboratory
};

struct LibraryRecipe {
    const char* name;    ///< of ours: "dark blue"
    const char* family;  ///< "solid"
    PaintSource source;
    const char* source_name;               ///< "dark-blue-paint", or a file without its suffix
    std::vector<ReflectanceModel> models;  ///< the one with the smallest error is shipped
    int flake_um = 0;  ///< designed: flakes of this size, one layer of which glints; 0: none
};

/// Every shipped paint of measured origin.
const std::vector<LibraryRecipe>& library_recipes();

/// What a recipe's paint is fitted to.
struct RecipeTruth {
    ReflectanceFunction value_working;
    FitSamples samples;
    std::string origin;  ///< "measured: ..., by ..."
};
/// Throws FileError, std::invalid_argument for a name that the tables do not have.
RecipeTruth truth_of(const LibraryRecipe& recipe, const std::filesystem::path& reference_data);

/// "CIEDE2000 0.85 in the mean over a lit sphere, 2.6 for 95% of it", as provenances end.
std::string stated_error(const ReflectanceDifference& difference);
/// The mean of such a text; negative when there is none.
double stated_mean_of(const std::string& provenance);

}  // namespace livery
