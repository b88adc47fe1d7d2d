// Which monitor is the projector, and what goes to it.
#pragma once

#include <string>

#include "studio/projector_words.h"

namespace livery {

struct Shell;

/// An empty id: none. Remembered; throws nothing, says in a notice what is in the way.
void use_projector_monitor(Shell& shell, const std::string& id);
/// The monitors that there are, and which of them is the remembered projector.
void read_monitors(Shell& shell);
/// To be called when monitors came or went, and once at the start.
void monitors_changed(Shell& shell);
void check_projector_signal(Shell& shell);
void show_monitor_numbers(Shell& shell);
/// The picture by which people see a limited-range signal, on the projector instead of the frames.
void show_signal_test(Shell& shell, bool shown);

void set_black(Shell& shell, bool black);
void set_frozen(Shell& shell, bool frozen);
bool is_black(const Shell& shell);
bool is_frozen(const Shell& shell);

ProjectorFacts projector_facts(const Shell& shell);

}  // namespace livery
