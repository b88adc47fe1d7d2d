#include "calibration/preflight.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "calibration/bench_session.h"
#include "core/error.h"
#include "core/statistics.h"

namespace livery {
namespace {

constexpr int kPhotographs = 33;
constexpr int kFlickerShots = 5;
constexpr int kStripe_px = 4;

const char* const kProcessing =
    "Set the projector to its sRGB, cinema or PC mode, and switch off dynamic contrast, dynamic "
    "iris, eco light and brilliant-colour modes.";

Image8 uniform(const PreflightOptions& size, int r, int g, int b) {
    Image8 picture(size.width, size.height, 3);
    const std::array<std::uint8_t, 3> drive{
        static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(b)};
    for (std::size_t k = 0; k < picture.values.size(); ++k) picture.values[k] = drive[k % 3];
    return picture;
}

/// To so many parts of one, and never a negative nothing.
double rounded(double value, double parts) { return std::round(value * parts) / parts + 0.0; }

/// White where `lit(x, y)`.
template <typename Lit>
Image8 white_where(const PreflightOptions& size, const Lit& lit) {
    Image8 picture(size.width, size.height, 3);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            if (lit(x, y)) std::fill_n(picture.pixel(x, y), 3, std::uint8_t{255});
    return picture;
}

/// The run itself: what has been seen so far, and the figures.
class PreflightRun {
  public:
    PreflightRun(const BenchPorts& bench,
                 const PreflightOptions& options,
                 const Progress& progress,
                 const std::function<void(const GradedFigure&)>& on_figure)
        : options_(options), on_figure_(on_figure), session_(bench, progress, kPhotographs) {}

    Preflight run();

  private:
    void add(GradedFigure figure) {
        if (on_figure_) on_figure_(figure);
        result_.figures.push_back(std::move(figure));
    }
    bool meet();
    void see_size();
    void see_exposure();
    void see_clipping();
    void see_linearity();
    void see_native_pixels();
    void see_focus();
    void see_sum();
    void see_dynamics();
    void see_room_light();
    void see_flicker();
    void see_drift();
    ImageF light_of(const Image8& drive, const std::string& name);
    /// Mean light over the lit pixels, black taken off.
    double mean_light(const ImageF& light) const { return lit_mean(light, lit_); }

    const PreflightOptions& options_;
    const std::function<void(const GradedFigure&)>& on_figure_;
    BenchSession session_;
    Preflight result_;
    Photograph black_, white_;
    ImageF white_light_;  ///< one channel, a second, black taken off
    LitPixels lit_;
    std::chrono::steady_clock::time_point white_at_;
};

/// Light over black of what a drive shows: one channel, file units a second.
ImageF PreflightRun::light_of(const Image8& drive, const std::string& name) {
    return light_over_black(session_.take(drive, name, false), black_);
}

bool PreflightRun::meet() {
    try {
        session_.meet(options_.width, options_.height);
    } catch (const Refused& refused) {
        add({"Projector and camera", "no", "", refused.why(), refused.fix(), Grade::bad});
        return false;
    }
    result_.latency_photographs = session_.latency();
    black_ = session_.take(uniform(options_, 0, 0, 0), "black", false);
    white_ = session_.take(uniform(options_, 255, 255, 255), "white", false);
    white_at_ = std::chrono::steady_clock::now();
    result_.exposure_s = white_.exposure_s;
    white_light_ = light_over_black(white_, black_);
    lit_ = lit_pixels(white_light_);
    return true;
}

void PreflightRun::see_size() {
    const auto pixels = static_cast<double>(lit_.size());
    std::size_t mockup = 0;
    for (const std::uint8_t on : options_.mockup.values) mockup += on != 0;
    const bool known = mockup > 0;
    // Without a pose: what the camera sees lit, of its own picture.
    add({"Size in the camera",
         known
             ? fmt::format("{:.2f} camera px a projector px", pixels / static_cast<double>(mockup))
             : fmt::format("{:.0f} px lit", pixels),
         known ? "good from 1 camera px a projector px, usable from 0.4"
               : "good from 100000 px, usable from 20000",
         known ? fmt::format(
                     "{:.0f} camera pixels see the projector's light; the mock-up takes {} of the "
                     "projector's.",
                     pixels,
                     mockup)
               : std::string("How many camera pixels see the projector's light."),
         "Bring the camera nearer or zoom in; move the projector so that the mock-up fills more of "
         "its picture.",
         known ? grade_of(pixels / static_cast<double>(mockup), 1.0, 0.4)
               : grade_of(pixels, 1e5, 2e4)});
    const int late = result_.latency_photographs;
    add({"Delay",
         late == 0 ? "none" : fmt::format("{} photograph{}", late, late == 1 ? "" : "s"),
         "good: none, usable up to 3 photographs",
         "How many photographs still see the picture before. Each picture is awaited.",
         "Switch the projector to its game mode, and motion interpolation off.",
         late == 0   ? Grade::good
         : late <= 3 ? Grade::usable
                     : Grade::bad});
}

void PreflightRun::see_exposure() {
    const double frames = white_.exposure_s * 60.0;
    const bool whole = std::abs(frames - std::round(frames)) < 0.05 && frames > 0.95;
    add({"Exposure",
         fmt::format("{:.3g} s, {:.3g} frames", white_.exposure_s, frames),
         "good from 3 projector frames or a whole number of them, usable from 1",
         "Frames of a projector at 60 Hz. Shorter exposures catch a colour wheel or a dimmed "
         "lamp in the middle.",
         "Close the lens or lower ISO, so that the exposure becomes longer.",
         whole || frames >= 2.95 ? Grade::good
         : frames >= 0.95        ? Grade::usable
                                 : Grade::bad});
}

/// The sum of channels and the native pixels, which come later, believe the numbers.
void PreflightRun::see_linearity() {
    const double found = session_.linearity();
    if (!(found > 0.0)) return;  // its exposure cannot be set: nothing to compare
    const double off = std::abs(found - 1.0);
    add({"Half the exposure",
         fmt::format("{:.1f} % of white's light", 50.0 * found),
         "good from 49 to 51 %, usable from 47.5 to 52.5 %",
         "A camera whose numbers are proportional to light sees half.",
         "Take RAW photographs, or fit the camera's curve.",
         off <= 0.02   ? Grade::good
         : off <= 0.05 ? Grade::usable
                       : Grade::bad});
}

void PreflightRun::see_clipping() {
    const double limit = white_.black_level + 0.98 * (white_.saturates_at - white_.black_level);
    std::size_t clipped = 0;
    for (const std::uint32_t i : lit_)
        for (std::size_t c = 0; c < 3; ++c)
            if (static_cast<double>(white_.image.values[3 * static_cast<std::size_t>(i) + c]) >=
                limit) {
                ++clipped;
                break;
            }
    add(graded_share("Clipped in white",
                     static_cast<double>(clipped) / static_cast<double>(lit_.size()),
                     0.001,
                     0.01,
                     "Lit pixels at the camera's full scale: nothing is known of them.",
                     "Turn the mock-up or the camera so that nothing shines at it; dull chrome and "
                     "glass with scanning spray."));
}

/// A checkerboard of single pixels sends half of white's light. Where somebody scales the picture,
/// drives are mixed, and a drive half way sends about a fifth of white's light, not half.
void PreflightRun::see_native_pixels() {
    const Image8 board = white_where(options_, [](int x, int y) { return (x + y) % 2 == 0; });
    const double share =
        mean_light(light_of(board, "a checkerboard of single pixels")) / mean_light(white_light_);
    add({"Native pixels",
         fmt::format("{:.1f} % of white", 100.0 * share),
         "good within 4 % of half, usable within 8 %",
         "The light of a checkerboard of single pixels, which is half of white's unless the "
         "picture "
         "is scaled on its way.",
         "Switch keystone, zoom, overscan and warping off in the projector's menu, and send its "
         "native resolution.",
         grade_of(std::abs(2.0 * share - 1.0), 0.04, 0.08)});
}

/// How far stripes of a few pixels and their inverse still differ, of what white differs from
/// black: the blur of both lenses at the scale of Gray code's finest stripes.
void PreflightRun::see_focus() {
    const auto stripes = [&](int phase) {
        return white_where(options_, [&](int x, int) { return x / kStripe_px % 2 == phase; });
    };
    const ImageF a = light_of(stripes(0), "fine stripes");
    const ImageF b = light_of(stripes(1), "fine stripes and their inverse");
    double sum = 0.0;
    for (const std::uint32_t i : lit_)
        sum += std::min(1.0,
                        std::abs(static_cast<double>(a.values[i]) - b.values[i]) /
                            std::max(static_cast<double>(white_light_.values[i]), 1e-9));
    const double contrast = sum / static_cast<double>(lit_.size());
    add({"Focus",
         fmt::format("{:.0f} % contrast", 100.0 * contrast),
         "good over 70 %, usable over 35 %",
         fmt::format(
             "Contrast left in stripes of {} projector pixels: the projector's lens and the "
             "camera's together.",
             kStripe_px),
         "Focus the projector on the middle of the mock-up, then the camera, by hand; close the "
         "camera's lens by two stops; bring the camera nearer.",
         grade_of(contrast, 0.70, 0.35)});
}

void PreflightRun::see_sum() {
    ImageF sum(white_light_.width, white_light_.height, 1);
    const std::array<std::pair<Image8, const char*>, 3> channels{
        {{uniform(options_, 255, 0, 0), "red"},
         {uniform(options_, 0, 255, 0), "green"},
         {uniform(options_, 0, 0, 255), "blue"}}};
    for (const auto& [drive, name] : channels) {
        const ImageF light = light_of(drive, name);
        for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += light.values[i];
    }
    add(graded_share("White against its channels",
                     std::abs(mean_light(sum) / mean_light(white_light_) - 1.0),
                     0.02,
                     0.25,
                     "How far white is from the sum of red, green and blue. More takes six "
                     "pictures of mosaics besides.",
                     kProcessing));
}

/// A picture that is nearly black makes dynamic modes open the iris or the lamp, most of them
/// within a second; what is lit in it must be as bright as in white, and stay so.
void PreflightRun::see_dynamics() {
    const int tile = std::max(16, options_.width / 40);
    const Image8 tiles =
        white_where(options_, [&](int x, int y) { return x / tile % 4 == 0 && y / tile % 4 == 0; });
    const ImageF at_once = light_of(tiles, "a few white tiles");
    const ImageF later = light_over_black(session_.again("the same tiles later"), black_);
    std::vector<double> share(lit_.size());
    for (std::size_t k = 0; k < lit_.size(); ++k)
        share[k] = static_cast<double>(at_once.values[lit_[k]]) /
                   std::max(static_cast<double>(white_light_.values[lit_[k]]), 1e-9);
    const double brightest = quantile(share, 0.98);
    std::vector<double> against_white, in_time;
    for (std::size_t k = 0; k < lit_.size(); ++k) {
        if (!(share[k] > 0.8 * brightest) || !(share[k] > 0.3)) continue;
        against_white.push_back(share[k]);
        in_time.push_back(static_cast<double>(later.values[lit_[k]]) /
                          static_cast<double>(at_once.values[lit_[k]]));
    }
    constexpr std::size_t kFewest = 50;
    if (against_white.size() < kFewest) {
        add({"Dynamic modes",
             "not seen",
             "",
             "No white tile lies on what the camera sees.",
             "Move the projector so that the mock-up fills more of its picture.",
             Grade::usable});
        return;
    }
    // What the rest of a white picture throws on a tile is missing in a dark one: up to a tenth.
    const double brighter = median(std::move(against_white)) - 1.0;
    const double drift = std::abs(median(std::move(in_time)) - 1.0);
    const bool good = brighter < 0.03 && brighter > -0.12 && drift < 0.01;
    const bool usable = brighter < 0.08 && brighter > -0.20 && drift < 0.03;
    add({"Dynamic modes",
         fmt::format("{:+.1f} % in a dark picture", rounded(100.0 * brighter, 10.0)),
         "good -12 to 3 %, usable -20 to 8 %",
         fmt::format("White in a picture that is nearly black, against white in a white one; it "
                     "changed by {:.1f} % from one photograph to the next.",
                     100.0 * drift),
         kProcessing,
         good     ? Grade::good
         : usable ? Grade::usable
                  : Grade::bad});
}

void PreflightRun::see_room_light() {
    std::vector<float> share;
    for (const std::uint32_t i : lit_) {
        float dark = 0.0f;
        for (std::size_t c = 0; c < 3; ++c)
            dark += black_.image.values[3 * static_cast<std::size_t>(i) + c] -
                    static_cast<float>(black_.black_level);
        dark /= static_cast<float>(3.0 * black_.exposure_s);
        share.push_back(dark / std::max(dark + white_light_.values[i], 1e-9f));
    }
    add(graded_share("Room light",
                     std::max(0.0, static_cast<double>(median(std::move(share)))),
                     0.01,
                     0.05,
                     "The dark picture's brightness over the bright one's.",
                     "Darken the room, cover lamps of devices, and turn the screen away."));
}

void PreflightRun::see_flicker() {
    std::vector<double> light;
    light.push_back(mean_light(light_of(uniform(options_, 255, 255, 255), "white")));
    for (int k = 1; k < kFlickerShots; ++k)
        light.push_back(mean_light(light_over_black(session_.again("white again"), black_)));
    const auto [low, high] = std::minmax_element(light.begin(), light.end());
    add(graded_share(
        "Flicker",
        (*high - *low) / *high,
        0.004,
        0.01,
        fmt::format("How far {} photographs of white differ in brightness.", kFlickerShots),
        "Make the exposure a whole number of the projector's frames (1/60 s, 1/30 s, "
        "1/15 s), and switch off lamps that hum."));
}

void PreflightRun::see_drift() {
    const Photograph last =
        session_.take(uniform(options_, 255, 255, 255), "white at the end", false);
    const double minutes =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - white_at_).count() / 60.0;
    const double change =
        mean_light(light_over_black(last, black_)) / mean_light(white_light_) - 1.0;
    add({"Warm-up drift",
         fmt::format("{:+.2f} % in {:.1f} min", rounded(100.0 * change, 100.0), minutes),
         "good under 0.5 %, usable under 2 %",
         "How far white has changed since the first photograph. A steady drift is taken out of the "
         "colours, a large one means a lamp that is still cold.",
         "Let the projector warm up for twenty minutes with a white picture, and try again.",
         grade_of(std::abs(change), 0.005, 0.02)});
}

Preflight PreflightRun::run() {
    if (!meet()) return std::move(result_);
    if (lit_.size() < 200) {
        add({"Projector and camera",
             fmt::format("{} px lit", lit_.size()),
             "",
             "The camera sees too little of the projector's light to measure anything.",
             "Aim the camera at the mock-up and bring it nearer.",
             Grade::bad});
        return std::move(result_);
    }
    see_size();
    see_exposure();
    see_clipping();
    see_linearity();
    see_native_pixels();
    see_focus();
    see_sum();
    see_dynamics();
    see_room_light();
    see_flicker();
    see_drift();
    session_.take(uniform(options_, 0, 0, 0), "black at the end", false);
    return std::move(result_);
}

}  // namespace

Preflight preflight(const BenchPorts& bench,
                    const PreflightOptions& options,
                    const Progress& progress,
                    const std::function<void(const GradedFigure&)>& on_figure) {
    check_argument(!bench.turn_to, "photographs that were taken before need no preflight");
    check_argument(options.width >= 16 && options.height >= 16,
                   "a preflight needs the projector's size");
    BenchPorts ports = bench;
    if (!options.mockup.empty() && ports.show) ports.show = shown_on(options.mockup, bench.show);
    return PreflightRun(ports, options, progress, on_figure).run();
}

}  // namespace livery
