#include "core/json.h"
#include "studio/report/session_parts.h"

namespace livery {

std::string session_part(const Document* document) {
    return (document ? Json::parse(text_of(*document)) : Json()).dump(2) + "\n";
}

}  // namespace livery
