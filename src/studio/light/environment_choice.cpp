#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "core/angles.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/paths.h"
#include "studio/kit/widgets.h"
#include "studio/light/light_values.h"
#include "studio/light/lighting_panel.h"

namespace livery {

namespace {

constexpr int kThumbnailWidth = 512;
constexpr const char* kFolder = "assets/environments";

/// Names as a look gives them: "assets/environments/studio.hdr".
std::vector<std::string> shipped_environments() {
    std::vector<std::string> names;
    for (const auto& entry : list_folder(shipped_path(kFolder), {".hdr", ".exr"}, false)) {
        if (!entry.is_folder) names.push_back(std::string(kFolder) + "/" + entry.name);
    }
    return names;
}

std::string shown_name(const std::string& file) {
    return file.empty() ? "None" : std::filesystem::path(file).stem().string();
}

/// Small, sRGB, bright parts rolled off, so that both lamps and walls are seen.
Image8 thumbnail_of(const Environment& environment) {
    const ImageF& map = environment.radiance_working;
    const int width = std::min(kThumbnailWidth, map.width), height = std::max(1, width / 2);
    Image8 picture(width, height, 4, 255);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int x0 = x * map.width / width,
                      x1 = std::max(x0 + 1, (x + 1) * map.width / width);
            const int y0 = y * map.height / height,
                      y1 = std::max(y0 + 1, (y + 1) * map.height / height);
            glm::dvec3 sum(0.0);
            for (int v = y0; v < y1; ++v) {
                for (int u = x0; u < x1; ++u) {
                    for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(map.at(u, v, c));
                }
            }
            const glm::dvec3 rec709 = rec709_from_working() * (sum / double((x1 - x0) * (y1 - y0)));
            for (int c = 0; c < 3; ++c) {
                const double value = std::max(rec709[c], 0.0);
                const double encoded = srgb_encode(value / (1.0 + 0.6 * value));
                picture.at(x, y, c) =
                    static_cast<std::uint8_t>(std::lround(255.0 * std::min(encoded, 1.0)));
            }
        }
    }
    return picture;
}

void ask_for_thumbnail(Studio& studio, const std::string& file) {
    LightingPanelState& state = studio.panels.of<LightingPanelState>();
    if (state.thumbnail_of == file || !studio.background) return;
    state.thumbnail_of = file;
    state.thumbnail = {};
    state.thumbnail_problem.clear();
    if (file.empty()) return;
    const auto load = [&studio, file](const Progress&) -> Background::Then {
        const Image8 picture = thumbnail_of(load_environment({file, 0.0, 1.0}, {}));
        return [&studio, file, picture] {
            LightingPanelState& panel = studio.panels.of<LightingPanelState>();
            if (panel.thumbnail_of != file) return;
            panel.thumbnail = texture_of(picture, TexelWrap::repeat);
        };
    };
    studio.background->run(load, [&studio, file](const std::exception_ptr& failure) {
        if (studio.panels.of<LightingPanelState>().thumbnail_of != file) return;
        try {
            std::rethrow_exception(failure);
        } catch (const std::exception& error) {
            studio.panels.of<LightingPanelState>().thumbnail_problem = error.what();
        }
    });
}

void draw_thumbnail(const LightingPanelState& state, double rotation_rad) {
    if (!state.thumbnail_problem.empty()) warning_text("Not shown: " + state.thumbnail_problem);
    const float width = ImGui::GetContentRegionAvail().x, height = std::floor(0.32f * width);
    if (!state.thumbnail) {
        if (state.thumbnail_problem.empty()) ImGui::Dummy({width, height});
        return;
    }
    // The left edge is azimuth -180 degrees; straight up and down is left out.
    const auto left = static_cast<float>(rotation_rad / (2.0 * std::numbers::pi));
    ImGui::Image(imgui_texture(state.thumbnail.name()),
                 {width, height},
                 {left, 0.14f},
                 {left + 1.0f, 0.78f});
    name_last_item("environment-thumbnail");
    tooltip("The environment from azimuth -180° (left) over 0° (middle) to 180°.");
}

/// What the command would refuse is refused here in plain words. A large map takes seconds to read:
/// behind the window.
void take_environment(Studio& studio, int look, const EnvironmentReference& chosen) {
    const auto take = [&studio, look, chosen](const std::optional<std::string>& problem) {
        if (!problem) return commit(studio, SetEnvironment{look, chosen});
        tell_error(studio,
                   "The environment was not taken.",
                   *problem,
                   "Choose an .hdr or .exr map, twice as wide as high.");
    };
    if (!studio.background) return take(environment_problem(chosen));
    studio.background->run(
        [take, chosen](const Progress&) -> Background::Then {
            return [take, problem = environment_problem(chosen)] { take(problem); };
        },
        [take](const std::exception_ptr&) { take("The map could not be read."); });
}

void ask_for_file(Studio& studio, const EnvironmentReference& environment) {
    if (!studio.file_dialog) return;
    FileQuestion question;
    question.kind = FileQuestion::Kind::open;
    question.title = "Open an environment map";
    question.action = "Open";
    question.suffixes = {".hdr", ".exr"};
    question.then =
        [&studio, look = studio.shown_look, environment](const std::filesystem::path& file) {
            EnvironmentReference chosen = environment;
            chosen.file = std::filesystem::absolute(file).string();
            take_environment(studio, look, chosen);
        };
    studio.file_dialog->ask(std::move(question));
}

void draw_choice(Studio& studio, const EnvironmentReference& environment) {
    LightingPanelState& state = studio.panels.of<LightingPanelState>();
    row_label("Environment");
    if (ImGui::BeginCombo("##environment", shown_name(environment.file).c_str())) {
        if (!std::exchange(state.listed, true)) {
            try {
                state.shipped_environments = shipped_environments();
            } catch (const FileError& error) {
                state.thumbnail_problem = error.what();
            }
        }
        const auto offer = [&](const std::string& file) {
            EnvironmentReference other = environment;
            other.file = file;
            const bool on = file == environment.file;
            const bool picked = ImGui::Selectable(shown_name(file).c_str(), on);
            name_last_item("environment:" + shown_name(file));
            if (on) return;
            if (ImGui::IsItemHovered()) try_out(studio, SetEnvironment{studio.shown_look, other});
            if (picked) commit(studio, SetEnvironment{studio.shown_look, other});
        };
        offer("");
        for (const std::string& file : state.shipped_environments) offer(file);
        const bool is_file = !environment.file.empty() &&
                             std::find(state.shipped_environments.begin(),
                                       state.shipped_environments.end(),
                                       environment.file) == state.shipped_environments.end();
        if (is_file) offer(environment.file);
        if (ImGui::Selectable("File…")) ask_for_file(studio, environment);
        name_last_item("environment:file");
        ImGui::EndCombo();
    } else {
        state.listed = false;
    }
    name_last_item("environment");
    tooltip(environment.file.empty() ? "No light from all around, only the lights above."
                                     : environment.file);
}

}  // namespace

void draw_environment_choice(Studio& studio,
                             EnvironmentReference& environment,
                             const std::function<void()>& after_item) {
    draw_choice(studio, environment);
    LightingPanelState& state = studio.panels.of<LightingPanelState>();
    // It may have gone bad since it was chosen, and come back since.
    if (const auto problem = environment_problem(environment)) {
        state.thumbnail_of.clear();
        state.thumbnail = {};
        state.thumbnail_problem = *problem;
    } else {
        ask_for_thumbnail(studio, environment.file);
    }
    if (environment.file.empty()) return;
    draw_thumbnail(state, environment.rotation_rad);

    row_label("Rotation");
    double rotation_deg = kDegreesPerRadian * environment.rotation_rad;
    number_slider("##rotation", rotation_deg, -180.0, 180.0, "%.0f°");
    if (last_item_is_held()) environment.rotation_rad = rotation_deg / kDegreesPerRadian;
    name_last_item("environment-rotation");
    tooltip("Turns the map about the vertical, counter-clockwise seen from above.");
    after_item();

    row_label("Strength");
    double ev = ev_of(environment.scale);
    number_slider("##strength", ev, kOffEv, 8.0, ev <= kOffEv ? "off" : "%+.2f EV");
    if (last_item_is_held()) environment.scale = strength_of(ev);
    name_last_item("environment-strength");
    tooltip(
        fmt::format("0 EV is the map as its file has it; now times {:.3g}.", environment.scale));
    after_item();
}

}  // namespace livery
