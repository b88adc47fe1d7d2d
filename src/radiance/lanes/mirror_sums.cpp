#include "radiance/lanes/mirror_sums.h"

#include <vector>

namespace livery {

namespace avx2 {
MirrorSums mirror_sums(const char* instruction_set);
}
namespace portable {
MirrorSums mirror_sums(const char* instruction_set);
}

namespace {

const std::vector<MirrorSums>& all_sums() {
    static const std::vector<MirrorSums> list = [] {
        std::vector<MirrorSums> available;
#if defined(__x86_64__)
        if (__builtin_cpu_supports("avx2")) available.push_back(avx2::mirror_sums("avx2"));
#endif
        available.push_back(portable::mirror_sums("portable"));
        return available;
    }();
    return list;
}

}  // namespace

const MirrorSums& best_mirror_sums() { return all_sums().front(); }

std::size_t mirror_sums_available() { return all_sums().size(); }

const MirrorSums& mirror_sums_available(std::size_t index) { return all_sums().at(index); }

}  // namespace livery
