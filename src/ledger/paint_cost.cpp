#include "ledger/paint_cost.h"

#include <fmt/format.h>

#include "appearance/model_table.h"

namespace livery {

PaintCost paint_cost(const Material& material, const std::vector<PassCost>& costs) {
    const PassId shading(PassKind::shade, "", material.model, has_glints(material));
    for (const PassCost& cost : costs) {
        if (cost.pass == shading && cost.work_items > 0.0) {
            return {1e6 * cost.ms / cost.work_items, ""};
        }
    }
    return {std::nullopt,
            fmt::format("nobody has timed {}{}",
                        model_info(material.model).name,
                        shading.glints ? "+glints" : "")};
}

}  // namespace livery
