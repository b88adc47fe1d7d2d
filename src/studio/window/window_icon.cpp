#include "studio/window/window_icon.h"

#include <exception>
#include <string>
#include <vector>

#include <GLFW/glfw3.h>

#include "core/image_io.h"
#include "core/log.h"
#include "core/paths.h"
#include "studio/kit/background.h"
#include "studio/studio.h"

namespace livery {

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
        try {
            std::rethrow_exception(error);
        } catch (const std::exception& why) {
            log_line(LogLevel::warning, std::string("no window icon: ") + why.what());
        }
    });
}

}  // namespace livery
