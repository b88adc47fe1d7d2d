#include "radiance/lanes/lane_functions.h"

#include <vector>

namespace livery {

// Of each unit (lane_shading.inc, mirror_sums.inc).
#define LIVERY_LANE_UNIT(name)                                                    \
    namespace name {                                                              \
    LaneFunction shading_of(const char* prepared, bool environment, bool glints); \
    void sum_mirrored(const MirrorSumJob& job);                                   \
    void look_up_mirrored(const MirrorLookUpJob& job);                            \
    }
LIVERY_LANE_UNIT(avx2)
LIVERY_LANE_UNIT(portable)
LIVERY_LANE_UNIT(portable_four)

namespace {

const std::vector<LaneFunctions>& all() {
    static const std::vector<LaneFunctions> list = [] {
        std::vector<LaneFunctions> available;
#if defined(__x86_64__)
        if (__builtin_cpu_supports("avx2")) {
            available.push_back(
                {"avx2", avx2::shading_of, avx2::sum_mirrored, avx2::look_up_mirrored});
        }
#endif
        available.push_back({"portable",
                             portable_four::shading_of,
                             portable::sum_mirrored,
                             portable::look_up_mirrored});
        return available;
    }();
    return list;
}

}  // namespace

const LaneFunctions& best_lanes() { return all().front(); }

std::size_t lanes_available() { return all().size(); }

const LaneFunctions& lanes_available(std::size_t index) { return all().at(index); }

}  // namespace livery
