// The demo's result as figures and as one page for people.
#pragma once

#include <filesystem>

#include "core/json.h"
#include "jobs/demo.h"

namespace livery {

/// Every figure of the demo, with the names that docs/files.md fixes.
Json figures_of(const DemoResult& result);

/// report.html beside the pictures: no script, no request to anywhere.
void write_report(const std::filesystem::path& file, const DemoResult& result);

/// The same figures as a short table for a terminal.
std::string summary_of(const DemoResult& result);

}  // namespace livery
