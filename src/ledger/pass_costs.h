// What passes take: timed on this machine, or shipped with the program and scaled to it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/frame_plan.h"

namespace livery {

/// One kind of pass at one level of its effect: milliseconds are linear in its work items.
struct PassCost {
    PassId pass;            ///< as cost_key() has it
    int level = 0;          ///< of effect_of(pass); 0 where it is of none
    double ms = 0.0;        ///< for `work_items` of them
    double fixed_ms = 0.0;  ///< of which even an empty picture takes
    double work_items = 0.0;
    /// At the surface map: what its sub-samples lead to.
    std::optional<double> fragments_per_pixel;
};

/// What the cost of a pass depends on: the same of any part, artwork and light, "shade:clearcoat".
PassId cost_key(const PassId& pass);
/// Of its effect; 0 where it is of none.
int cost_level(const PassId& pass, const EffectLevels& levels);

/// Null when it was not timed at that level.
const PassCost* find_cost(const std::vector<PassCost>& costs,
                          const PassId& pass,
                          const EffectLevels& levels);
double predicted_ms(const PassCost& cost, double work_items);

enum class CostOrigin {
    shipped,   ///< timed elsewhere, scaled by the number of threads
    scaled,    ///< shipped ones, times what passes took here beside them
    measured,  ///< by `livery bench` on this machine
};
const char* to_string(CostOrigin origin);

struct PassCosts {
    std::vector<PassCost> passes;
    CostOrigin origin = CostOrigin::measured;
    std::string renderer;
    int threads = 0;  ///< that they were timed with
};

/// Where costs of this machine are kept: the user's folder.
std::filesystem::path pass_costs_file();
void write_pass_costs(const std::filesystem::path& file, const PassCosts& costs);
/// Nothing when there is no such file, or only one of a Livery that timed otherwise. Throws
/// FileError for a malformed file.
std::optional<PassCosts> read_pass_costs(const std::filesystem::path& file);
/// The same of its text.
std::optional<PassCosts> parse_pass_costs(const std::string& text,
                                          const std::filesystem::path& file);

/// Those that come with the program, for as many threads as this machine has.
PassCosts shipped_pass_costs();
/// Of pass_costs_file(), else the shipped ones. Throws FileError for a malformed file.
PassCosts known_pass_costs();

}  // namespace livery
