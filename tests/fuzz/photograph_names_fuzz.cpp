#include <vector>

#include "calibration/captures/identify.h"
#include "fuzz/fuzz.h"

// Names of files that somebody's camera chose, a line each: sorting them is defined for an order
// alone, and one that is none may read beyond the list.
LIVERY_FUZZ(text) {
    using namespace livery;
    std::vector<std::string> names(1);
    for (const char c : text) {
        if (c != '\n') {
            names.back() += c;
        } else if (names.size() < 8) {
            names.emplace_back();
        }
    }
    const auto alike = [](const std::string& a, const std::string& b) {
        return !comes_before(a, b) && !comes_before(b, a);
    };
    for (const std::string& a : names) {
        fuzz::require(!comes_before(a, a), "no name comes before itself");
        for (const std::string& b : names) {
            fuzz::require(!comes_before(a, b) || !comes_before(b, a), "one of two comes first");
            for (const std::string& c : names) {
                fuzz::require(!comes_before(a, b) || !comes_before(b, c) || comes_before(a, c),
                              "what comes before comes before what follows");
                fuzz::require(!alike(a, b) || !alike(b, c) || alike(a, c), "alike is alike");
            }
        }
    }
}
