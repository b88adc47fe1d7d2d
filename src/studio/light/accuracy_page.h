// What accuracy costs, as a page of the window: each level's error beside its time, as they were
// measured on this machine or shipped, and measured anew while one looks on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ledger/accuracy/accuracy_thread.h"

namespace livery {

struct Studio;

struct AccuracyPage {
    bool open = false;
    std::unique_ptr<AccuracyThread> thread;  ///< none: nobody asked yet
    std::shared_ptr<const AccuracyLedger> shown;
    bool measured_here = false;
    std::vector<AccuracyLevel> levels;  ///< of what is shown
    std::vector<bool> on_front;
    int pointed = -1;     ///< at the level of a row or a mark; -1: at none
    std::string problem;  ///< why nothing is shown
};

void show_accuracy_page(Studio& studio, bool open);
bool is_measuring_accuracy(const Studio& studio);
/// Nothing unless it is open.
void draw_accuracy_page(Studio& studio);

}  // namespace livery
