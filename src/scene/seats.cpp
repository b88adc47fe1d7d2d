#include "scene/seats.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"

namespace livery {

namespace {

constexpr double kTallestOnTable_mm = 1000.0, kLongestOnTable_mm = 2000.0;

bool is_free(const glm::dvec3& eye_mm, const std::vector<EyeSeat>& seats, double clearance_mm) {
    return std::none_of(seats.begin(), seats.end(), [&](const EyeSeat& seat) {
        return glm::distance(seat.eye_mm, eye_mm) < clearance_mm;
    });
}

/// A circle about the mock-up, at the height of seated eyes.
struct Arc {
    glm::dvec3 centre_mm{0.0};
    double radius_mm = 0.0, middle_rad = 0.0;  ///< azimuth from +z toward +x

    glm::dvec3 at(double along_mm) const {
        const double azimuth = middle_rad + along_mm / radius_mm;
        return centre_mm + radius_mm * glm::dvec3(std::sin(azimuth), 0.0, std::cos(azimuth));
    }
};

Arc arc_about(const Bounds& mockup, const glm::dvec3& toward_mm) {
    Arc arc;
    arc.centre_mm = 0.5 * (mockup.low + mockup.high);
    arc.centre_mm.y = seated_eye_height_mm(mockup);
    const glm::dvec3 size = mockup.high - mockup.low;
    arc.radius_mm = 0.5 * std::hypot(size.x, size.z) + kArm_mm;
    const glm::dvec3 toward = toward_mm - arc.centre_mm;
    if (std::hypot(toward.x, toward.z) > 1.0) arc.middle_rad = std::atan2(toward.x, toward.z);
    return arc;
}

}  // namespace

const EyeSeat* find_seat(const std::vector<EyeSeat>& seats, int number) {
    const auto found = std::find_if(
        seats.begin(), seats.end(), [&](const EyeSeat& seat) { return seat.number == number; });
    return found == seats.end() ? nullptr : &*found;
}

int free_seat_number(const std::vector<EyeSeat>& seats) {
    int number = 1;
    while (find_seat(seats, number)) ++number;
    return number;
}

std::optional<glm::dvec3> mean_eye_mm(const std::vector<EyeSeat>& seats) {
    glm::dvec3 sum(0.0);
    int count = 0;
    for (const EyeSeat& seat : seats) {
        if (!seat.counts) continue;
        sum += seat.eye_mm;
        ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
}

std::optional<std::string> seats_problem(const std::vector<EyeSeat>& seats) {
    if (seats.size() > kMostSeats) {
        return fmt::format("there are {} seats; expected at most {}", seats.size(), kMostSeats);
    }
    for (std::size_t k = 0; k < seats.size(); ++k) {
        const EyeSeat& seat = seats[k];
        if (seat.number < 1 || seat.number > kLargestSeatNumber) {
            return fmt::format(
                "a seat's number is {}; expected 1 to {}", seat.number, kLargestSeatNumber);
        }
        for (int c = 0; c < 3; ++c) {
            if (std::abs(seat.eye_mm[c]) <= kFarthestEye_mm) continue;
            return fmt::format("the eye of seat {} is at {}; expected numbers from {} to {}",
                               seat.number,
                               seat.eye_mm[c],
                               -kFarthestEye_mm,
                               kFarthestEye_mm);
        }
        for (std::size_t other = 0; other < k; ++other) {
            if (seats[other].number == seat.number) {
                return fmt::format("there are two seats {}; expected each number once",
                                   seat.number);
            }
            const double apart_mm = glm::distance(seats[other].eye_mm, seat.eye_mm);
            if (apart_mm < kLeastBetweenSeats_mm) {
                return fmt::format(
                    "the eyes of seats {} and {} are {:.0f} mm apart; expected {:.0f} or more",
                    seats[other].number,
                    seat.number,
                    apart_mm,
                    kLeastBetweenSeats_mm);
            }
        }
    }
    return std::nullopt;
}

std::optional<std::string> choice_problem(const std::vector<EyeSeat>& seats,
                                          const EyeChoice& choice) {
    if (choice.source == EyeSource::seat && !find_seat(seats, choice.seat)) {
        return fmt::format("there is no seat {}; expected one of the {} that there are",
                           choice.seat,
                           seats.size());
    }
    if (choice.source == EyeSource::mean && !mean_eye_mm(seats)) {
        return "no seat counts; expected one at least for their mean";
    }
    return std::nullopt;
}

glm::dvec3 eye_in_use_mm(const glm::dvec3& by_hand_mm,
                         const std::vector<EyeSeat>& seats,
                         const EyeChoice& choice) {
    if (const auto problem = choice_problem(seats, choice)) throw std::invalid_argument(*problem);
    switch (choice.source) {
        case EyeSource::seat:
            return find_seat(seats, choice.seat)->eye_mm;
        case EyeSource::mean:
            return *mean_eye_mm(seats);
        case EyeSource::by_hand:
            break;
    }
    return by_hand_mm;
}

int counting_seats(const std::vector<EyeSeat>& seats) {
    return static_cast<int>(
        std::count_if(seats.begin(), seats.end(), [](const EyeSeat& seat) { return seat.counts; }));
}

std::string in_words(const std::vector<EyeSeat>& seats, const EyeChoice& choice) {
    if (choice.source == EyeSource::by_hand) return "set by hand";
    if (choice.source == EyeSource::seat) return fmt::format("of seat {}", choice.seat);
    const int count = counting_seats(seats);
    return fmt::format("in the mean of {} {}", count, count == 1 ? "seat" : "seats");
}

double floor_height_mm(const Bounds& mockup) {
    const glm::dvec3 size = mockup.high - mockup.low;
    const bool on_table =
        size.y <= kTallestOnTable_mm && std::max(size.x, size.z) <= kLongestOnTable_mm;
    return mockup.low.y - (on_table ? kTable_mm : 0.0);
}

double seated_eye_height_mm(const Bounds& mockup) {
    return floor_height_mm(mockup) + kSeatedEye_mm;
}

std::vector<EyeSeat> seats_in_an_arc(const Bounds& mockup, const glm::dvec3& toward_mm, int count) {
    check_argument(count >= 0 && static_cast<std::size_t>(count) <= kMostSeats,
                   fmt::format("{} seats; expected 0 to {}", count, kMostSeats));
    Arc arc = arc_about(mockup, toward_mm);
    const double length_mm = kElbow_mm * std::max(count - 1, 0);
    arc.radius_mm = std::max(arc.radius_mm, length_mm / std::numbers::pi);
    std::vector<EyeSeat> seats;
    for (int k = 0; k < count; ++k) {
        // Who faces the mock-up from +z has +x on the right
        seats.push_back({k + 1, arc.at(kElbow_mm * k - 0.5 * length_mm), true});
    }
    return seats;
}

EyeSeat next_seat(const Bounds& mockup,
                  const glm::dvec3& toward_mm,
                  const std::vector<EyeSeat>& seats) {
    check_argument(seats.size() < kMostSeats,
                   fmt::format("there are {} seats already; no more are possible", kMostSeats));
    EyeSeat seat{free_seat_number(seats), {}, true};
    for (Arc arc = arc_about(mockup, toward_mm);; arc.radius_mm += kElbow_mm) {
        const int most = static_cast<int>(0.5 * std::numbers::pi * arc.radius_mm / kElbow_mm);
        for (int k = 0; k <= 2 * most; ++k) {
            const int step = k % 2 == 1 ? (k + 1) / 2 : -k / 2;
            seat.eye_mm = arc.at(kElbow_mm * step);
            if (is_free(seat.eye_mm, seats, 0.9 * kElbow_mm)) return seat;
        }
    }
}

}  // namespace livery
