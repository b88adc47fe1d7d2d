#include "studio/window/glfw_window.h"

#include <algorithm>

#include <GLFW/glfw3.h>
#include <glm/common.hpp>

#include "core/image_io.h"
#include "core/log.h"
#include "core/paths.h"
#include "studio/window/layout.h"

namespace livery {

namespace {

glm::ivec2 least_size(const Studio& studio,
                      const std::vector<Monitor>& monitors,
                      const glm::ivec2& position) {
    double scale = 1.0;
    for (const Monitor& m : monitors) {
        if (position.x >= m.x && position.y >= m.y && position.x < m.x + m.width &&
            position.y < m.y + m.height) {
            scale = default_scale(1.0f, {m.width, m.height});
        }
    }
    scale = studio.fixed_scale.value_or(scale * studio.user_scale);
    return glm::ivec2(glm::dvec2(kLeastSize_px) * scale);
}

}  // namespace

std::vector<std::array<int, 4>> places_of_monitors() {
    std::vector<std::array<int, 4>> places;
    int count = 0;
    GLFWmonitor** const monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
        auto& place = places.emplace_back();
        glfwGetMonitorPos(monitors[i], &place[0], &place[1]);
        if (const GLFWvidmode* mode = glfwGetVideoMode(monitors[i])) {
            place[2] = mode->width;
            place[3] = mode->height;
        }
    }
    return places;
}

float screen_scale(GLFWwindow* window, const std::vector<Monitor>& monitors) {
    float content_scale = 1.0f;
    glfwGetWindowContentScale(window, &content_scale, nullptr);
    int x = 0, y = 0;
    glfwGetWindowPos(window, &x, &y);
    glm::ivec2 size{0};
    for (const Monitor& m : monitors) {
        if (x >= m.x && y >= m.y && x < m.x + m.width && y < m.y + m.height)
            size = {m.width, m.height};
    }
    return static_cast<float>(default_scale(content_scale, size));
}

WindowPlace place_of(GLFWwindow* window) {
    WindowPlace place;
    glfwGetWindowPos(window, &place.position.x, &place.position.y);
    glfwGetWindowSize(window, &place.size_px.x, &place.size_px.y);
    place.maximised = glfwGetWindowAttrib(window, GLFW_MAXIMIZED) != 0;
    return place;
}

WindowPlace first_place(const Studio& studio, std::optional<glm::ivec2> size_px) {
    const auto& monitors = studio.monitors;
    const auto remembered = studio.session.workspace().find(kWindowKey);
    std::optional<WindowPlace> place;
    if (remembered != studio.session.workspace().end()) {
        place = parse_window_place(remembered->second);
    }
    if (!place) {
        place = WindowPlace{};
        const auto main = std::find_if(
            monitors.begin(), monitors.end(), [](const Monitor& m) { return m.primary; });
        if (main != monitors.end()) {
            const double scale = default_scale(1.0f, {main->width, main->height});
            place->size_px = {std::min(main->width, static_cast<int>(1280 * scale)),
                              std::min(main->height, static_cast<int>(800 * scale))};
            place->position = {main->x + (main->width - place->size_px.x) / 2,
                               main->y + (main->height - place->size_px.y) / 2};
        }
    }
    // It may have been left on a screen with larger pixels.
    place->size_px = glm::max(place->size_px, least_size(studio, monitors, place->position));
    if (size_px) {
        place->size_px = *size_px;
        place->maximised = false;
    }
    return place_beside_projector(*place, monitors, studio.projector_monitor).value_or(*place);
}

void put_window(GLFWwindow* window, const WindowPlace& place) {
    glfwSetWindowSize(window, place.size_px.x, place.size_px.y);
    glfwSetWindowPos(window, place.position.x, place.position.y);
    if (place.maximised) glfwMaximizeWindow(window);
}

void move_off_projector(Studio& studio, GLFWwindow* window) {
    studio.window_must_move = false;
    const WindowPlace now = place_of(window);
    if (!must_move(now, studio.monitors, studio.projector_monitor)) return;
    const auto place = place_beside_projector(now, studio.monitors, studio.projector_monitor);
    if (!place || *place == now) return;
    if (now.maximised) glfwRestoreWindow(window);
    put_window(window, *place);
}

void give_icon(Studio& studio, GLFWwindow* window) {
    const auto read = [window](const Progress&) -> Background::Then {
        std::vector<Image8> pictures;
        for (const char* name : {"assets/icon/livery-48.png", "assets/icon/livery-128.png"}) {
            const ImageF image = read_image(shipped_path(name)).image;
            Image8& picture = pictures.emplace_back(image.width, image.height, 4, 255);
            for (std::size_t i = 0; i < image.pixel_count(); ++i) {
                for (std::size_t c = 0; c < static_cast<std::size_t>(image.channels); ++c) {
                    picture.values[4 * i + c] = static_cast<std::uint8_t>(
                        image.values[static_cast<std::size_t>(image.channels) * i + c]);
                }
            }
        }
        return [window, pictures]() mutable {
            std::vector<GLFWimage> icons;
            for (Image8& picture : pictures) {
                icons.push_back({picture.width, picture.height, picture.values.data()});
            }
            glfwSetWindowIcon(window, static_cast<int>(icons.size()), icons.data());
        };
    };
    studio.background->run(read, [](std::exception_ptr error) {
        log_line(LogLevel::warning, "no window icon: " + in_words(error));
    });
}

}  // namespace livery
