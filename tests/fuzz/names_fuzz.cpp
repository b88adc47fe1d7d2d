#include <stdexcept>

#include "evaluation/typed_words.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    try {
        const std::string tidy = tidy_name(text);
        fuzz::require(tidy == printable(tidy), "a tidy name can be shown");
        fuzz::require(tidy_name(tidy) == tidy, "a tidy name is tidy");
        fuzz::require(name_key(tidy) == name_key(text), "one person has one key");
    } catch (const std::invalid_argument&) {
    }
}
