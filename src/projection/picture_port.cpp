#include "projection/picture_port.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <span>
#include <thread>
#include <utility>

#include "gl/handles.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kBetweenLooks = std::chrono::milliseconds(2);
constexpr auto kUnusuallyLong = std::chrono::milliseconds(1500);
constexpr auto kTwoRefreshes = std::chrono::milliseconds(34);

}  // namespace

std::uint64_t next_picture_number() {
    static std::atomic<std::uint64_t> number{std::uint64_t{1} << 48u};
    return ++number;
}

std::shared_ptr<const ProjectorPicture> projector_picture(const Image8& rgb, std::uint64_t number) {
    Image8 rgba(rgb.width, rgb.height, 4, 255);
    for (std::size_t i = 0; i < rgb.pixel_count(); ++i)
        std::copy_n(&rgb.values[3 * i], 3, &rgba.values[4 * i]);
    const auto texture = std::make_shared<Texture2D>(rgb.width, rgb.height, TexelFormat::rgba8);
    texture->upload(std::span<const std::uint8_t>(rgba.values));
    auto picture = std::make_shared<ProjectorPicture>();
    picture->number = number;
    picture->texture = texture->name();
    picture->size_px = {rgb.width, rgb.height};
    picture->ready = std::make_shared<const Fence>(Fence::after_everything_so_far());
    picture->owner = texture;
    return picture;
}

ShowPicture show_on(ProjectorAccess projector, const Progress& progress, TellWait on_wait) {
    return [projector = std::move(projector), progress, on_wait = std::move(on_wait)](
               const Image8& drive) {
        const auto picture = projector_picture(drive, next_picture_number());
        projector.present(picture);
        const auto start = Clock::now();
        bool told = false;
        while (projector.shown().number != picture->number) {
            progress.check_stop();
            if (!told && Clock::now() - start > kUnusuallyLong) {
                told = true;
                on_wait({"the projector does not show the picture",
                         "check its cable and that it is chosen, not black and not frozen"});
            }
            std::this_thread::sleep_for(kBetweenLooks);
        }
        if (told) on_wait({});
        std::this_thread::sleep_for(kTwoRefreshes);
    };
}

}  // namespace livery
