#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "studio/seats/seat_maps.h"

namespace livery {

std::vector<SeatSees> worst_looks(const SeatErrorResults& results,
                                  const std::vector<EyeSeat>& seats,
                                  const std::vector<int>& looks) {
    std::vector<SeatSees> all;
    for (const EyeSeat& seat : seats) {
        SeatSees worst{seat.number, 0, {}};
        bool known = !looks.empty();
        for (const int look : looks) {
            const auto of_look = results.looks.find(look);
            if (of_look == results.looks.end()) {
                known = false;
                break;
            }
            const auto found = of_look->second.find(seat.number);
            if (found == of_look->second.end()) {
                known = false;
                break;
            }
            const SeatError& error = found->second.error;
            if (worst.look == 0 || error.share_over > worst.error.share_over ||
                (error.share_over == worst.error.share_over &&
                 error.de00_p95 > worst.error.de00_p95)) {
                worst = {seat.number, look, error};
            }
        }
        if (known) all.push_back(worst);
    }
    return all;
}

std::string in_words(const SeatSees& sees) {
    const SeatError& error = sees.error;
    if (error.de00_p95 <= kFairSeatDe00) {
        return fmt::format(
            "Seat {} sees what it should: 95% within {:.1f}.", sees.seat, error.de00_p95);
    }
    return fmt::format("Seat {} sees highlights where none should be: 95% within CIEDE2000 {:.1f}.",
                       sees.seat,
                       error.de00_p95);
}

std::string unfair_in_words(const std::vector<SeatSees>& all) {
    std::vector<int> seats;
    double most = 0.0;
    for (const SeatSees& sees : all) {
        if (is_fair(sees.error)) continue;
        seats.push_back(sees.seat);
        most = std::max(most, sees.error.share_over);
    }
    if (seats.empty()) return "";
    const bool one = seats.size() == 1;
    return fmt::format(
        "{} {} {} other looks than {} should: up to {:.0f}% of one is more than 3 (CIEDE2000) off.",
        one ? "Seat" : "Seats",
        fmt::join(seats, ", "),
        one ? "sees" : "see",
        one ? "it" : "they",
        100.0 * most);
}

}  // namespace livery
