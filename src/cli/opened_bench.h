// A camera and a projector for commands that take a photograph or two.
#pragma once

#include <memory>
#include <string>

#include "cli/monitor_projector.h"
#include "core/bench_ports.h"
#include "jobs/capture_bench.h"

namespace livery {

/// The ports live as long as it does.
struct OpenedBench {
    CaptureBench bench;
    std::unique_ptr<MonitorProjector> projector;  ///< null: the simulated bench's own
    BenchPorts ports;                             ///< to show and to photograph
    std::string projector_words() const { return projector ? projector->words() : ""; }
};

/// `camera` as livery capture has it, `monitor` empty for a simulated bench. Throws
/// std::invalid_argument for a folder and without a monitor, and as open_capture_bench().
OpenedBench open_bench(const std::string& camera,
                       const std::string& monitor,
                       std::shared_ptr<const Product> product,
                       const Progress& progress);

}  // namespace livery
