#include "fuzz/fuzz.h"
#include "scene/product.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const std::filesystem::path file = "/no folder/a.json";
    const std::string written = text_of(parse_product_file(text, file), file);
    fuzz::require(text_of(parse_product_file(written, file), file) == written,
                  "what is written is read");
}
