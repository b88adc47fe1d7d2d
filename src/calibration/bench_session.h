// Showing pictures and photographing them so that each photograph is known to show its picture; and
// the projector's light in photographs of a mock-up.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/bench_ports.h"
#include "core/error.h"
#include "core/image.h"
#include "core/progress.h"

namespace livery {

/// Places of camera pixels.
using LitPixels = std::vector<std::uint32_t>;

/// What a photograph holds over one of black, mean of the channels, file units a second: 1 channel.
ImageF light_over_black(const Photograph& photograph, const Photograph& black);

/// Pixels with at least a tenth of the brightest ones' light, thinned to some 40000 where asked.
LitPixels lit_pixels(const ImageF& light, std::size_t thinned_to = 0);

/// Mean over these pixels; 0 for none.
double lit_mean(const ImageF& light, const LitPixels& lit);

/// A port that lights the mock-up alone (non-zero pixels), and what is near it: a pose that is a
/// little off, a lens that is a little soft. What stands around it stays dark in the show; if it
/// were lit here, its light on the mock-up would be taken for what the mock-up's own pixels send.
ShowPicture shown_on(const Image8& mockup, const ShowPicture& show);

/// A run of pictures and photographs through the ports: waits for latency, checks that each picture
/// arrived, keeps one exposure. Where the photographs are what they are (`BenchPorts::turn_to`)
/// there is nothing to wait for and nothing to repeat.
class BenchSession {
  public:
    BenchSession(const BenchPorts& ports, const Progress& progress, int expected_photographs);

    /// Finds how many photographs still see the picture before, and the exposure at which white
    /// peaks at about 80% of full scale (at most 85%) in every channel. Throws NothingShown
    /// when no light of the projector reaches the camera, Refused when no exposure fits, the camera
    /// sets its own, or its numbers are not proportional to light.
    void meet(int width, int height);

    /// Shows and photographs. Where `compared_to_last`, the photograph must differ from the one
    /// before on the lit pixels; it is repeated some times, then refused (NothingShown).
    Photograph take(const Image8& drive, const std::string& name, bool compared_to_last = true);

    /// One more of what is shown.
    Photograph again(const std::string& name) { return photograph(name); }

    /// Mean of several photographs of one picture. A value at 98% of full scale in any of them
    /// stays there. Throws Refused when their brightness differs by more than 1%.
    Photograph take_mean(const Image8& drive, const std::string& name, int shots);

    /// The mean of `shots` photographs; where they are what they are, each of the role's.
    std::vector<Photograph> take_all(const Image8& drive, const std::string& role, int shots);

    /// Whether the photographs are what they are.
    bool fixed() const { return static_cast<bool>(ports_.turn_to); }
    int latency() const { return latency_; }
    /// Once met: what half the exposure gives of white, over what it should give: 1 where numbers
    /// are proportional to light; 0: the camera keeps its exposure.
    double linearity() const { return linearity_; }

  private:
    Photograph photograph(const std::string& name);
    void check_photograph(const Photograph& photo, const std::string& shown);
    void refuse_curved_files();
    bool see_white(int width, int height);
    bool find_longer_exposure(int width, int height);
    void wait_for_all_of_white();
    void find_lit();
    double white_peak() const;
    double lit_mean(const Photograph& photo) const;
    void expect_light(const Photograph& white, double before_s, double before) const;
    static bool sets_its_own(double asked, double found);
    [[noreturn]] static void refuse_own_exposure(double before_s, double after_s);
    bool differs(const Photograph& a, const Photograph& b) const;

    const BenchPorts& ports_;
    const Progress& progress_;
    int width_ = 0, height_ = 0;  ///< of the photographs
    int expected_ = 0, photographs_ = 0, latency_ = 0;
    double exposure_s_ = 0.0;
    double met_s_ = 0.0;              ///< what the camera says of it once it is found; it stays
    std::vector<std::uint32_t> lit_;  ///< some of the lit camera pixels
    ImageF last_;                     ///< what they were in the photograph before
    Photograph black_, white_;
    double linearity_ = 0.0;
    double noise_ = 0.0;  ///< of one photograph's thinned values
};

/// No photograph shows that the projector followed. Those of its newest `pictures()` pictures need
/// not be of what they say: whoever kept them forgets them.
class NothingShown : public Refused {
  public:
    static constexpr int kAll = std::numeric_limits<int>::max();

    NothingShown(std::string why, std::string fix, int pictures)
        : Refused(std::move(why), std::move(fix)), pictures_(pictures) {}
    int pictures() const { return pictures_; }

  private:
    int pictures_;
};

}  // namespace livery
