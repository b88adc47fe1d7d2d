#include "studio/paint/chosen_part.h"

#include <algorithm>

namespace livery {

std::optional<std::size_t> chosen_part(const Studio& studio) {
    if (!studio.product || studio.product->mesh.parts.empty()) return std::nullopt;
    const auto& parts = studio.product->mesh.parts;
    if (studio.selected_part && *studio.selected_part >= 0 &&
        static_cast<std::size_t>(*studio.selected_part) < parts.size()) {
        return static_cast<std::size_t>(*studio.selected_part);
    }
    const auto body = std::find_if(
        parts.begin(), parts.end(), [](const Part& part) { return part.name == "body"; });
    return body == parts.end() ? 0 : static_cast<std::size_t>(body - parts.begin());
}

std::string worn_paint(const Look& look, const std::string& part) {
    auto found = look.parts.find(part);
    if (found == look.parts.end()) found = look.parts.find("*");
    return found == look.parts.end() ? "" : found->second;
}

}  // namespace livery
