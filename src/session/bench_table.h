// The speed bench in words: for the terminal, and as Markdown for docs/performance.md.
#pragma once

#include <filesystem>
#include <string>

#include "session/speed_bench.h"

namespace livery {

std::string text_of(const SpeedBenchResult& result);

/// Tables of the sweep, the stages and the desktop.
std::string markdown_of(const SpeedBenchResult& result);

/// Puts `markdown` between the lines `<!-- bench: begin -->` and `<!-- bench: end -->` of a file.
/// Throws FileError for a file without them.
void replace_bench_block(const std::filesystem::path& file, const std::string& markdown);
/// Throws FileError as replace_bench_block() would, and changes nothing.
void check_bench_block(const std::filesystem::path& file);

}  // namespace livery
