// Which output of Xwayland is which of Mutter's monitors.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "projection/mutter_state.h"
#include "projection/outputs.h"

namespace livery {

/// Connectors by RandR's output, as found so far.
using KnownConnectors = std::map<std::uint32_t, std::string>;

/// Gives outputs of Xwayland the names, identities, modes, scales and transforms that Mutter tells.
/// Since version 23.1 Xwayland names an output after its connector. Else an output is found as it
/// was before (it is the same monitor's for as long as Xwayland has it, wherever that is moved), or
/// by its place and size, which must be one monitor's alone; `known` gains it. Mirrored monitors
/// have one place: until they are apart they are named in the order of both lists. What is not
/// found stays as it is, with no mode.
void name_outputs_after(const MutterState& state,
                        std::vector<Output>& outputs,
                        KnownConnectors& known);

}  // namespace livery
