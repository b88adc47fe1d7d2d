#include "session/preview_thread.h"

#include <chrono>
#include <condition_variable>
#include <mutex>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "gl/read_back.h"
#include "radiance/raster_preview.h"
#include "session/library.h"
#include "session/orbit.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

/// What a thread finished, for the test's thread to wait for.
class Finished {
  public:
    void add(std::shared_ptr<const PreviewPicture> picture) {
        {
            const std::scoped_lock lock(mutex_);
            pictures_.push_back(std::move(picture));
        }
        wake_.notify_all();
    }
    /// The first picture that `fits`, from those that come or came; null after half a minute.
    template <typename Fits>
    std::shared_ptr<const PreviewPicture> wait_for(const Fits& fits) {
        std::unique_lock lock(mutex_);
        std::shared_ptr<const PreviewPicture> found;
        wake_.wait_for(lock, 30s, [&] {
            for (const auto& picture : pictures_) {
                if (!found && fits(*picture)) found = picture;
            }
            return found != nullptr;
        });
        return found;
    }
    std::size_t count() {
        const std::scoped_lock lock(mutex_);
        return pictures_.size();
    }
    auto callback() {
        return [this](std::shared_ptr<const PreviewPicture> picture) { add(std::move(picture)); };
    }

  private:
    std::mutex mutex_;
    std::condition_variable wake_;
    std::vector<std::shared_ptr<const PreviewPicture>> pictures_;
};

/// Two contexts of a share group: the test's stays current, the thread's is free.
struct Contexts {
    HeadlessContext ours{GlDevice::software};
    HeadlessContext theirs{GlDevice::software, &ours};
    Contexts() {
        theirs.release();
        ours.make_current();
    }
};

std::shared_ptr<const Product> sphere() {
    static const std::shared_ptr<const Product> product = find_product("sphere");
    return product;
}

Scene red_sphere() {
    Scene scene;
    scene.product = sphere();
    scene.part_materials.assign(sphere()->mesh.parts.size(), find_material("solid red"));
    scene.lights = {
        DirectionalLight{glm::normalize(glm::dvec3(-0.45, 0.75, 0.55)), {1, 1, 1}, 0.05}};
    scene.eye_in_world_mm = {0, 100, 600};
    return scene;
}

PreviewDescription description_of(std::uint64_t number, int width = 160, int height = 120) {
    PreviewDescription description;
    description.number = number;
    description.scene = red_sphere();
    description.view =
        view_of(default_orbit(bounds_of(sphere()->mesh), static_cast<double>(width) / height),
                width,
                height);
    description.ground = false;
    return description;
}

bool is_final(const PreviewPicture& picture, std::uint64_t number) {
    return picture.number == number && picture.supersampling == 2 && !picture.light_is_old;
}

/// Read in the calling thread's context, as a window would.
Image8 read(const PreviewPicture& picture) {
    picture.ready->wait_on_device();
    const ImageF values = read_floats(picture.texture, picture.size_px.x, picture.size_px.y, 4);
    Image8 bytes(values.width, values.height, 4);
    for (std::size_t i = 0; i < values.values.size(); ++i) {
        bytes.values[i] = static_cast<std::uint8_t>(std::lround(255.0f * values.values[i]));
    }
    return bytes;
}

TEST(PreviewThread, ShowsWhatRasterPreviewDraws) {
    Contexts contexts;
    Finished finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    const PreviewDescription description = description_of(7);
    thread.show(description);
    const auto picture = finished.wait_for([](const auto& p) { return is_final(p, 7); });
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->problem, "");
    EXPECT_EQ(picture->size_px, glm::ivec2(160, 120));
    const Image8 shown = read(*picture);

    RasterPreview preview(sphere());
    preview.render(description.scene, description.view);
    const ImageF radiance = preview.read_back();
    int covered = 0;
    for (std::size_t i = 0; i < radiance.pixel_count(); ++i) {
        const float* from = radiance.values.data() + 4 * i;
        const glm::dvec3 rgb = rec709_from_working() * glm::dvec3(from[0], from[1], from[2]);
        EXPECT_EQ(shown.values[4 * i + 3], std::lround(255.0f * from[3]));
        covered += from[3] > 0.0f;
        for (int c = 0; c < 3; ++c) {
            const double expected = 255.0 * srgb_encode(std::clamp(rgb[c], 0.0, 1.0));
            ASSERT_NEAR(shown.values[4 * i + static_cast<std::size_t>(c)], expected, 1.01);
        }
    }
    EXPECT_GT(covered, 3000);
}

}  // namespace
}  // namespace livery
