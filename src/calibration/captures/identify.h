// Which photograph shows which picture: told by their order and by what they show.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/bench_ports.h"

namespace livery {

/// What identifying needs of a photograph: its values at some pixels, the same of each photograph.
struct Glimpse {
    std::string name;  ///< of the file; those of one camera count up
    int width = 0, height = 0;
    std::vector<float> values;  ///< RGB, over black level, of each pixel looked at
};
Glimpse glimpse_of(const Photograph& photograph);

struct IdentifiedPhotographs {
    /// For each role, in their order: the place of its photograph; none: it is missing.
    std::vector<std::optional<std::size_t>> photograph_of_role;
    struct Odd {
        std::size_t photograph = 0;
        std::string why;  ///< "shows the same as IMG_0012.NEF", "shows none of the pictures"
    };
    std::vector<Odd> odd;  ///< photographs without a role
    /// Photographs that were found by what they show, not by their order.
    struct OutOfOrder {
        std::size_t photograph = 0, role = 0;
    };
    std::vector<OutOfOrder> out_of_order;
    bool complete() const;
};

/// `photographs` in the order in which they were taken, `roles` in that in which they were shown:
/// stripes each followed by its inverse, white and black among them. Pictures may be missing,
/// taken twice or of something else: the cheapest alignment of the two rows, in which a picture and
/// its inverse add up to white, white is the brightest, black the darkest, channels have their
/// colours, and gaps in the files' numbers are gaps in the row. What is left over is then looked at
/// by itself: a picture that was photographed later, white and black before all stripes. Throws
/// std::invalid_argument for photographs of different sizes.
IdentifiedPhotographs identify(const std::vector<Glimpse>& photographs,
                               const std::vector<std::string>& roles);

/// Whether name `a` comes before name `b`: numbers in them by their value, not by their digits.
bool comes_before(const std::string& a, const std::string& b);

/// Places of the names in the order in which a camera gives them: by comes_before(), and after
/// 9999 it counts from 0 or 1 again.
std::vector<std::size_t> order_of_names(const std::vector<std::string>& names);

}  // namespace livery
