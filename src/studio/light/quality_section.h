// Quality: a named one, levels for a budget, or each effect's own level with its price.
#pragma once

namespace livery {

struct Studio;

void draw_quality_section(Studio& studio);

}  // namespace livery
