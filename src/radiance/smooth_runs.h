// What fragments share with their neighbours: rays toward one surface, and all that changes so
// slowly over it that it is worked out at some and mixed between.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radiance/surface_map.h"

namespace livery {

/// Every block of 4 x 2 pixels has one fragment of each turn.
inline constexpr std::size_t kNeighbourTurns = 8;
std::size_t neighbour_turn(const SurfaceMap& map, std::size_t fragment);

/// Finds, around a fragment, those that continue its surface.
class FragmentNeighbours {
  public:
    explicit FragmentNeighbours(const SurfaceMap& map);

    struct Neighbour {
        std::size_t fragment = 0;
        std::size_t turn = 0;
        float weight = 0.0f;  ///< falls off with distance
    };
    /// The fragment itself and those up to two pixels away: of its part, in its tangent plane.
    void around(std::size_t fragment, std::vector<Neighbour>& found) const;

  private:
    const SurfaceMap& map_;
    std::vector<std::uint32_t> first_;   ///< of each pixel among sorted_, and one more
    std::vector<std::uint32_t> sorted_;  ///< fragments by pixel
};

/// Of each fragment, which two its value lies between: in its row, or in its column between two
/// rows of which the same is true. They and all between them are whole pixels of one part, whose
/// normals turn by less than some degrees, so that no reflection moves by more than twice that. A
/// fragment that shares its pixel may take its value from one of its part beside it.
class SmoothRuns {
  public:
    /// From end to end, powers of 2 up to 128; 1: none.
    struct Limits {
        std::uint32_t longest_px = 4, highest_px = 2;
        double turn_deg = 1.0;
        /// Fragments that share their pixel look for another one in a block of such a side, of
        /// which nothing lies on the other side: normals turn by as much less. 1: none.
        std::uint32_t beside_px = 1;
    };
    explicit SmoothRuns(const SurfaceMap& map) : SmoothRuns(map, Limits()) {}
    SmoothRuns(const SurfaceMap& map, const Limits& limits);

    /// Whether its value is its own.
    bool is_end(std::size_t fragment) const { return runs_[fragment].before == 0; }
    /// The two that a fragment lies between, and the share of the second.
    struct Between {
        std::size_t first = 0, second = 0;
        float share = 0.0f;
    };
    /// Those of columns lie between what rows have: one after the other. What has its value from
    /// beside counts as one of a column.
    enum class Line { row, column };
    static constexpr std::array<Line, 2> kLines{Line::row, Line::column};
    /// `from(fragment, between)` for each one from `begin` to `end` that lies in such a line.
    template <typename From>
    void between(Line line, std::size_t begin, std::size_t end, const From& from) const;
    /// Those of a stretch whose values are their own, in their order; then the others.
    template <typename Own>
    void ends(std::size_t begin, std::size_t end, const Own& own) const {
        for (std::size_t i = begin; i < end; ++i) {
            if (is_end(i)) own(i);
        }
    }

  private:
    static constexpr std::uint8_t kInColumn = 0xff;
    struct Run {
        std::uint8_t before = 0, after = 0;  ///< fragments to the left one and to the right one
    };
    struct Column {
        std::uint32_t fragment = 0, above = 0, below = 0;
        float share = 0.0f;
    };
    /// By fragment, those that runs_ says are in a column.
    using Columns = std::vector<Column>;
    void find_columns(const SurfaceMap& map,
                      std::uint32_t highest,
                      float least_cosine,
                      Columns& found);
    void find_rows(const SurfaceMap& map, std::uint32_t longest, float least_cosine);
    void find_beside(const SurfaceMap& map, std::uint32_t side, float least_cosine, Columns& found);

    std::vector<Run> runs_;
    std::vector<Column> columns_;  ///< in the fragments' order
};

template <typename From>
void SmoothRuns::between(Line line, std::size_t begin, std::size_t end, const From& from) const {
    if (line == Line::column) {
        auto at = std::lower_bound(
            columns_.begin(), columns_.end(), begin, [](const Column& one, std::size_t fragment) {
                return one.fragment < fragment;
            });
        for (; at != columns_.end() && at->fragment < end; ++at) {
            from(std::size_t{at->fragment}, Between{at->above, at->below, at->share});
        }
        return;
    }
    for (std::size_t i = begin; i < end; ++i) {
        const Run run = runs_[i];
        if (run.before == 0 || run.before == kInColumn) continue;
        const std::size_t first = i - run.before;
        const float length = static_cast<float>(run.before + run.after);
        from(i, Between{first, i + run.after, static_cast<float>(run.before) / length});
    }
}

}  // namespace livery
