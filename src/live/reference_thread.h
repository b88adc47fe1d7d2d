// The path tracer beside a window: the picture on the mock-up as it should be, when somebody asks.
#pragma once

#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "compensation/compensation.h"
#include "core/image.h"
#include "live/projector_setup.h"
#include "scene/frame_plan.h"
#include "scene/scene.h"

namespace livery {

/// Halves of the 95% confidence interval that are traced for, one after the other, as shares of a
/// pixel's luminance (ReferenceOptions::error): soon one that shows no grain, then one that is
/// true.
inline constexpr double kTracedErrors[] = {0.06, 0.02};

struct TraceRequest {
    std::uint64_t number = 0;  ///< of the frame that it is of
    Scene scene;
    std::shared_ptr<const ProjectorSetup> setup;
    std::vector<double> errors = {std::begin(kTracedErrors), std::end(kTracedErrors)};
};

/// Immutable.
struct TracedFrame {
    std::uint64_t number = 0;
    double error = 0.0;                ///< of those asked for
    double unresolved_fraction = 0.0;  ///< of covered pixels, that did not reach it
    double mean_samples = 0.0;
    std::shared_ptr<const ImageF> radiance_working;  ///< R, G, B, coverage
    std::shared_ptr<const Image8> drive;             ///< projector input, 3 channels
    FramePlan plan;
    CompensationStats compensation;
    double ms_total = 0.0;
};

class ReferenceThread {
  public:
    /// `on_change` is called on the thread after every picture and at the end, and must not throw.
    explicit ReferenceThread(std::function<void()> on_change);
    ~ReferenceThread();
    ReferenceThread(const ReferenceThread&) = delete;
    ReferenceThread& operator=(const ReferenceThread&) = delete;

    /// Stops what runs and begins with this.
    void trace(TraceRequest request);
    void stop();  ///< returns at once

    struct State {
        bool running = false;
        double fraction = 0.0;                      ///< of the picture under way
        double error = 0.0;                         ///< that it will have
        std::shared_ptr<const TracedFrame> newest;  ///< null: none yet
        std::string problem;                        ///< why the last one was not finished
    };
    State state() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
