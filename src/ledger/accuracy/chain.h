// The rest of the way from a scene to the eye, beside the renderer's effects (accuracy.h): what
// half floats, 8 bits, the correction, three channels for a spectrum and the artwork's filter make
// of colours. docs/accuracy.md holds the table.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "ledger/accuracy/accuracy.h"
#include "ledger/level.h"

namespace livery {

/// A level of one step, and how far it is from what it is compared with.
struct ChainRow {
    std::string what;                           ///< "8 bits, solid red"
    std::string level;                          ///< "dithered"
    std::string against;                        ///< "the exact drive"
    std::optional<double> ms{};                 ///< where the level takes time of its own
    std::size_t compared = 0;                   ///< pixels, paints or pairs of paints
    double median = 0.0, p95 = 0.0, p99 = 0.0;  ///< CIEDE2000
    std::string missing{};                      ///< why it is not measured; empty: it is
};

/// Takes their statistics into a row; what is no number counts as infinitely far off.
void set_errors(ChainRow& row, const std::vector<float>& errors);

/// Rows that are measured, and kept, together.
struct ChainPart {
    std::vector<ChainRow> rows;           ///< what they are, not measured yet
    bool slow = false;                    ///< --quick leaves it out where it is not kept
    std::function<std::string()> inputs;  ///< hash of what they depend on beside the program
    std::function<void(std::vector<ChainRow>& rows, const Progress& progress)> measure;
};
std::vector<ChainPart> chain_parts(const AccuracyOptions& options);

struct ChainLedger {
    std::string renderer;
    std::vector<ChainRow> rows;
};

/// Every row, those that are kept in the options' folder as they are. Throws FileError where that
/// cannot be written. A stop loses one part at most: the next run goes on with the rest.
ChainLedger measure_chain(const AccuracyOptions& options, const Progress& progress = {});
/// The same of any parts, in the current OpenGL context.
std::vector<ChainRow> measured_rows(const std::vector<ChainPart>& parts,
                                    const AccuracyOptions& options,
                                    const Progress& progress = {});

std::string hash_of(const ChainPart& part);
/// Nothing where they are not kept. Throws FileError for a malformed file.
std::optional<std::vector<ChainRow>> read_chain_rows(const std::filesystem::path& folder,
                                                     const std::string& hash);
/// What no file can hold, an error without an end, is not kept and measured again.
void write_chain_rows(const std::filesystem::path& folder,
                      const std::string& hash,
                      const std::vector<ChainRow>& rows);

/// In the order of the rows, one for each `what`; what takes no time of its own has no repeats.
std::vector<LedgerEffect> effects_of(const ChainLedger& ledger);
std::string markdown_of(const ChainLedger& ledger);
std::string csv_of(const ChainLedger& ledger);

}  // namespace livery
