// The compensation in OpenGL, gamut mapping and statistics included; the CPU's compensate() is its
// oracle.
#pragma once

#include <memory>

#include "compensation/compensation.h"
#include "gl/handles.h"

namespace livery {

/// What a run counts, where it was counted. A show keeps them: nothing is made for a frame.
class CompensationCounts {
  public:
    CompensationCounts();

    /// Waits until the run that counted last is done. `covered_pixels` is count_covered().
    CompensationStats read(std::size_t covered_pixels) const;

  private:
    friend class GpuCompensation;
    Buffer buffer_;
};

/// Needs a current OpenGL context, the same for its whole life.
class GpuCompensation {
  public:
    GpuCompensation();
    explicit GpuCompensation(const CompensationTable& table);
    ~GpuCompensation();
    GpuCompensation(const GpuCompensation&) = delete;
    GpuCompensation& operator=(const GpuCompensation&) = delete;

    /// Another table from here on; a program is compiled for its kind when it is the first of it.
    /// Throws Refused for one with more pixels than this OpenGL's storage blocks hold.
    void use(const CompensationTable& table);
    int programs() const;  ///< compiled so far

    /// Reads the radiance texture (RGBA16F, working space, coverage in alpha, of the table's size),
    /// writes the whole of `drive` (RGBA8). Throws std::invalid_argument on another size or format.
    void run(unsigned radiance_texture, Texture2D& drive, CompensationCounts& counts);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
