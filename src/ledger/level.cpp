#include "ledger/level.h"

#include <algorithm>

namespace livery {

LedgerLevel level_of(const std::string& name, std::vector<double> ms) {
    std::sort(ms.begin(), ms.end());
    LedgerLevel level;
    level.name = name;
    level.ms = ms[ms.size() / 2];
    level.fastest_ms = ms.front();
    level.repeats = static_cast<int>(ms.size());
    return level;
}

LedgerLevel waited_level_of(const std::string& name, std::vector<double> ms) {
    std::sort(ms.begin(), ms.end());
    LedgerLevel level = level_of(name, ms);
    level.p95_ms = ms[ms.size() * 95 / 100];
    level.longest_ms = ms.back();
    return level;
}

}  // namespace livery
