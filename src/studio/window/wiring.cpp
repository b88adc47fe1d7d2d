#include "studio/window/wiring.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/log.h"
#include "live/projector_setup.h"
#include "scene/library.h"
#include "scene/view.h"
#include "studio/calibration_panel.h"
#include "studio/capture/capture_panel.h"
#include "studio/kit/words.h"
#include "studio/light/lighting_panel.h"
#include "studio/light/reference_tracing.h"
#include "studio/nudge/nudge_panel.h"
#include "studio/paint/users_library.h"
#include "studio/presenting/presenting.h"
#include "studio/results.h"
#include "studio/seats/seat_maps.h"
#include "studio/window/first_calibration.h"
#include "studio/window/refinement.h"
#include "studio/window/shell.h"

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

void take_setup(Shell& shell, std::shared_ptr<const ProjectorSetup> setup) {
    shell.studio.setup = std::move(setup);
    shell.mock_up_columns = columns_of(*shell.studio.product, shell.studio.setup->view);
    shell.photographed.reset();
    shell.asked_preview.reset();  // it shows glints in this projector's pixels
}

/// A new calibration, bench, design white or gamut mapping is loaded beside the frames, which go on
/// as they were.
void ask_for_setup(Shell& shell) {
    const Document document = shown_document(shell.studio);
    const SetupKey key{document.calibration,
                       document.bench,
                       document.design_white_percentile,
                       document.gamut_mapping};
    if (shell.asked_setup == key) return;
    if (!shell.asked_setup || shell.asked_setup->bench != key.bench) {
        shell.studio.bench->use(key.bench, shell.studio.product);
    }
    shell.asked_setup = key;
    const auto still_wanted = [&shell, key] { return shell.asked_setup == key; };
    shell.studio.background->run(
        [&shell, key, still_wanted, product = shell.studio.product](
            const Progress&) -> Background::Then {
            const auto setup = key.calibration.empty() ? uncorrected_setup(key.bench)
                                                       : load_setup(key.calibration,
                                                                    key.design_white_percentile,
                                                                    product->mesh,
                                                                    key.gamut_mapping);
            return [&shell, setup, still_wanted] {
                if (still_wanted()) take_setup(shell, setup);
            };
        },
        [&shell, key, still_wanted](std::exception_ptr why) {
            if (!still_wanted()) return;
            notify_failure(shell.studio,
                           key.calibration.empty() ? "There is no projector to draw for."
                                                   : "The calibration could not be loaded.",
                           why);
            // Something must be shown: the same projector, uncorrected, and the panel says so.
            if (key.calibration.empty() || shell.studio.setup) return;
            shell.studio.background->run(
                [&shell, key](const Progress&) -> Background::Then {
                    return [&shell, setup = uncorrected_setup(key.bench)] {
                        take_setup(shell, setup);
                    };
                },
                [&shell](std::exception_ptr again) {
                    notify_failure(shell.studio, "There is no projector to draw for.", again);
                });
        });
}

/// A file that a look needs may go bad at any time.
void tell_drawing_problems(Shell& shell, const Document& document, int look) {
    const SessionLook* shown = find_look(document, look);
    if (!shown) return;
    std::vector<std::string> problems = drawing_problems(document, *shown);
    std::vector<std::string>& told = shell.told_problems[look];
    for (const std::string& problem : problems) {
        if (std::find(told.begin(), told.end(), problem) != told.end()) continue;
        notify(shell.studio,
               {Notice::Level::warning,
                problem,
                "",
                "Put the file back, or choose another; then change something to draw it again."});
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
std::uint64_t show_frame(Shell& shell,
                         const Document& document,
                         FrameDescription description,
                         const std::string& tried) {
    Studio& studio = shell.studio;
    const std::uint64_t number = ++shell.frame_number;
    stop_tracing(studio);
    description.number = number;
    description.setup = studio.setup;
    description.library = document.library;
    description.asked_at = shell.input_at;
    shell.trace->write("frame-asked", number, tried);
    studio.frames->show(std::move(description));
    return number;
}

void ask_for_frame(Shell& shell) {
    Studio& studio = shell.studio;
    if (!studio.setup || preview_goes_first(shell)) return;
    FrameKey key;
    key.revision = studio.session.revision();
    key.tried = text_of_trial(studio);
    key.look = look_on_show(studio);
    key.wipe_to = look_to_wipe_to(studio);
    if (key.wipe_to) key.wipe_at = studio.wipe_at;
    key.glowing_part = studio.glowing_part;
    key.setup = studio.setup;
    const bool asked = shell.asked_frame == key && stands_refined(shell);
    if (asked && !refinement_is_due(shell)) return;
    const Document document = shown_document(studio);
    FrameDescription description;
    try {
        description.scene = scene_for(shell, document, key.look);
        if (key.wipe_to) description.wipe_to = scene_for(shell, document, *key.wipe_to);
    } catch (const std::exception& error) {
        shell.asked_frame = key;
        shell.not_drawn = error.what();
        notify(studio, {Notice::Level::error, "The look cannot be drawn.", error.what(), ""});
        return;
    }
    if (const auto unread = unread_files(description); !unread.empty()) {
        // Asked for again when they are read; the last picture stays until then.
        refresh_library(studio, unread);
        shell.not_drawn = "Reading " + unread.begin()->filename().string() + ".";
        return;
    }
    tell_drawing_problems(shell, document, key.look);
    if (key.wipe_to) tell_drawing_problems(shell, document, *key.wipe_to);
    shell.not_drawn.clear();
    shell.asked_frame = key;
    shell.frame_asked_s = studio.now_s;
    description.wipe_at = key.wipe_at;
    description.glowing_part = key.glowing_part;
    description.setup = studio.setup;
    description.quality = document.quality;
    description.levels = document.levels;
    if (asked) {
        shell.refinement.on = true;
        description.fade_s = kRefinementFade_s;
    } else {
        begin_anew(shell, description);
    }
    if (shell.refinement.on) {
        if (const auto finer = refined_levels(document)) description.levels = finer;
        description.refined = true;
    }
    show_frame(shell, document, std::move(description), key.tried);
}

void ask_for_preview(Shell& shell) {
    Studio& studio = shell.studio;
    const StageState& stage = shell.stage;
    const bool seen = studio.view == StageView::preview || studio.view == StageView::eye;
    if (!seen || stage.width <= 0 || stage.height <= 0) return;
    PreviewKey key;
    key.revision = studio.session.revision();
    key.tried = text_of_trial(studio);
    key.look = look_on_show(studio);
    key.view = studio.view;
    const Orbit orbit = stage_orbit(shell);
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
    if (shell.asked_preview == key) {
        shell.preview_lag.held_since.reset();
        return;
    }
    // The mock-up goes first where both are drawn by the same processor, but not for long.
    shell.preview_waits_until_s = 0.0;
    const bool same_scene =
        shell.asked_preview && shell.asked_preview->revision == key.revision &&
        shell.asked_preview->tried == key.tried && shell.asked_preview->look == key.look &&
        shell.asked_preview->wipe_to == key.wipe_to && shell.asked_preview->wipe_at == key.wipe_at;
    if (shell.draws_in_software && studio.opening && !preview_goes_first(shell)) return;
    const double patience_until_s = shell.frame_asked_s + kPreviewPatience_s;
    if (shell.draws_in_software && !same_scene && is_frame_under_way(shell) &&
        studio.now_s < patience_until_s) {
        shell.preview_waits_until_s = patience_until_s;
        if (!shell.preview_lag.held_since) shell.preview_lag.held_since = studio.now_s;
        return;
    }
    const Document document = shown_document(studio);
    PreviewDescription description;
    try {
        description.scene = scene_for(shell, document, key.look);
        if (key.wipe_to) description.wipe_to = scene_for(shell, document, *key.wipe_to);
    } catch (const std::exception&) {
        return;  // Told when the frame was asked for.
    }
    if (!unread_files(description).empty()) return;
    shell.asked_preview = key;
    description.number = ++shell.preview_number;
    note_asked(shell.preview_lag, description.number, key.view, studio.now_s);
    description.view = stage_view(shell, eye_in_use_mm(document));
    if (studio.setup) description.projector = studio.setup->view;
    description.highlighted_part = key.highlighted_part;
    description.wipe_at = key.wipe_at;
    studio.previews->show(std::move(description));
}

void ask_for_photograph(Shell& shell) {
    const Studio& studio = shell.studio;
    if (studio.view != StageView::photograph || !studio.frame || !studio.setup) return;
    const glm::dvec3 eye_mm = eye_in_use_mm(shown_document(studio));
    if (shell.nudge_open) {
        NudgePanelState& nudge = *studio.panels.nudge;
        if (!nudge.lines || nudge.photographed == nudge.lines) return;
        nudge.photographed = nudge.lines;
        studio.bench->photograph(
            studio.frame->number, nudge.lines, eye_mm, studio.setup->design_white_y);
        return;
    }
    // Not by its number: a frame comes again when more of it is there.
    const bool same =
        studio.frame->pictures == shell.photographed && eye_mm == shell.photographed_from_mm;
    if (same || !studio.frame->pictures) return;
    shell.photographed = studio.frame->pictures;
    shell.photographed_from_mm = eye_mm;
    studio.bench->photograph(
        studio.frame->number, drive_of(*shell.photographed), eye_mm, studio.setup->design_white_y);
}

/// A part glows for its time from when its picture is drawn, however long that takes.
void end_glow(Shell& shell) {
    Studio& studio = shell.studio;
    if (!studio.glowing_part) return;
    const bool drawn = !studio.setup || (shell.asked_frame &&
                                         shell.asked_frame->glowing_part == studio.glowing_part &&
                                         !is_frame_under_way(shell));
    if (!drawn) {
        studio.glowing_until_s = std::max(studio.glowing_until_s, studio.now_s + kGlow_s);
    } else if (studio.now_s >= studio.glowing_until_s) {
        studio.glowing_part.reset();
    }
}

}  // namespace

bool preview_goes_first(const Shell& shell) {
    const Studio& studio = shell.studio;
    const bool in_window = studio.view == StageView::preview || studio.view == StageView::eye;
    const bool drawn =
        studio.preview && (studio.preview->texture || !studio.preview->problem.empty());
    return shell.draws_in_software && studio.opening && in_window && !drawn &&
           shell.projector_monitor.empty() && studio.now_s < shell.opened_s + kPreviewFirst_s;
}

bool is_frame_under_way(const Shell& shell) {
    if (!shell.studio.setup) return false;
    const auto newest = shell.results->newest_frame();
    if (shell.frame_number == 0) return false;
    if (!newest || newest->number < shell.frame_number) return true;
    // What is drawn here now would stand before the projector's swap in the driver's queue.
    return newest->problem.empty() && shell.results->awaits_projector();
}

Contexts start_threads(Shell& shell, const Window& window, ShadingDevice shading) {
    Studio& studio = shell.studio;
    shell.draws_in_software = window.is_software();
    shading = chosen_device(shading);
    shell.drawn_with =
        fmt::format("Drawn with {}. The mock-up's picture is shaded and corrected {}.",
                    window.renderer(),
                    shading == ShadingDevice::gl ? "by it, and stays there" : "on the processor");
    shell.opened_s = studio.now_s;
    Contexts contexts;
    WindowOptions hidden;
    hidden.title = "Livery (drawing)";
    hidden.size_px = {16, 16};
    hidden.visible = false;
    for (int i = 0; i < 4; ++i) contexts.push_back(std::make_unique<Window>(hidden, &window));
    shell.results = std::make_shared<Results>(shell.trace);
    Results* results = shell.results.get();
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
    find_first_calibration(shell);
    ask_for_setup(shell);
    return contexts;
}

void stop_threads(Shell& shell) {
    Studio& studio = shell.studio;
    stop_seat_errors(studio);
    studio.background.reset();
    studio.panels.lighting->reference.thread.reset();
    studio.panels.lighting->accuracy.thread.reset();
    studio.capture.reset();
    studio.frames.reset();
    studio.previews.reset();
    studio.bench.reset();
    if (shell.results) shell.results->use(nullptr);
    presenting(studio).picture.reset();
    studio.projector.reset();
    studio.frame.reset();
    studio.preview.reset();
    studio.photograph.reset();
    if (shell.results) shell.results->clear();
    studio.panels.lighting->reference = {};
}

void take_results(Shell& shell) {
    Studio& studio = shell.studio;
    studio.background->take_results();
    studio.frame = shell.results->newest_drawn();
    studio.preview = shell.results->newest_preview();
    studio.photograph = studio.bench->newest_photograph();
    start_first_calibration(shell);
    take_calibration(shell);
    take_capture(shell);
    take_nudge(shell);
    take_traced(shell);
    step_vote_mode(shell);
    end_glow(shell);
    const auto newest = shell.results->newest_frame();
    if (newest && !newest->problem.empty() && newest->number > shell.problem_number) {
        shell.problem_number = newest->number;
        notify(studio,
               {Notice::Level::error,
                "The picture could not be drawn; the last good one stays.",
                newest->problem,
                ""});
    }
}

Scene scene_for(Shell& shell, const Document& document, int look) {
    const auto& reference = find_look(document, look)->look.environment;
    auto& kept = shell.environments[{reference.file, reference.rotation_rad, reference.scale}];
    Scene scene = scene_of(document, look, shell.studio.product, kept);
    kept = scene.environment;
    constexpr std::size_t most_kept = 16;
    if (shell.environments.size() > most_kept) shell.environments.clear();
    return scene;
}

std::optional<std::uint64_t> ask_for_look(Shell& shell, int look) {
    Studio& studio = shell.studio;
    const Document& document = studio.session.document();
    FrameDescription description;
    description.scene = scene_for(shell, document, look);
    if (const auto unread = unread_files(description); !unread.empty()) {
        refresh_library(studio, unread);
        return std::nullopt;
    }
    shell.frame_asked_s = studio.now_s;
    description.quality = document.quality;
    description.levels = document.levels;
    return show_frame(shell, document, std::move(description), "");
}

void ask_for_changes(Shell& shell) {
    ask_for_setup(shell);
    step_seat_errors(shell);
    // Frozen looks alone are to be seen.
    if (is_presenting(shell.studio)) return;
    // The program was started with a mesh: what stands behind its page may never be wanted.
    if (shell.new_session && !shell.asked_frame) {
        shell.frame_asked_s = shell.studio.now_s;
        return;
    }
    ask_for_frame(shell);
    ask_for_preview(shell);
    ask_for_photograph(shell);
}

}  // namespace livery
