#include "evaluation/tally.h"

#include "core/error.h"
#include "evaluation/csv_field.h"

namespace livery {

std::string tally_csv(const Tally& tally) {
    const bool least = !tally.least.empty();
    check_argument(tally.best.size() == tally.designs.size() &&
                       tally.second.size() == tally.designs.size() &&
                       (!least || tally.least.size() == tally.designs.size()),
                   "tally_csv: " + std::to_string(tally.designs.size()) + " designs, " +
                       std::to_string(tally.best.size()) + " and " +
                       std::to_string(tally.second.size()) + " counts");
    std::string text = least ? "design,best,second,least\r\n" : "design,best,second\r\n";
    for (std::size_t k = 0; k < tally.designs.size(); ++k) {
        text += csv_field(tally.designs[k]) + ',' + std::to_string(tally.best[k]) + ',' +
                std::to_string(tally.second[k]) +
                (least ? ',' + std::to_string(tally.least[k]) : std::string()) + "\r\n";
    }
    return text;
}

}  // namespace livery
