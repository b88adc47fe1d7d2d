#include "studio/presenting/round_eye.h"

#include <algorithm>
#include <exception>

#include "studio/presenting/presenting.h"
#include "studio/seats/seat_maps.h"
#include "studio/seats/seats_panel.h"

namespace livery {

namespace {

/// The session's look of each design of the round; 0: none has its name any more.
std::vector<int> looks_of(const Studio& studio, const Round& round) {
    std::vector<int> looks;
    for (const std::string& name : round.designs) {
        const auto& all = studio.session.document().looks;
        const auto found = std::find_if(all.begin(), all.end(), [&](const SessionLook& look) {
            return look.look.name == name;
        });
        looks.push_back(found == all.end() ? 0 : found->id);
    }
    return looks;
}

/// Whose figures are still to come: nothing without details, seats and looks.
const PresentedRound* to_record(const Studio& studio) {
    const auto& presented = presenting(studio).presented;
    if (!presented || presented->details.looks.empty() || !presented->details.eye) return nullptr;
    const RoundEye& eye = *presented->details.eye;
    const bool open = std::any_of(eye.seats.begin(), eye.seats.end(), [](const RoundSeat& seat) {
        return seat.looks.empty();
    });
    // As they were when the looks were frozen: another session's would be others.
    const bool same = eye == [&] {
        RoundEye now = eye_of_round(studio.session.document());
        for (std::size_t k = 0; k < std::min(now.seats.size(), eye.seats.size()); ++k) {
            now.seats[k].looks = eye.seats[k].looks;
        }
        return now;
    }();
    return open && same ? &*presented : nullptr;
}

void warn(Studio& studio, const std::vector<SeatSees>& all) {
    const std::string unfair = unfair_in_words(all);
    if (unfair.empty()) return;
    notify(studio,
           {Notice::Level::warning,
            unfair,
            "Whoever sits there judges something else.",
            "Abort the round, then move the eye or those seats, or let them vote in waves."});
}

void write(Studio& studio, const PresentedRound& presented) {
    if (!studio.background || !studio.ballots) return;
    studio.background->run(
        [file = round_details_file(studio.ballots->file(), presented.round.id),
         id = presented.round.id,
         details = presented.details](const Progress&) -> Background::Then {
            write_round_details(file, id, details);
            return [] {};
        },
        [&studio](std::exception_ptr why) {
            notify_failure(studio, "What the seats miss was not kept for the round's report.", why);
        });
}

}  // namespace

RoundEye eye_of_round(const Document& document) {
    RoundEye eye;
    eye.of = in_words(document.seats, document.eye_choice);
    eye.eye_mm = eye_in_use_mm(document);
    for (const EyeSeat& seat : document.seats) {
        eye.seats.push_back({seat.number, seat.eye_mm, seat.counts, {}});
    }
    return eye;
}

std::vector<int> looks_to_record(const Studio& studio) {
    const PresentedRound* presented = to_record(studio);
    if (!presented) return {};
    std::vector<int> looks = looks_of(studio, presented->round);
    std::erase(looks, 0);
    return looks;
}

void record_seat_errors(Studio& studio) {
    const auto& results = studio.panels.of<SeatsPanelState>().results;
    if (!results || results->number != studio.panels.of<SeatsPanelState>().number ||
        !to_record(studio))
        return;
    PresentedRound& presented = *presenting(studio).presented;
    const std::vector<int> looks = looks_of(studio, presented.round);
    if (std::find(looks.begin(), looks.end(), 0) != looks.end()) return;
    const auto& seats = studio.session.document().seats;
    const auto all = worst_looks(*results, seats, looks);
    if (all.size() != seats.size()) return;
    for (RoundSeat& seat : presented.details.eye->seats) {
        for (std::size_t k = 0; k < looks.size(); ++k) {
            const SeatError& error = results->looks.at(looks[k]).at(seat.seat).error;
            seat.looks.push_back(
                {presented.round.codes.at(k), error.de00_median, error.de00_p95, error.share_over});
        }
    }
    warn(studio, all);
    write(studio, presented);
}

}  // namespace livery
