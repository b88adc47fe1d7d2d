// The window in which a problem report is put together, read and saved.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "studio/report/problem_report.h"

namespace livery {

struct Studio;

struct ReportWindowState {
    struct Gathered {
        std::shared_ptr<const std::vector<ReportFile>> devices, report;
    };

    bool open = false;
    ReportRequest request;  ///< the ticks, and what the window is drawn with
    std::shared_ptr<const std::vector<ReportFile>> devices;  ///< null: not asked yet
    std::shared_ptr<const std::vector<ReportFile>> report;   ///< null: it is being gathered
    std::string chosen = "README.txt";                       ///< file that is read
    std::filesystem::path saved;                             ///< empty: not yet
    std::string problem;                                     ///< why it was not saved or opened

    std::atomic<bool> stop{false};
    bool ticks_changed = false;  ///< while it was gathered
    std::future<Gathered> gathering;
    std::future<std::filesystem::path> saving;

    ReportWindowState() = default;
    ReportWindowState(const ReportWindowState&) = delete;
    ReportWindowState& operator=(const ReportWindowState&) = delete;
    ~ReportWindowState() { stop = true; }  // which the futures then wait for, a moment
};

/// Opens it, with everything asked anew, or closes it.
void show_report_window(Studio& studio, bool open);

/// Something changes in it by itself.
bool is_gathering_report(const Studio& studio);

/// "closed", "gathering", "ready", "saving" or "saved".
const char* state_of_report(const Studio& studio);

void draw_report_window(Studio& studio);

}  // namespace livery
