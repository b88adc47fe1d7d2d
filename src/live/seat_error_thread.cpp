#include "live/seat_error_thread.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <optional>
#include <utility>

#include "appearance/parameter_table.h"
#include "core/memory.h"
#include "core/pictures/picture_means.h"
#include "core/worker.h"
#include "live/low_priority.h"
#include "scene/artwork_coats.h"

namespace livery {

namespace {

constexpr std::size_t kMostKept = 128;  // maps of a quarter of a megabyte

/// The same picture for the same eye.
bool same_picture(const Scene& a, const Scene& b) {
    const auto all_same = [](const auto& one, const auto& other, const auto& same) {
        return std::equal(one.begin(), one.end(), other.begin(), other.end(), same);
    };
    return a.product == b.product && a.environment == b.environment && a.lights == b.lights &&
           a.eye_in_world_mm == b.eye_in_world_mm && a.exposure_ev == b.exposure_ev &&
           all_same(a.part_materials, b.part_materials, same_reflectance) &&
           all_same(a.artwork, b.artwork, looks_alike) && same_relief(a.relief, b.relief);
}

struct Known {
    Scene scene;
    glm::dvec3 eye_mm{0.0};  ///< the seat's
    SeatErrorMap map;
};

struct SeatErrorJobs {
    std::optional<SeatErrorRequest> request;
    std::uint64_t asked = 0;  ///< the newest request's number
    std::shared_ptr<const SeatErrorResults> newest;
};

}  // namespace

struct SeatErrorThread::Implementation {
    std::function<void()> on_change;
    std::atomic<bool> abandon{false};  ///< what runs now
    std::atomic<std::size_t> drawn{0};

    // Of the thread only
    std::shared_ptr<const Product> product;
    View view;
    EffectLevels levels{};
    std::unique_ptr<SeatPictures> pictures;
    std::vector<Known> known;

    Worker<SeatErrorJobs> worker;

    const Known* find(const Scene& scene, const glm::dvec3& eye_mm) const {
        const auto found = std::find_if(known.begin(), known.end(), [&](const Known& one) {
            return one.eye_mm == eye_mm && same_picture(one.scene, scene);
        });
        return found == known.end() ? nullptr : &*found;
    }

    void answer(const SeatErrorRequest& asked);
    void make_pictures(const SeatErrorRequest& asked, const Progress& progress);
    SeatErrorResults take_known(const SeatErrorRequest& asked);
    void find_rest(const SeatErrorRequest& asked,
                   SeatErrorResults& results,
                   const Progress& progress);
    void publish(const SeatErrorResults& results) {
        auto shared = std::make_shared<const SeatErrorResults>(results);
        worker.use([&](SeatErrorJobs& jobs) {
            if (results.number == jobs.asked) jobs.newest = std::move(shared);
        });
        on_change();
    }
};

/// What stands. Looks that are gone back to stand, too.
SeatErrorResults SeatErrorThread::Implementation::take_known(const SeatErrorRequest& asked) {
    if (asked.view != view || asked.levels != levels) known.clear();
    SeatErrorResults results;
    results.number = asked.number;
    results.wanted = asked.looks.size() * asked.seats.size();
    std::vector<Known> used;
    for (const SeatErrorRequest::Of& of : asked.looks) {
        for (const EyeSeat& seat : asked.seats) {
            const Known* one = find(of.scene, seat.eye_mm);
            if (!one) continue;
            results.looks[of.look][seat.number] = one->map;
            ++results.done;
            used.push_back(*one);
        }
    }
    // Those last: what nobody asked for the longest goes first
    for (const Known& one : used) {
        std::erase_if(known, [&](const Known& other) { return other.map.steps == one.map.steps; });
    }
    known.insert(known.end(), used.begin(), used.end());
    if (known.size() > kMostKept) {
        known.erase(known.begin(), known.end() - static_cast<std::ptrdiff_t>(kMostKept));
    }
    return results;
}

void SeatErrorThread::Implementation::make_pictures(const SeatErrorRequest& asked,
                                                    const Progress& progress) {
    const auto& wanted = asked.looks.front().scene.product;
    if (pictures && product == wanted && view == asked.view && levels == asked.levels) return;
    pictures.reset();
    pictures = std::make_unique<SeatPictures>(wanted, asked.view, asked.levels, progress);
    product = wanted;
    view = asked.view;
    levels = asked.levels;
}

void SeatErrorThread::Implementation::find_rest(const SeatErrorRequest& asked,
                                                SeatErrorResults& results,
                                                const Progress& progress) {
    for (const SeatErrorRequest::Of& of : asked.looks) {
        ImageF projected;
        for (const EyeSeat& seat : asked.seats) {
            if (find(of.scene, seat.eye_mm)) continue;
            make_pictures(asked, progress);
            const auto draw = [&](const glm::dvec3& eye_mm) {
                ++drawn;
                return pictures->drawn_for(of.scene, eye_mm, progress);
            };
            if (projected.empty()) projected = draw(of.scene.eye_in_world_mm);
            const bool in_use = seat.eye_mm == of.scene.eye_in_world_mm;
            const ImageF de00 =
                colour_difference_map(projected, in_use ? projected : draw(seat.eye_mm));
            const SeatErrorMap map{seat_error(de00),
                                   std::make_shared<const Image8>(seat_map_steps(de00))};
            known.push_back({of.scene, seat.eye_mm, map});
            results.looks[of.look][seat.number] = map;
            ++results.done;
            publish(results);
        }
    }
}

void SeatErrorThread::Implementation::answer(const SeatErrorRequest& asked) {
    Progress progress;
    progress.stop = &abandon;
    SeatErrorResults results = take_known(asked);
    publish(results);
    try {
        find_rest(asked, results, progress);
    } catch (const Cancelled&) {
    } catch (const std::exception& error) {
        pictures.reset();
        results.problem = error.what();
        publish(results);
    }
    return_freed_memory();
}

SeatErrorThread::SeatErrorThread(std::function<void()> on_change)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& it = *implementation_;
    it.on_change = std::move(on_change);
    it.worker.start([&it] {
        lower_priority_of_this_thread(Urgency::background);
        it.worker.serve([&it](SeatErrorJobs& jobs) -> Worker<SeatErrorJobs>::Turn {
            if (!jobs.request) return {};
            it.abandon = false;
            return {
                [&it, asked = *std::exchange(jobs.request, std::nullopt)] { it.answer(asked); }};
        });
    });
}

SeatErrorThread::~SeatErrorThread() {
    implementation_->worker.stop();  // first: the next job would take `abandon` back
    implementation_->abandon = true;
}

void SeatErrorThread::ask(SeatErrorRequest request) {
    implementation_->worker.change([&](SeatErrorJobs& jobs) {
        jobs.asked = request.number;
        jobs.request = std::move(request);
        implementation_->abandon = true;
    });
}

std::shared_ptr<const SeatErrorResults> SeatErrorThread::newest() const {
    return implementation_->worker.use([](const SeatErrorJobs& jobs) { return jobs.newest; });
}

std::size_t SeatErrorThread::drawn() const { return implementation_->drawn; }

Image8 seat_map_steps(const ImageF& de00) {
    Image8 steps(de00.width, de00.height, 1);
    for (std::size_t i = 0; i < de00.pixel_count(); ++i) {
        const float difference = de00.values[i];
        if (std::isnan(difference)) continue;
        const double share = std::min(static_cast<double>(difference) / kSeatMapScale, 1.0);
        steps.values[i] = static_cast<std::uint8_t>(1 + std::lround(254.0 * share));
    }
    return steps;
}

}  // namespace livery
