// One row of the price of accuracy: a level of an effect on a scene, all other effects held at
// their dearest; or a quality as it is. Rows are kept by what they depend on, so that a run goes on
// where another one stopped, and runs on several machines are put together.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ledger/accuracy/scenes.h"
#include "ledger/accuracy/truth.h"
#include "scene/effects.h"

namespace livery {

/// What rows of a named quality have in the place of an effect.
inline constexpr const char* kQualityRows = "quality";

struct AccuracyRow {
    std::string scene;
    std::string effect;  ///< of effect_table(), or kQualityRows
    std::string level;
    int index = 0;  ///< of the level, rising in cost
    EffectLevels levels;
    /// Nothing that the scene shows depends on the effect: neither error nor time is measured.
    bool called_for = true;
    double own_ms = 0.0;    ///< the effect's own passes
    double solve_ms = 0.0;  ///< all that a new light takes
    double swap_ms = 0.0;   ///< all parts shaded and mixed anew
    double fragments = 0.0;
    ErrorStatistics error;  ///< CIEDE2000 against the path tracer, over the whole product
    double p99 = 0.0;
    double floor_median = 0.0, floor_p95 = 0.0, floor_p99 = 0.0;  ///< of the truth itself
};

/// Every row that a ledger of these scenes has, not measured yet.
std::vector<AccuracyRow> rows_to_measure(const std::vector<AccuracyScene>& scenes);

/// Draws and compares; needs a current OpenGL context. One instance for the rows of one scene,
/// whose surface maps it makes once; all else is solved anew for each row, so that it can be timed.
class RowMeasurement {
  public:
    RowMeasurement(const AccuracyScene& scene, const Truth& truth);
    ~RowMeasurement();
    AccuracyRow measured(const AccuracyRow& row, const Progress& progress = {});

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Of the program's own file: what another one drew is not what this one draws.
const std::string& program_hash();

/// What a row depends on: its scene's truth, its levels, the program and the machine.
std::string hash_of(const AccuracyRow& row, const std::string& truth_hash);
std::optional<AccuracyRow> read_row(const std::filesystem::path& folder, const std::string& hash);
void write_row(const std::filesystem::path& folder,
               const std::string& hash,
               const AccuracyRow& row);

}  // namespace livery
