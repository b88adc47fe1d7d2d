#include "radiance/lanes/lane_shading.h"

#include <vector>

namespace livery {

namespace avx2 {
LaneFunctions functions(const char* instruction_set);
}
namespace portable_four {
LaneFunctions functions(const char* instruction_set);
}

namespace {

std::vector<LaneFunctions> find_available() {
    std::vector<LaneFunctions> list;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) list.push_back(avx2::functions("avx2"));
#endif
    list.push_back(portable_four::functions("portable"));
    return list;
}

const std::vector<LaneFunctions>& all() {
    static const std::vector<LaneFunctions> list = find_available();
    return list;
}

}  // namespace

const LaneFunctions& best_lanes() { return all().front(); }

std::size_t lanes_available() { return all().size(); }

const LaneFunctions& lanes_available(std::size_t index) { return all().at(index); }

}  // namespace livery
