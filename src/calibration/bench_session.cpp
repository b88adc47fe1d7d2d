#include "calibration/bench_session.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "calibration/captures/capture_check.h"
#include "calibration/colour/colour_report.h"
#include "core/error.h"
#include "core/statistics.h"

namespace livery {

namespace {

/// Pixels within reach of the mock-up: a pose that is a little off, a lens that is a little soft.
Image8 around(const Image8& mockup) {
    const int reach = std::max(2, mockup.width / 200);
    Image8 rows(mockup.width, mockup.height, 1), all = rows;
    const auto spread = [&](const Image8& from, Image8& to, int dx, int dy) {
        for (int y = 0; y < from.height; ++y)
            for (int x = 0; x < from.width; ++x) {
                if (!from.at(x, y)) continue;
                for (int k = -reach; k <= reach; ++k) {
                    const int u = x + k * dx, v = y + k * dy;
                    if (u >= 0 && v >= 0 && u < to.width && v < to.height) to.at(u, v) = 255;
                }
            }
    };
    spread(mockup, rows, 1, 0);
    spread(rows, all, 0, 1);
    return all;
}

}  // namespace

ImageF light_over_black(const Photograph& photograph, const Photograph& black) {
    const auto scale = static_cast<float>(1.0 / (3.0 * photograph.exposure_s));
    const auto black_scale = static_cast<float>(1.0 / (3.0 * black.exposure_s));
    const auto level = static_cast<float>(photograph.black_level);
    const auto black_level = static_cast<float>(black.black_level);
    ImageF light(photograph.image.width, photograph.image.height, 1);
    for (std::size_t i = 0; i < light.values.size(); ++i) {
        float sum = 0.0f;
        for (std::size_t c = 0; c < 3; ++c)
            sum += scale * (photograph.image.values[3 * i + c] - level) -
                   black_scale * (black.image.values[3 * i + c] - black_level);
        light.values[i] = std::isfinite(sum) ? sum : 0.0f;
    }
    return light;
}

LitPixels lit_pixels(const ImageF& light, std::size_t thinned_to) {
    const float limit = 0.1f * quantile(light.values, 0.9999);
    LitPixels all;
    for (std::size_t i = 0; i < light.values.size(); ++i)
        if (light.values[i] > limit) all.push_back(static_cast<std::uint32_t>(i));
    if (thinned_to == 0 || all.size() <= thinned_to) return all;
    LitPixels some;
    const std::size_t step = all.size() / thinned_to + 1;
    for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
    return some;
}

double lit_mean(const ImageF& light, const LitPixels& lit) {
    double sum = 0.0;
    for (const std::uint32_t i : lit) sum += static_cast<double>(light.values[i]);
    return lit.empty() ? 0.0 : sum / static_cast<double>(lit.size());
}

ShowPicture shown_on(const Image8& mockup, const ShowPicture& show) {
    return [lit = around(mockup), show](const Image8& drive) {
        Image8 alone = drive;
        for (std::size_t i = 0; i < alone.pixel_count(); ++i)
            if (!lit.values[i])
                std::fill_n(
                    alone.values.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, std::uint8_t{0});
        show(alone);
    };
}

namespace {

constexpr double kTargetPeak = 0.80, kHighestPeak = 0.85, kLowestPeak = 0.60;
constexpr double kDarkestPeak = 0.20;  // usable where nothing better can be set
constexpr double kClippedPeak = 0.97;  // says nothing of how much too bright it is
constexpr double kSameBenchExposure = 0.01;
constexpr double kStep = 1.3;    // a little more than a third of a stop
constexpr int kMostInVain = 3;   // by then it was asked for more than a stop
constexpr double kMixed = 0.02;  // of white: an eighth of a photograph, or a lamp that flickers
constexpr int kMostLatency = 6;
constexpr double kLonger = 8.0;  // three stops
constexpr int kMostLonger = 5;
constexpr double kProjectorFrame_s = 1.0 / 60.0;

std::string seconds(double value) { return fmt::format("{:.3g} s", value); }

/// A photograph thinned to about 50000 pixels for comparisons: mean of the channels over black
/// level.
std::vector<float> thin(const Photograph& photo) {
    const std::size_t count = photo.image.pixel_count();
    const std::size_t step = std::max<std::size_t>(1, count / 50000);
    const auto channels = static_cast<std::size_t>(photo.image.channels);
    std::vector<float> values;
    for (std::size_t i = 0; i < count; i += step) {
        float sum = 0.0f;
        for (std::size_t c = 0; c < channels; ++c) sum += photo.image.values[i * channels + c];
        values.push_back(sum / static_cast<float>(channels) -
                         static_cast<float>(photo.black_level));
    }
    return values;
}

/// Noise of the thinned values of two photographs of the same scene.
double noise_between(const std::vector<float>& a, const std::vector<float>& b) {
    std::vector<float> distance;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::isfinite(a[i] - b[i])) distance.push_back(std::abs(a[i] - b[i]));
    return 1.4826 * static_cast<double>(median(distance));
}

bool is_brighter(const std::vector<float>& white, const std::vector<float>& black, double noise) {
    std::size_t brighter = 0;
    for (std::size_t i = 0; i < white.size(); ++i)
        // Where a lit room is bright its own noise exceeds the picture's median.
        brighter += static_cast<double>(white[i] - black[i]) >
                    std::max(10.0 * noise, 0.1 * static_cast<double>(black[i]));
    return static_cast<double>(brighter) > 5e-4 * static_cast<double>(white.size());
}

/// Whole projector frames where the exposure holds a few: a wheel's colours then weigh equally.
double whole_frames(double exposure_s) {
    const double frames = std::floor(1.05 * exposure_s / kProjectorFrame_s);  // 84% at most
    return frames >= 3.0 ? frames * kProjectorFrame_s : exposure_s;
}

}  // namespace

BenchSession::BenchSession(const BenchPorts& ports,
                           const Progress& progress,
                           int expected_photographs)
    : ports_(ports), progress_(progress), expected_(std::max(expected_photographs, 1)) {
    check_argument(static_cast<bool>(ports.show) && static_cast<bool>(ports.photograph),
                   "a live calibration needs a projector and a camera");
}

Photograph BenchSession::photograph(const std::string& name) {
    progress_.update(std::min(1.0, static_cast<double>(photographs_) / expected_),
                     (fixed() ? "reading the photographs of " : "photographing ") + name);
    if (ports_.announce) ports_.announce(name);
    Photograph photo = ports_.photograph(exposure_s_);
    if (photo.taken_at < 0.0) photo.taken_at = photographs_;
    if (!fixed()) photo.name = name;
    ++photographs_;
    check_photograph(photo, name);
    if (met_s_ > 0.0 && std::abs(photo.exposure_s / met_s_ - 1.0) > kSameBenchExposure)
        throw Refused("automatic exposure: the photograph of " + name + " was exposed for " +
                          seconds(photo.exposure_s) + ", those before it for " + seconds(met_s_),
                      kManualExposure);
    return photo;
}

/// All photographs have the first one's size and finite numbers for the most part.
void BenchSession::check_photograph(const Photograph& photo, const std::string& shown) {
    const ImageF& image = photo.image;
    const std::string source = fixed() ? photo.name : "camera";
    if (image.empty() || image.channels != 3)
        throw FileError(source,
                        "photograph of " + shown,
                        fmt::format("{}x{}x{}", image.width, image.height, image.channels),
                        "a picture of 3 channels");
    if (width_ == 0) {
        width_ = image.width;
        height_ = image.height;
    }
    if (image.width != width_ || image.height != height_)
        throw FileError(source,
                        "size of the photograph of " + shown,
                        fmt::format("{}x{}", image.width, image.height),
                        fmt::format("{}x{} as the first photograph", width_, height_));
    std::size_t looked_at = 0, finite = 0;
    for (std::size_t i = 0; i < image.values.size(); i += 97) {
        ++looked_at;
        finite += std::isfinite(image.values[i]);
    }
    if (2 * finite < looked_at)
        throw FileError(
            source,
            "values of the photograph of " + shown,
            percent(1.0 - static_cast<double>(finite) / static_cast<double>(looked_at)) +
                " not finite",
            "finite numbers");
}

/// Mean of the lit pixels over black, file units.
double BenchSession::lit_mean(const Photograph& photo) const {
    double sum = 0.0, count = 0.0;
    for (const std::uint32_t i : lit_)
        for (std::size_t c = 0; c < 3; ++c) {
            const float value = photo.image.values[3 * static_cast<std::size_t>(i) + c];
            if (!std::isfinite(value)) continue;
            sum += static_cast<double>(value) - photo.black_level;
            count += 1.0;
        }
    return sum / std::max(count, 1.0);
}

/// `asked`, `found`: the ratio of two exposures, and of the brightness of white that came of them.
/// The flattest curve of a picture style, a camera's logarithm, still answers with a fifth of it.
bool BenchSession::sets_its_own(double asked, double found) {
    return std::abs(std::log(asked)) > 0.2 &&
           std::abs(std::log(found)) < 0.1 * std::abs(std::log(asked));
}

double BenchSession::white_peak() const {
    // Channel by channel over the lit pixels; a thousandth may glint.
    double peak = 0.0;
    const double full = white_.saturates_at - white_.black_level;
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<float> values;
        for (const std::uint32_t i : lit_) {
            const float value = white_.image.values[3 * static_cast<std::size_t>(i) + c];
            if (std::isfinite(value)) values.push_back(value);
        }
        peak = std::max(
            peak,
            (static_cast<double>(quantile(std::move(values), 0.999)) - white_.black_level) / full);
    }
    return peak;
}

void BenchSession::find_lit() { lit_ = lit_pixels(light_over_black(white_, black_), 40000); }

/// Black long enough for any latency, then white until it is seen; false when it is not.
bool BenchSession::see_white(int width, int height) {
    ports_.show(Image8(width, height, 3, 0));
    for (int i = 0; i <= kMostLatency; ++i) photograph("black");
    black_ = photograph("black");
    const std::vector<float> black = thin(black_);
    noise_ = std::max(noise_between(black, thin(photograph("black"))), 1e-6);
    ports_.show(Image8(width, height, 3, 255));
    for (latency_ = 0; latency_ <= kMostLatency; ++latency_) {
        white_ = photograph("white");
        if (is_brighter(thin(white_), black, noise_)) {
            wait_for_all_of_white();
            return true;
        }
    }
    return false;
}

/// The first photograph that sees a picture may have seen the one before as well: frames of a video
/// that were under way, a panel that is slow. What comes next is then brighter.
void BenchSession::wait_for_all_of_white() {
    while (latency_ < kMostLatency) {
        find_lit();
        const Photograph next = photograph("white");
        const double brighter = lit_mean(next) / std::max(lit_mean(white_), 1e-9) - 1.0;
        white_ = next;
        if (!(brighter > kMixed)) return;
        ++latency_;
    }
}

/// White, which is shown, at ever longer exposures, then black at the same: few photographs, as
/// long ones take minutes. The shortest at which white is brighter is kept; false when none is.
bool BenchSession::find_longer_exposure(int width, int height) {
    struct Longer {
        double asked_s;
        std::vector<float> white;
    };
    const double first_s = exposure_s_;
    double longest_s = black_.exposure_s;
    std::vector<Longer> all;
    for (int k = 0; k < kMostLonger; ++k) {
        exposure_s_ *= kLonger;
        const Photograph white = photograph("white");
        if (!(white.exposure_s > 1.01 * longest_s)) break;  // its longest
        longest_s = white.exposure_s;
        all.push_back({exposure_s_, thin(white)});
    }
    exposure_s_ = first_s;
    if (all.empty()) return false;
    ports_.show(Image8(width, height, 3, 0));
    for (int i = 0; i <= kMostLatency; ++i) photograph("black");
    for (const Longer& longer : all) {
        exposure_s_ = longer.asked_s;
        const std::vector<float> black = thin(photograph("black"));
        const double noise = std::max(noise_between(black, thin(photograph("black"))), 1e-6);
        if (is_brighter(longer.white, black, noise)) return true;
    }
    return false;
}

void BenchSession::meet(int width, int height) {
    exposure_s_ = 0.0;  // the camera's own
    exposure_s_ = photograph("what is there").exposure_s;
    if (!(exposure_s_ > 0.0))
        throw FileError("camera", "exposure_s", std::to_string(exposure_s_), "a positive time");
    if (!see_white(width, height) &&
        !(find_longer_exposure(width, height) && see_white(width, height)))
        throw NothingShown(
            "the camera sees no light of the projector",
            "switch the projector on or wake it, open the lens, aim the camera at the mock-up, "
            "and check that pictures go to the projector's screen",
            NothingShown::kAll);

    // Exposure: by photographs of white, until its peak fits
    find_lit();
    const bool knows_full_scale = std::isfinite(white_.saturates_at);
    double peak = knows_full_scale ? white_peak() : kTargetPeak;
    std::set<double> met_before;  // exposures
    double too_long_s = std::numeric_limits<double>::infinity();
    int in_vain = 0;  // how often in a row it was asked for another and kept its own
    for (int round = 0; knows_full_scale && round < 16; ++round) {
        const double before = exposure_s_;
        met_before.insert(white_.exposure_s);
        if (peak > kHighestPeak) too_long_s = std::min(too_long_s, white_.exposure_s);
        if (peak > kHighestPeak || peak < kLowestPeak) {
            exposure_s_ *= peak >= kClippedPeak
                               ? 0.25
                               : std::clamp(kTargetPeak / std::max(peak, 1e-3), 0.1, 16.0);
            exposure_s_ *= std::pow(peak > kTargetPeak ? 1.0 / kStep : kStep, in_vain);
            if (peak < kLowestPeak)  // not back to where it was too bright
                exposure_s_ = std::min(exposure_s_, std::sqrt(white_.exposure_s * too_long_s));
        }
        exposure_s_ = whole_frames(exposure_s_);
        if (exposure_s_ == before) break;
        const double kept_s = white_.exposure_s, mean = lit_mean(white_);
        white_ = photograph("white");
        expect_light(white_, kept_s, mean);
        find_lit();
        peak = white_peak();
        // Where all of it is at full scale it cannot become brighter.
        if (mean < 0.9 * (white_.saturates_at - white_.black_level) &&
            sets_its_own(white_.exposure_s / kept_s, lit_mean(white_) / mean))
            refuse_own_exposure(kept_s, white_.exposure_s);
        // A shutter has steps and goes to the nearest, which may be the one before. Other cameras
        // keep theirs whatever is asked.
        in_vain = white_.exposure_s == kept_s ? in_vain + 1 : 0;
        if (in_vain > 0) exposure_s_ = kept_s;
        const bool fits = peak >= kLowestPeak && peak <= kHighestPeak;
        if (in_vain > kMostInVain || (in_vain > 0 && fits)) break;
        // Full stops: too dark again, between which and too bright there is none.
        const bool again = in_vain == 0 && met_before.count(white_.exposure_s) > 0;
        if (again && peak >= kDarkestPeak && peak < kLowestPeak) break;
    }
    if (peak > kHighestPeak || peak < kDarkestPeak)
        throw Refused(
            "no exposure brings white on the mock-up near 80% of full scale; the last, " +
                seconds(white_.exposure_s) + ", gave " + percent(peak),
            "open or close the lens, change ISO, let the program set the exposure, or move the "
            "camera so that nothing shines at it");
    refuse_curved_files();
    last_ = white_.image;
    met_s_ = white_.exposure_s;
}

/// White, on the pixels that were lit by it before, against what they were then.
void BenchSession::expect_light(const Photograph& white, double before_s, double before) const {
    if (lit_mean(white) > 0.05 * std::min(1.0, white.exposure_s / before_s) * before) return;
    throw NothingShown("the camera saw the projector's white and sees no light of it any more",
                       "the projector went off, asleep or to another picture, or something stands "
                       "before it: keep its screen on",
                       1);
}

void BenchSession::refuse_own_exposure(double before_s, double after_s) {
    throw Refused("automatic exposure: white is as bright at " + seconds(after_s) + " as at " +
                      seconds(before_s) + ", so that the camera sets exposure or ISO by itself",
                  kManualExposure);
}

/// Half the exposure must give half the numbers: a JPEG's or a picture style's curve does not.
void BenchSession::refuse_curved_files() {
    const double exposure_s = exposure_s_;
    exposure_s_ = 0.5 * exposure_s;
    const Photograph half = photograph("white at half the exposure");
    exposure_s_ = exposure_s;
    expect_light(half, white_.exposure_s, lit_mean(white_));
    const double asked = half.exposure_s / white_.exposure_s;
    if (!(asked < 0.7)) return;  // the camera keeps its exposure: nothing to compare
    std::vector<float> ratio;
    for (const std::uint32_t i : lit_) {
        float bright = 0.0f, dark = 0.0f;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t k = 3 * static_cast<std::size_t>(i) + c;
            bright += white_.image.values[k] - static_cast<float>(white_.black_level);
            dark += half.image.values[k] - static_cast<float>(half.black_level);
        }
        if (std::isfinite(bright + dark) && bright > 0.0f) ratio.push_back(dark / bright);
    }
    const double found = static_cast<double>(median(std::move(ratio)));
    if (sets_its_own(asked, found)) refuse_own_exposure(white_.exposure_s, half.exposure_s);
    // Shutters of a tenth of a second are true to 2%. A picture style that was taken for sRGB gives
    // 11% less than half, and colours that are 7 CIEDE2000 off.
    if (std::abs(found - asked) > 0.05 * asked)
        throw Refused("the camera's numbers are not proportional to light: " + percent(asked) +
                          " of the exposure gives " + percent(found) + " of white",
                      "take RAW photographs (JPEG and picture styles bend the numbers) or fit the "
                      "camera's curve, and check that black_level is right and automatic exposure "
                      "is off");
    linearity_ = found / asked;
}

bool BenchSession::differs(const Photograph& a, const Photograph& b) const {
    // A tenth of the lit pixels by a tenth of their light, and by more than two dark photographs
    // differ: three channels of 1.7 times the noise of their mean each
    const float noise = 15.0f * static_cast<float>(noise_);
    std::size_t changed = 0;
    for (const std::uint32_t i : lit_) {
        float difference = 0.0f, sum = 0.0f;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t k = 3 * static_cast<std::size_t>(i) + c;
            difference += std::abs(a.image.values[k] - b.image.values[k]);
            sum += std::abs(a.image.values[k] - static_cast<float>(a.black_level)) +
                   std::abs(b.image.values[k] - static_cast<float>(b.black_level));
        }
        changed += difference > std::max(0.1f * sum, noise);
    }
    return static_cast<double>(changed) > 0.1 * static_cast<double>(lit_.size());
}

Photograph BenchSession::take(const Image8& drive, const std::string& name, bool compared_to_last) {
    ports_.show(drive);
    for (int i = 0; i < latency_; ++i) photograph(name);
    Photograph photo = photograph(name);
    Photograph before;
    before.image = std::move(last_);
    before.black_level = photo.black_level;
    for (int retry = 0; compared_to_last && !differs(photo, before); ++retry) {
        if (retry == kMostLatency)
            // The one before may have been the last that changed: from a picture to no light.
            throw NothingShown(
                "the photograph of " + name + " shows no change from the picture before",
                "the projector's picture did not arrive: check that its screen is not frozen, "
                "asleep or mirrored from another, and that projector and camera are in focus",
                2);
        photo = photograph(name);
    }
    last_ = photo.image;
    return photo;
}

Photograph BenchSession::take_mean(const Image8& drive, const std::string& name, int shots) {
    Photograph mean = take(drive, name);
    if (shots <= 1) return mean;
    const auto limit =
        static_cast<float>(mean.black_level + 0.98 * (mean.saturates_at - mean.black_level));
    std::vector<double> sum(mean.image.values.size());
    std::vector<std::uint8_t> over(sum.size(), 0);
    std::vector<double> light;
    for (int number = 0; number < shots; ++number) {
        const Photograph shot = number == 0 ? mean : photograph(name);
        light.push_back(lit_mean(shot));
        if (number > 0)
            mean.kept_as.insert(mean.kept_as.end(), shot.kept_as.begin(), shot.kept_as.end());
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += static_cast<double>(shot.image.values[i]);
            over[i] |= shot.image.values[i] >= limit;
        }
    }
    // Black holds too little light to tell the lamp's brightness.
    const bool dark =
        std::all_of(drive.values.begin(), drive.values.end(), [](auto v) { return v < 32; });
    const auto [low, high] = std::minmax_element(light.begin(), light.end());
    if (!dark) check_shots(name, (*high - *low) / *high);
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const auto value = static_cast<float>(sum[i] / shots);
        mean.image.values[i] = over[i] ? std::max(value, limit) : value;
    }
    mean.taken_at += 0.5 * (shots - 1);
    return mean;
}

std::vector<Photograph> BenchSession::take_all(const Image8& drive,
                                               const std::string& role,
                                               int shots) {
    if (!fixed()) return {take_mean(drive, role, shots)};
    ports_.show(drive);
    std::vector<Photograph> taken;
    for (int left = ports_.turn_to(role); left > 0; --left) taken.push_back(photograph(role));
    return taken;
}

}  // namespace livery
