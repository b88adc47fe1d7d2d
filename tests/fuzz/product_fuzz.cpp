#include "fuzz/fuzz.h"
#include "scene/product.h"

LIVERY_FUZZ(text) { livery::parse_product_file(text, "/no folder/a.json"); }
