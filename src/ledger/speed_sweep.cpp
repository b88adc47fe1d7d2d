#include "ledger/speed_sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "compensation/compensation.h"
#include "core/parallel.h"
#include "core/time.h"
#include "jobs/synthetic_calibration.h"
#include "radiance/renderer.h"

namespace livery {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array kCoverages{0.01, 0.05, 0.15, 0.39, 0.60};
constexpr std::array<std::array<int, 2>, 5> kSizes{
    {{640, 400}, {1280, 800}, {1920, 1080}, {2560, 1440}, {3840, 2160}}};
constexpr int kRepeats = 31;

/// parallel_for()'s threads, back to what they were at the end.
class ThreadCount {
  public:
    ThreadCount() : before_(thread_count()) {}
    ~ThreadCount() { set_thread_count(before_); }
    ThreadCount(const ThreadCount&) = delete;
    ThreadCount& operator=(const ThreadCount&) = delete;
    /// One, and all that there are.
    std::vector<int> to_try() const {
        return before_ > 1 ? std::vector<int>{1, before_} : std::vector<int>{1};
    }

  private:
    int before_;
};

View zoomed(const View& view, int width, int height, double scale, glm::dvec2 middle_px) {
    View result = view;
    result.width = width;
    result.height = height;
    result.focal_px *= scale;
    result.principal_px = glm::dvec2(width, height) * 0.5 + scale * (view.principal_px - middle_px);
    return result;
}

double coverage_of(const SurfaceMap& map) {
    return static_cast<double>(map.covered_pixels) /
           static_cast<double>(map.coverage.pixel_count());
}

struct AxisExtent {
    glm::dvec2 middle_px{0.0};
    double area = 0.0;  ///< of the picture, whatever its pixels' size
};

AxisExtent extent_of(const SurfaceMap& map) {
    glm::dvec2 sum(0.0);
    double weight = 0.0;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const double w = map.coverage.at(x, y);
            sum += w * glm::dvec2(x + 0.5, y + 0.5);
            weight += w;
        }
    }
    const glm::dvec2 size(map.width, map.height);
    return {weight > 0.0 ? sum / weight : 0.5 * size, weight / (size.x * size.y)};
}

SweepTime time_of(std::vector<double> ms) {
    std::sort(ms.begin(), ms.end());
    return {ms[ms.size() / 2], ms.front()};
}

double milliseconds_of(const FramePlan& plan, PassKind kind) {
    double sum = 0.0;
    for (const PlannedPass& pass : plan.passes) {
        if (pass.id.kind == kind) sum += pass.ms.value_or(0.0);
    }
    return sum;
}

/// One view: the first frame, then swaps with each number of threads in turn.
class Swapper {
  public:
    Swapper(const std::shared_ptr<const Product>& product,
            const std::vector<Scene>& looks,
            const View& view,
            const Progress& progress)
        : looks_(looks) {
        const auto start = Clock::now();
        renderer_ = std::make_unique<RadianceRenderer>(product, view, progress);
        FramePlan plan = plan_of(looks.front());
        renderer_->render(looks.front(), plan, progress);
        first_frame_ms_ = milliseconds_since(start);
        const ColourCalibration calibration =
            synthetic_calibration(renderer_->surface_map().coverage);
        table_ = bake(calibration, design_white_luminance(calibration, kDesignWhitePercentile, {}));
        covered_ = count_covered(*renderer_->picture());
    }

    SweepPoint point(int threads) const {
        const SurfaceMap& map = renderer_->surface_map();
        SweepPoint point;
        point.width = map.width;
        point.height = map.height;
        point.threads = threads;
        point.coverage = coverage_of(map);
        point.pixels = static_cast<double>(map.covered_pixels);
        point.first_frame_ms = first_frame_ms_;
        return point;
    }

    using Times = std::array<double, kSwapStages.size()>;
    Times swap(SweepPoint* point) {
        const Scene& look = looks_[static_cast<std::size_t>(++swaps_) % looks_.size()];
        FramePlan plan = plan_of(look);
        const int before = renderer_->counters().fragments_shaded;
        const auto start = Clock::now();
        renderer_->render(look, plan);
        const auto wanted = renderer_->picture();
        const auto corrected = Clock::now();
        CompensationStats stats;
        compensate_again(table_, *wanted, covered_, &drive_, &stats);
        point->fragments_shaded = renderer_->counters().fragments_shaded - before;
        return {milliseconds_of(plan, PassKind::shade),
                milliseconds_of(plan, PassKind::resolve),
                milliseconds_since(corrected),
                milliseconds_since(start)};
    }

  private:
    static FramePlan plan_of(const Scene& look) {
        return plan_frame(look, Quality::draft, FrameStage::radiance);
    }

    const std::vector<Scene>& looks_;
    std::unique_ptr<RadianceRenderer> renderer_;
    CompensationTable table_;
    std::size_t covered_ = 0;
    Image8 drive_;
    double first_frame_ms_ = 0.0;
    int swaps_ = 0;
};

}  // namespace

const char* to_string(SwapStage stage) {
    switch (stage) {
        case SwapStage::shading:
            return "shading";
        case SwapStage::mixing:
            return "mixing to pixels";
        case SwapStage::correction:
            return "correction";
        case SwapStage::whole:
            break;
    }
    return "paint swap to projector input";
}

View zoomed_to_coverage(
    const Product& product, const View& view, int width, int height, double coverage) {
    const Tracer tracer(product.mesh);
    constexpr int kSamples = 16, kShare = 8;
    const View small = resized(view, view.width / 4, view.height / 4);
    const glm::dvec2 middle =
        4.0 * extent_of(build_surface_map(product.mesh, tracer, small, kSamples)).middle_px;
    const double fit = std::min(static_cast<double>(width) / view.width,
                                static_cast<double>(height) / view.height);
    double low = fit / 64.0, high = fit * 64.0;
    for (int k = 0; k < 12; ++k) {
        const double scale = std::sqrt(low * high);
        const View tried =
            resized(zoomed(view, width, height, scale, middle), width / kShare, height / kShare);
        const SurfaceMap map = build_surface_map(product.mesh, tracer, tried, kSamples);
        (extent_of(map).area < coverage ? low : high) = scale;
    }
    return zoomed(view, width, height, std::sqrt(low * high), middle);
}

std::vector<SweepPoint> run_speed_sweep(const std::shared_ptr<const Product>& product,
                                        const std::vector<Scene>& looks,
                                        const View& projector,
                                        bool quick,
                                        const Progress& progress) {
    const ThreadCount all;
    std::vector<SweepPoint> sweep;
    const std::size_t sizes = quick ? 2 : kSizes.size();
    double done = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < sizes; ++i) whole += kSizes[i][0] * kSizes[i][1];
    for (std::size_t i = 0; i < sizes; ++i) {
        const auto [width, height] = kSizes[i];
        for (const double coverage : kCoverages) {
            progress.update(
                done / whole,
                fmt::format("sweep: {}x{}, {:.0f}% mock-up", width, height, 100.0 * coverage));
            const View view = zoomed_to_coverage(*product, projector, width, height, coverage);
            Swapper swapper(product, looks, view, Progress{{}, progress.stop});
            std::vector<SweepPoint> points;
            for (const int threads : all.to_try()) points.push_back(swapper.point(threads));
            std::vector<std::array<std::vector<double>, kSwapStages.size()>> ms(points.size());
            for (int k = 0; k < kRepeats + 1; ++k) {
                progress.check_stop();
                for (std::size_t p = 0; p < points.size(); ++p) {
                    set_thread_count(points[p].threads);
                    const Swapper::Times times = swapper.swap(&points[p]);
                    if (k == 0) continue;  // first touch of what is kept
                    for (std::size_t s = 0; s < times.size(); ++s) ms[p][s].push_back(times[s]);
                }
            }
            set_thread_count(all.to_try().back());
            for (std::size_t p = 0; p < points.size(); ++p) {
                points[p].repeats = kRepeats;
                for (std::size_t s = 0; s < kSwapStages.size(); ++s) {
                    points[p].times[s] = time_of(std::move(ms[p][s]));
                }
                sweep.push_back(points[p]);
            }
            done += coverage / 1.2 * width * height;
        }
    }
    return sweep;
}

PowerLaw fit_power_law(const std::vector<SweepPoint>& sweep, SwapStage stage, int threads) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    std::vector<double> ns_a_pixel;
    for (const SweepPoint& point : sweep) {
        const double ms = point.of(stage).ms;
        if (point.threads != threads || ms <= 0.0) continue;
        const double u = std::log(point.pixels), v = std::log(ms);
        ns_a_pixel.push_back(1e6 * ms / point.pixels);
        n += 1.0;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
        yy += v * v;
    }
    PowerLaw law;
    const double spread_x = n * xx - x * x, spread_y = n * yy - y * y;
    if (n < 2.0 || spread_x <= 0.0) return law;
    law.slope = (n * xy - x * y) / spread_x;
    law.scale = std::exp((y - law.slope * x) / n);
    law.r2 = spread_y > 0.0 ? law.slope * law.slope * spread_x / spread_y : 1.0;
    std::sort(ns_a_pixel.begin(), ns_a_pixel.end());
    law.typical_ns = ns_a_pixel[ns_a_pixel.size() / 2];
    law.spread = ns_a_pixel.back() / ns_a_pixel.front();
    return law;
}

std::vector<int> threads_of(const std::vector<SweepPoint>& sweep) {
    std::set<int> threads;
    for (const SweepPoint& point : sweep) threads.insert(point.threads);
    return {threads.begin(), threads.end()};
}

}  // namespace livery
