// The compensation as an OpenGL fragment pass; the CPU's compensate() is its oracle.
#pragma once

#include <memory>

#include "compensation/compensation.h"

namespace livery {

/// Needs a current OpenGL context, the same for its whole life.
class GpuCompensation {
  public:
    /// Throws std::invalid_argument for a table with a gamut mapping, which this pass does not
    /// have.
    explicit GpuCompensation(const CompensationTable& table);
    ~GpuCompensation();
    GpuCompensation(const GpuCompensation&) = delete;
    GpuCompensation& operator=(const GpuCompensation&) = delete;

    /// Reads the radiance texture (RGBA16F, working space, coverage in alpha), writes projector
    /// input into texture().
    void run(unsigned radiance_texture);
    unsigned texture() const;  ///< RGBA8
    Image8 read_back() const;  ///< 3 channels

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
