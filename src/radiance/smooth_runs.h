// Fragments between two others of an even surface: what changes slowly over it is worked out at a
// quarter or an eighth of them, and taken from both ends in between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radiance/surface_map.h"

namespace livery {

/// Of each fragment, where in its row the two are whose values it lies between. They and all
/// between them are whole pixels of one part, whose normals turn by less than some degrees, so that
/// no reflection moves by more than twice that.
class SmoothRuns {
  public:
    struct Limits {
        std::uint32_t longest_px = 4;  ///< from end to end, a power of 2 up to 128
        double turn_deg = 1.0;
    };
    explicit SmoothRuns(const SurfaceMap& map) : SmoothRuns(map, Limits()) {}
    SmoothRuns(const SurfaceMap& map, const Limits& limits);

    /// Whether its value is its own.
    bool is_end(std::size_t fragment) const { return runs_[fragment].before == 0; }
    /// The two that a fragment lies between, and the share of the right one.
    struct Between {
        std::size_t left = 0, right = 0;
        float share = 0.0f;
    };
    /// `from(fragment, between)` for each one from `begin` to `end` that is not an end.
    template <typename From>
    void between(std::size_t begin, std::size_t end, const From& from) const {
        for (std::size_t i = begin; i < end; ++i) {
            const Run run = runs_[i];
            if (run.before == 0) continue;
            const float length = static_cast<float>(run.before + run.after);
            from(i,
                 Between{i - run.before, i + run.after, static_cast<float>(run.before) / length});
        }
    }
    /// Those of a stretch whose values are their own, in their order; then the others.
    template <typename Own>
    void ends(std::size_t begin, std::size_t end, const Own& own) const {
        for (std::size_t i = begin; i < end; ++i) {
            if (is_end(i)) own(i);
        }
    }

  private:
    struct Run {
        std::uint8_t before = 0, after = 0;  ///< fragments to the left one and to the right one
    };
    std::vector<Run> runs_;
};

}  // namespace livery
