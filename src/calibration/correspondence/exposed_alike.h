// The photographs of a role as one picture, comparable with those of the other roles.
#pragma once

#include "calibration/correspondence/gray_code.h"

namespace livery {

/// Mean of the channels, NaN where one of them is at 98% of full scale or more: of a clipped fringe
/// nothing can be said, while stripes are read by their signs.
ImageF unsaturated_mean(const Photograph& photograph);

/// Mean over the photographs of `role` and their channels, in file units as if exposed like `like`;
/// one channel; fringes are NaN where they are saturated. Throws FileError for another size than
/// like's, std::invalid_argument where there is no such photograph.
ImageF exposed_alike(const std::vector<RoledPhotograph>& photographs,
                     const std::string& role,
                     const RoledPhotograph& like);

}  // namespace livery
