#include "studio/drawing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/log.h"
#include "jobs/calibrate/calibration_folder.h"
#include "live/projector_setup.h"
#include "scene/library.h"
#include "scene/view.h"
#include "studio/users_library.h"

namespace livery {

namespace {

constexpr double kPreviewPatience_s = 0.3;
constexpr double kRefinementFade_s = 0.6;
constexpr double kPreviewFirst_s = 20.0;  // nobody looks at the mock-up yet

std::string text_of_trial(const Studio& studio) {
    return studio.tried ? text_of(*studio.tried) : std::string();
}

int look_on_show(const Studio& studio) {
    return studio.showing_b && studio.compared_look ? *studio.compared_look : studio.shown_look;
}

/// Where the mock-up lies in the projector's picture: what a wipe goes across.
std::optional<std::pair<double, double>> columns_of(const Product& product, const View& view) {
    double low = view.width, high = 0.0;
    for (const glm::vec3& x : product.mesh.positions_mm) {
        const auto pixel = project(view, glm::dvec3(x));
        if (!pixel) continue;
        low = std::min(low, pixel->x);
        high = std::max(high, pixel->x);
    }
    if (high <= low) return {};
    return std::pair{std::max(low, 0.0), std::min(high, static_cast<double>(view.width))};
}

void take_setup(Studio& studio, std::shared_ptr<const ProjectorSetup> setup) {
    studio.setup = std::move(setup);
    const auto& origin = studio.setup->origin;
    const std::string why = origin ? another_product(*origin, *studio.product) : "";
    studio.other_product = why.empty() ? "" : sentence(why) + " Calibrate again.";
    studio.mock_up_columns = columns_of(*studio.product, studio.setup->view);
    studio.photographed.reset();
    studio.asked_preview.reset();  // it shows glints in this projector's pixels
}

/// A new calibration, bench, design white or gamut mapping is loaded beside the frames, which go on
/// as they were.
void ask_for_setup(Studio& studio) {
    std::pair read_off{studio.session.revision(), text_of_trial(studio)};
    if (studio.asked_setup && studio.asked_setup_of == read_off) return;
    studio.asked_setup_of = std::move(read_off);
    const Document document = shown_document(studio);
    const SetupKey key{document.calibration,
                       document.bench,
                       document.design_white_percentile,
                       document.gamut_mapping};
    if (studio.asked_setup == key) return;
    if (!studio.asked_setup || studio.asked_setup->bench != key.bench) {
        studio.bench->use(key.bench, studio.product);
    }
    studio.asked_setup = key;
    const auto still_wanted = [&studio, key] { return studio.asked_setup == key; };
    studio.background->run(
        [&studio, key, still_wanted, product = studio.product](
            const Progress&) -> Background::Then {
            const auto setup = key.calibration.empty() ? uncorrected_setup(key.bench)
                                                       : load_setup(key.calibration,
                                                                    key.design_white_percentile,
                                                                    product->mesh,
                                                                    key.gamut_mapping);
            return [&studio, setup, still_wanted] {
                if (still_wanted()) take_setup(studio, setup);
            };
        },
        [&studio, key, still_wanted](std::exception_ptr why) {
            if (!still_wanted()) return;
            notify_failure(studio,
                           key.calibration.empty() ? "There is no projector to draw for."
                                                   : "The calibration could not be loaded.",
                           why);
            // Something must be shown: the same projector, uncorrected, and the panel says so.
            if (key.calibration.empty() || studio.setup) return;
            in_background(studio,
                          "There is no projector to draw for.",
                          [&studio, key](const Progress&) -> Background::Then {
                              return [&studio, setup = uncorrected_setup(key.bench)] {
                                  take_setup(studio, setup);
                              };
                          });
        });
}

/// A file that a look needs may go bad at any time.
void tell_drawing_problems(Studio& studio, const Document& document, int look) {
    const SessionLook* shown = find_look(document, look);
    if (!shown) return;
    std::vector<std::string> problems = drawing_problems(document, *shown);
    std::vector<std::string>& told = studio.told_problems[look];
    for (const std::string& problem : problems) {
        if (std::find(told.begin(), told.end(), problem) != told.end()) continue;
        tell_warning(
            studio,
            problem,
            "",
            "Put the file back, or choose another; then change something to draw it again.");
    }
    told = std::move(problems);
}

std::optional<int> look_to_wipe_to(const Studio& studio) {
    return studio.wiping && !studio.showing_b ? studio.compared_look : std::nullopt;
}

/// Of a frame's or a preview's scenes.
template <typename Description>
std::set<std::filesystem::path> unread_files(const Description& description) {
    auto files = unread_files(description.scene);
    if (description.wipe_to) files.merge(unread_files(*description.wipe_to));
    return files;
}

/// With what all frames of the document share; its number.
std::uint64_t show_frame(Studio& studio,
                         const Document& document,
                         WantedFrame frame,
                         const std::string& tried) {
    const std::uint64_t number = ++studio.frame_number;
    frame.number = number;
    frame.library = document.library;
    frame.asked_at = studio.input_at;
    studio.trace->write("frame-asked", number, tried);
    studio.frames->show(std::move(frame));
    return number;
}

void ask_for_frame(Studio& studio) {
    if (!studio.setup || preview_goes_first(studio)) return;
    FrameKey key;
    key.revision = studio.session.revision();
    key.tried = text_of_trial(studio);
    key.look = look_on_show(studio);
    key.wipe_to = look_to_wipe_to(studio);
    if (key.wipe_to) key.wipe_at = studio.wipe_at;
    key.glowing_part = studio.glowing_part;
    key.setup = studio.setup;
    const bool asked = studio.asked_frame == key && stands_refined(studio);
    if (asked && !refinement_is_due(studio)) return;
    const Document document = shown_document(studio);
    FrameDescription description;
    try {
        description.scene = scene_for(studio, document, key.look);
        if (key.wipe_to) description.wipe_to = scene_for(studio, document, *key.wipe_to);
    } catch (const std::exception& error) {
        studio.asked_frame = key;
        studio.not_drawn = error.what();
        tell_error(studio, "The look cannot be drawn.", error.what());
        return;
    }
    if (const auto unread = unread_files(description); !unread.empty()) {
        // Asked for again when they are read; the last picture stays until then.
        refresh_library(studio, unread);
        studio.not_drawn = "Reading " + unread.begin()->filename().string() + ".";
        return;
    }
    tell_drawing_problems(studio, document, key.look);
    if (key.wipe_to) tell_drawing_problems(studio, document, *key.wipe_to);
    studio.not_drawn.clear();
    studio.asked_frame = key;
    studio.frame_asked_s = studio.now_s;
    description.wipe_at = key.wipe_at;
    description.glowing_part = key.glowing_part;
    description.setup = studio.setup;
    description.quality = document.quality;
    description.levels = document.levels;
    WantedFrame frame(std::move(description));
    if (asked) {
        studio.refinement.on = true;
        frame.fade_s = kRefinementFade_s;
    } else {
        begin_anew(studio, frame);
    }
    if (studio.refinement.on) {
        if (const auto finer = refined_levels(document)) {
            frame.levels = finer;
            frame = WantedFrame(FrameDescription(std::move(frame)));
        }
        frame.refined = true;
    }
    show_frame(studio, document, std::move(frame), key.tried);
}

void ask_for_preview(Studio& studio) {
    const StageState& stage = studio.stage;
    const bool seen = studio.view == StageView::preview || studio.view == StageView::eye;
    if (!seen || stage.width <= 0 || stage.height <= 0) return;
    PreviewKey key;
    key.revision = studio.session.revision();
    key.tried = text_of_trial(studio);
    key.look = look_on_show(studio);
    key.view = studio.view;
    const Orbit orbit = stage_orbit(studio);
    key.camera = {orbit.azimuth_rad,
                  orbit.elevation_rad,
                  orbit.distance_mm,
                  orbit.target_mm.x,
                  orbit.target_mm.y,
                  orbit.target_mm.z,
                  stage.eye_zoom};
    key.width = stage.width;
    key.height = stage.height;
    key.highlighted_part = studio.hovered_part ? studio.hovered_part : studio.glowing_part;
    key.wipe_to = look_to_wipe_to(studio);
    if (key.wipe_to) key.wipe_at = studio.wipe_at;
    if (studio.asked_preview == key) {
        studio.preview_lag.held_since.reset();
        return;
    }
    // The mock-up goes first where both are drawn by the same processor, but not for long.
    studio.preview_waits_until_s = 0.0;
    const bool same_scene =
        studio.asked_preview && studio.asked_preview->revision == key.revision &&
        studio.asked_preview->tried == key.tried && studio.asked_preview->look == key.look &&
        studio.asked_preview->wipe_to == key.wipe_to &&
        studio.asked_preview->wipe_at == key.wipe_at;
    if (studio.draws_in_software && studio.opening && !preview_goes_first(studio)) return;
    const double patience_until_s = studio.frame_asked_s + kPreviewPatience_s;
    if (studio.draws_in_software && !same_scene && is_frame_under_way(studio) &&
        studio.now_s < patience_until_s) {
        studio.preview_waits_until_s = patience_until_s;
        if (!studio.preview_lag.held_since) studio.preview_lag.held_since = studio.now_s;
        return;
    }
    const Document document = shown_document(studio);
    PreviewDescription description;
    try {
        description.scene = scene_for(studio, document, key.look);
        if (key.wipe_to) description.wipe_to = scene_for(studio, document, *key.wipe_to);
    } catch (const std::exception&) {
        return;  // Told when the frame was asked for.
    }
    if (!unread_files(description).empty()) return;
    studio.asked_preview = key;
    description.number = ++studio.preview_number;
    note_asked(studio.preview_lag, description.number, key.view, studio.now_s);
    description.view = stage_view(studio, eye_in_use_mm(document));
    if (studio.setup) description.projector = studio.setup->view;
    description.highlighted_part = key.highlighted_part;
    description.wipe_at = key.wipe_at;
    studio.previews->show(std::move(description));
}

void ask_for_photograph(Studio& studio) {
    if (studio.view != StageView::photograph || !studio.frame || !studio.setup) return;
    if (!studio.instead.caption.empty()) return;  // photographed by whoever shows it
    const glm::dvec3 eye_mm = eye_in_use_mm(shown_document(studio));
    // Not by its number: a frame comes again when more of it is there.
    const bool same =
        studio.frame->pictures == studio.photographed && eye_mm == studio.photographed_from_mm;
    if (same || !studio.frame->pictures) return;
    studio.photographed = studio.frame->pictures;
    studio.photographed_from_mm = eye_mm;
    studio.bench->photograph(
        studio.frame->number, drive_of(*studio.photographed), eye_mm, studio.setup->design_white_y);
}

/// A part glows for its time from when its picture is drawn, however long that takes.
void end_glow(Studio& studio) {
    if (!studio.glowing_part) return;
    const bool drawn = !studio.setup || (studio.asked_frame &&
                                         studio.asked_frame->glowing_part == studio.glowing_part &&
                                         !is_frame_under_way(studio));
    if (!drawn) {
        studio.glowing_until_s = std::max(studio.glowing_until_s, studio.now_s + kGlow_s);
    } else if (studio.now_s >= studio.glowing_until_s) {
        studio.glowing_part.reset();
    }
}

}  // namespace

Orbit stage_orbit(const Studio& studio) {
    const StageState& stage = studio.stage;
    if (stage.orbit) return *stage.orbit;
    return default_orbit(studio.product_bounds,
                         static_cast<double>(stage.width) / static_cast<double>(stage.height));
}

View stage_view(const Studio& studio, glm::dvec3 eye_mm) {
    const StageState& stage = studio.stage;
    if (studio.view != StageView::eye) {
        return view_of(stage_orbit(studio), stage.width, stage.height);
    }
    View view = eye_view(eye_mm, studio.product_bounds, stage.width, stage.height);
    view.focal_px *= stage.eye_zoom;
    return view;
}

void note_asked(PreviewLag& lag, std::uint64_t number, StageView view, double now_s) {
    if (lag.view != view) lag.first_of_view = number;
    lag.view = view;
    // What was held back is a part of it
    lag.asked.push_back({number, std::min(now_s, lag.held_since.value_or(now_s))});
    lag.held_since.reset();
}

bool is_of_view(const PreviewLag& lag, std::uint64_t shown, StageView open) {
    return lag.view == open && shown >= lag.first_of_view;
}

std::optional<double> behind_since_s(PreviewLag& lag, std::uint64_t shown) {
    std::erase_if(lag.asked, [&](const auto& asked) { return asked.number <= shown; });
    return lag.asked.empty() ? lag.held_since : lag.asked.front().at_s;
}

bool preview_goes_first(const Studio& studio) {
    const bool in_window = studio.view == StageView::preview || studio.view == StageView::eye;
    const bool drawn =
        studio.preview && (studio.preview->texture || !studio.preview->problem.empty());
    return studio.draws_in_software && studio.opening && in_window && !drawn &&
           studio.projector_monitor.empty() && studio.now_s < studio.opened_s + kPreviewFirst_s;
}

bool is_frame_under_way(const Studio& studio) {
    if (!studio.setup) return false;
    const auto newest = studio.results->newest_frame();
    if (studio.frame_number == 0) return false;
    if (!newest || newest->number < studio.frame_number) return true;
    // What is drawn here now would stand before the projector's swap in the driver's queue.
    return newest->problem.empty() && studio.results->awaits_projector();
}

Contexts start_threads(Studio& studio, const Window& window, ShadingDevice shading) {
    studio.draws_in_software = window.is_software();
    shading = chosen_device(shading);
    studio.drawn_with =
        fmt::format("Drawn with {}. The mock-up's picture is shaded and corrected {}.",
                    window.renderer(),
                    shading == ShadingDevice::gl ? "by it, and stays there" : "on the processor");
    studio.opened_s = studio.now_s;
    Contexts contexts;
    WindowOptions hidden;
    hidden.title = "Livery (drawing)";
    hidden.size_px = {16, 16};
    hidden.visible = false;
    for (int i = 0; i < 4; ++i) contexts.push_back(std::make_unique<Window>(hidden, &window));
    studio.results = std::make_shared<Results>(studio.trace);
    Results* results = studio.results.get();
    studio.background = std::make_unique<Background>(wake_main_thread);
    studio.bench = std::make_unique<BenchThread>(wake_main_thread);
    studio.previews = std::make_unique<PreviewThread>(
        *contexts[2], [results](auto picture) { results->take(std::move(picture)); });
    studio.frames = std::make_unique<FrameThread>(
        *contexts[0],
        *contexts[1],
        [results](auto frame) { results->take(std::move(frame)); },
        shading);
    studio.projector = std::make_unique<ProjectorScreen>(
        window, studio.desktop, [results](const ShownPicture& picture) {
            results->shown(picture);
        });
    results->use(studio.projector.get());
    studio.capture = std::make_unique<CaptureThread>(*contexts[3], wake_main_thread);
    studio.bench->use(studio.session.document().bench, studio.product);
    refresh_library(studio);
    ask_for_setup(studio);
    for (const Panel& panel : all_panels()) {
        if (panel.start) panel.start(studio);
    }
    return contexts;
}

void stop_threads(Studio& studio) {
    for (const Panel& panel : all_panels()) {
        if (panel.stop) panel.stop(studio);
    }
    studio.background.reset();
    studio.capture.reset();
    studio.frames.reset();
    studio.previews.reset();
    studio.bench.reset();
    if (studio.results) studio.results->use(nullptr);
    studio.instead = {};
    studio.projector.reset();
    studio.frame.reset();
    studio.preview.reset();
    studio.photograph.reset();
    if (studio.results) studio.results->clear();
}

void take_results(Studio& studio) {
    studio.background->take_results();
    studio.frame = studio.results->newest_drawn();
    studio.preview = studio.results->newest_preview();
    studio.photograph = studio.bench->newest_photograph();
    for (const Panel& panel : all_panels()) {
        if (panel.step) panel.step(studio);
    }
    end_glow(studio);
    const auto newest = studio.results->newest_frame();
    if (newest && !newest->problem.empty() && newest->number > studio.problem_number) {
        studio.problem_number = newest->number;
        tell_error(
            studio, "The picture could not be drawn; the last good one stays.", newest->problem);
    }
}

Scene scene_for(Studio& studio, const Document& document, int look) {
    const auto& reference = find_look(document, look)->look.environment;
    auto& kept = studio.environments[{reference.file, reference.rotation_rad, reference.scale}];
    Scene scene = scene_of(document, look, studio.product, kept);
    kept = scene.environment;
    constexpr std::size_t most_kept = 16;
    if (studio.environments.size() > most_kept) studio.environments.clear();
    return scene;
}

std::optional<std::uint64_t> ask_for_look(Studio& studio, int look) {
    const Document& document = studio.session.document();
    FrameDescription description;
    description.scene = scene_for(studio, document, look);
    if (const auto unread = unread_files(description); !unread.empty()) {
        refresh_library(studio, unread);
        return std::nullopt;
    }
    studio.frame_asked_s = studio.now_s;
    description.setup = studio.setup;
    description.quality = document.quality;
    description.levels = document.levels;
    return show_frame(studio, document, std::move(description), "");
}

void ask_for_changes(Studio& studio, bool pictures) {
    ask_for_setup(studio);
    // While people vote frozen looks alone are to be seen.
    if (is_editing_locked(studio)) return;
    if (!pictures) {
        studio.frame_asked_s = studio.now_s;
        return;
    }
    ask_for_frame(studio);
    ask_for_preview(studio);
    ask_for_photograph(studio);
}

}  // namespace livery
