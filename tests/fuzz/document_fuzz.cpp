#include "fuzz/fuzz.h"
#include "session/document.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const Document document = parse_document(text, "a session");
    const std::string written = text_of(document);
    fuzz::require(text_of(parse_document(written, "again")) == written, "what is written is read");
}
