// What each seat misses of each look, found beside everything else that the window does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "jobs/seat_errors.h"

namespace livery {

struct SeatErrorRequest {
    struct Of {
        int look = 0;  ///< its number in the session
        Scene scene;   ///< shaded for the eye in use
    };
    std::uint64_t number = 0;  ///< rises
    std::vector<Of> looks;     ///< the first is wanted first
    std::vector<EyeSeat> seats;
    View view;  ///< seat_error_view()
    EffectLevels levels{};
};

struct SeatErrorMap {
    SeatError error;
    /// In steps of kSeatMapScale / 254 from 1 (no difference); 0 beside the mock-up. One channel.
    std::shared_ptr<const Image8> steps;
};
inline constexpr double kSeatMapScale = 20.0;  ///< CIEDE2000 at the map's brightest
Image8 seat_map_steps(const ImageF& de00);

/// Of the request with this number; grows until `done` is `wanted`.
struct SeatErrorResults {
    std::uint64_t number = 0;
    std::map<int, std::map<int, SeatErrorMap>> looks;  ///< by look, then by seat
    std::size_t done = 0, wanted = 0;                  ///< seats of looks
    std::string problem;                               ///< why the rest is not there
    bool complete() const { return done == wanted; }
};

/// One thread at low priority, on the processor. The newest request wins; what stood of the one
/// before (the same look in the same light, the same eye, the same seat) is not computed again, nor
/// the looks before that, as far as they are kept.
class SeatErrorThread {
  public:
    /// `on_change` is called on the thread after every result and must not throw.
    explicit SeatErrorThread(std::function<void()> on_change);
    ~SeatErrorThread();  ///< stops what runs
    SeatErrorThread(const SeatErrorThread&) = delete;
    SeatErrorThread& operator=(const SeatErrorThread&) = delete;

    void ask(SeatErrorRequest request);                      ///< returns at once
    std::shared_ptr<const SeatErrorResults> newest() const;  ///< null: none yet
    /// Pictures drawn so far: what was kept is not drawn again.
    std::size_t drawn() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
