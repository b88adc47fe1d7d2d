#include "core/json.h"
#include "studio/report/problem_report.h"

namespace livery {

std::string session_part(const Document* document) {
    return (document ? Json::parse(text_of(*document)) : Json()).dump(2) + "\n";
}

}  // namespace livery
