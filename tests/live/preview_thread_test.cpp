#include "live/preview_thread.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/colour.h"
#include "gl/read_back.h"
#include "live/contexts.h"
#include "live/orbit.h"
#include "radiance/raster_preview.h"

namespace livery {
namespace {

using testing::SharedContexts;
using PicturePointer = std::shared_ptr<const PreviewPicture>;
using FinishedPictures = testing::Finished<PicturePointer>;

/// A big ball on the left and a small one on the right.
std::shared_ptr<const Product> two_balls() {
    static const std::shared_ptr<const Product> product = [] {
        Product made;
        made.name = "two balls";
        made.mesh = make_sphere({-30, 0, 0}, 40.0, 32, "left");
        append(made.mesh, make_sphere({45, -15, 0}, 25.0, 32, "right"), "");
        return std::make_shared<const Product>(std::move(made));
    }();
    return product;
}

Material grey(double albedo) {
    Material material;
    material.diffuse = glm::dvec3(albedo);
    return material;
}

DirectionalLight light_from(const glm::dvec3& direction) {
    DirectionalLight light;
    light.direction = glm::normalize(direction);
    light.angle_rad = 0.05;
    return light;
}

PreviewDescription description_of(std::uint64_t number, double albedo = 0.5) {
    PreviewDescription description;
    description.number = number;
    description.scene.product = two_balls();
    description.scene.part_materials = {grey(albedo), grey(albedo)};
    description.scene.lights = {light_from({-0.45, 0.75, 0.55})};
    description.scene.eye_in_world_mm = {0, 100, 600};
    const int width = 160, height = 120;
    Orbit orbit = default_orbit(bounds_of(two_balls()->mesh), 4.0 / 3.0);
    orbit.azimuth_rad = 0.0;
    description.view = view_of(orbit, width, height);
    description.ground = false;
    return description;
}

bool is_final(const PreviewPicture& picture, std::uint64_t number) {
    return picture.number == number && picture.supersampling == 2 && !picture.unfinished &&
           picture.problem.empty();
}

PicturePointer final_picture(FinishedPictures& finished, std::uint64_t number) {
    return finished.wait_for([&](const auto& picture) { return is_final(*picture, number); });
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
    SharedContexts contexts;
    FinishedPictures finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    const PreviewDescription description = description_of(7);
    thread.show(description);
    const auto picture = final_picture(finished, 7);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->problem, "");
    EXPECT_EQ(picture->size_px, glm::ivec2(160, 120));
    const Image8 shown = read(*picture);

    RasterPreview preview(two_balls());
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

TEST(PreviewThread, ShowsTheProductBeforeItsLightIsSolved) {
    SharedContexts contexts;
    FinishedPictures finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    PreviewDescription description = description_of(3);
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(64, 32, 3, 0.5f);
    description.scene.environment = environment;
    thread.show(description);
    const auto last = final_picture(finished, 3);
    ASSERT_TRUE(last);
    const PicturePointer first = finished.all().front();
    EXPECT_EQ(first->problem, "");
    EXPECT_TRUE(first->unfinished) << "nothing was traced yet";
    // The same balls, about as bright: only shadows and what is mirrored are missing.
    const Image8 guess = read(*first), solved = read(*last);
    const auto mean_of = [](const Image8& picture) {
        double sum = 0.0, covered = 0.0;
        for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
            if (picture.values[4 * i + 3] < 255) continue;
            sum += picture.values[4 * i + 1];
            ++covered;
        }
        return std::pair(sum / covered, covered);
    };
    const auto [guessed, guessed_pixels] = mean_of(guess);
    const auto [wanted, wanted_pixels] = mean_of(solved);
    EXPECT_NEAR(guessed_pixels / wanted_pixels, 1.0, 0.05);
    EXPECT_NEAR(guessed / wanted, 1.0, 0.15);
}

TEST(PreviewThread, DrawsTheNewestOfMany) {
    SharedContexts contexts;
    FinishedPictures finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    constexpr std::uint64_t kLast = 200;
    for (std::uint64_t number = 1; number <= kLast; ++number) {
        PreviewDescription description = description_of(number);
        Orbit orbit = default_orbit(bounds_of(two_balls()->mesh), 4.0 / 3.0);
        orbit.azimuth_rad = 0.01 * static_cast<double>(number);
        description.view = view_of(orbit, 160, 120);
        thread.show(description);
    }
    ASSERT_TRUE(final_picture(finished, kLast));
    std::uint64_t before = 0;
    for (const auto& picture : finished.all()) {
        EXPECT_EQ(picture->problem, "");
        EXPECT_GE(picture->number, before);
        before = picture->number;
    }
    EXPECT_LT(finished.all().size(), kLast);
}

TEST(PreviewThread, WipesBetweenTwoLooks) {
    SharedContexts contexts;
    FinishedPictures finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    const auto picture_of = [&](const PreviewDescription& description) {
        thread.show(description);
        const auto picture = final_picture(finished, description.number);
        return picture ? read(*picture) : Image8();
    };
    const Image8 light = picture_of(description_of(1, 0.8));
    const Image8 dark = picture_of(description_of(2, 0.2));
    PreviewDescription wiped = description_of(3, 0.8);
    wiped.wipe_to = description_of(3, 0.2).scene;
    wiped.wipe_at = 0.25;
    const Image8 both = picture_of(wiped);
    ASSERT_EQ(both.values.size(), light.values.size());
    EXPECT_NE(light.values, dark.values);
    const int column = 40;  // a quarter of 160
    for (int y = 0; y < both.height; ++y) {
        for (int x = 0; x < both.width; ++x) {
            const Image8& expected = x < column ? light : dark;
            for (int c = 0; c < 4; ++c) ASSERT_EQ(both.at(x, y, c), expected.at(x, y, c)) << x;
        }
    }
}

TEST(PreviewThread, OutlinesOnePartAndNothingElse) {
    SharedContexts contexts;
    FinishedPictures finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    std::uint64_t number = 0;
    for (const double albedo : {0.0, 0.02, 0.5, 0.9, 1.0}) {
        PreviewDescription description = description_of(++number, albedo);
        // The last one is white all over
        if (albedo == 1.0) description.scene.exposure_ev = 8.0;
        thread.show(description);
        const auto plain = final_picture(finished, number);
        description.number = ++number;
        description.highlighted_part = 1;
        thread.show(description);
        const auto outlined = final_picture(finished, number);
        ASSERT_TRUE(plain && outlined);
        const Image8 a = read(*plain), b = read(*outlined);

        const PartPicker picker(two_balls());
        int changed = 0;
        for (int y = 0; y < a.height; ++y) {
            for (int x = 0; x < a.width; ++x) {
                int difference = 0;
                for (int c = 0; c < 4; ++c) {
                    difference = std::max(difference, std::abs(a.at(x, y, c) - b.at(x, y, c)));
                }
                EXPECT_EQ(a.at(x, y, 3), b.at(x, y, 3));
                changed += difference > 60;
                if (difference == 0) continue;
                bool touches_part = false;
                for (const double u : {0.25, 0.75}) {
                    for (const double v : {0.25, 0.75}) {
                        touches_part |= picker.part_at(description.view, {x + u, y + v}) == 1;
                    }
                }
                EXPECT_TRUE(touches_part) << x << ", " << y;
            }
        }
        // An outline of two pixels around some thirty
        EXPECT_GT(changed, 100) << "on a paint of albedo " << albedo;
    }
}

TEST(PreviewThread, DrawsInTheOldLightUntilTheNewOneIsSolved) {
    SharedContexts contexts;
    FinishedPictures finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    PreviewDescription description = description_of(1);
    thread.show(description);
    ASSERT_TRUE(final_picture(finished, 1));

    description.number = 2;
    description.scene.lights = {light_from({0.9, 0.2, 0.3})};
    thread.show(description);
    const auto solved = final_picture(finished, 2);
    ASSERT_TRUE(solved);
    const auto first = finished.wait_for([](const auto& p) { return p->number == 2; });
    EXPECT_TRUE(first->unfinished);
    EXPECT_NE(read(*first).values, read(*solved).values);

    // Another brightness needs no solving
    description.number = 3;
    description.scene.lights.front().radiance_rec709 = glm::dvec3(0.5);
    thread.show(description);
    const auto darker = finished.wait_for([](const auto& p) { return p->number == 3; });
    ASSERT_TRUE(darker);
    EXPECT_FALSE(darker->unfinished);
    EXPECT_NE(read(*darker).values, read(*solved).values);
}

TEST(PreviewThread, LeavesAlonePicturesThatSomebodyHolds) {
    SharedContexts contexts;
    FinishedPictures finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    thread.show(description_of(1, 0.1));
    const auto held = final_picture(finished, 1);
    ASSERT_TRUE(held);
    const Image8 then = read(*held);
    for (std::uint64_t number = 2; number < 12; ++number) {
        thread.show(description_of(number, 0.9));
        ASSERT_TRUE(final_picture(finished, number));
    }
    EXPECT_EQ(read(*held).values, then.values);
}

TEST(PreviewThread, UsesTexturesAgainThatCameBack) {
    SharedContexts contexts;
    std::mutex mutex;
    std::vector<unsigned> textures;
    testing::Finished<std::uint64_t> numbers;
    PreviewThread thread(contexts.theirs, [&](const PicturePointer& picture) {
        {
            const std::scoped_lock lock(mutex);
            textures.push_back(picture->texture);
        }
        if (picture->supersampling == 2) numbers.add(picture->number);
    });
    for (std::uint64_t number = 1; number <= 20; ++number) {
        thread.show(description_of(number));
        numbers.wait_for([&](std::uint64_t n) { return n == number; });
    }
    const std::scoped_lock lock(mutex);
    std::sort(textures.begin(), textures.end());
    EXPECT_GE(textures.size(), 20u);
    EXPECT_LE(std::unique(textures.begin(), textures.end()) - textures.begin(), 5);
}

TEST(PreviewThread, DarkensTheGroundUnderTheProduct) {
    SharedContexts contexts;
    FinishedPictures finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    PreviewDescription description = description_of(1);
    thread.show(description);
    const Image8 without = read(*final_picture(finished, 1));
    description.ground = true;
    description.number = 2;
    thread.show(description);
    const auto grounded = final_picture(finished, 2);
    ASSERT_TRUE(grounded);
    const Image8 with = read(*grounded);
    int darkened = 0;
    for (std::size_t i = 0; i < with.pixel_count(); ++i) {
        EXPECT_GE(with.values[4 * i + 3], without.values[4 * i + 3]);
        if (without.values[4 * i + 3] == 255) {
            for (std::size_t c = 0; c < 4; ++c) {
                EXPECT_EQ(with.values[4 * i + c], without.values[4 * i + c]);
            }
        } else if (without.values[4 * i + 3] == 0 && with.values[4 * i + 3] > 0) {
            EXPECT_EQ(with.values[4 * i], 0);
            ++darkened;
        }
    }
    EXPECT_GT(darkened, 300);
    EXPECT_EQ(with.at(0, 0, 3), 0);
}

TEST(PreviewThread, SaysWhatItCannotDrawAndKeepsTheLastPicture) {
    SharedContexts contexts;
    FinishedPictures finished;
    PreviewThread thread(contexts.theirs, finished.callback());
    const auto problem_of = [&](const PreviewDescription& description) {
        thread.show(description);
        const auto picture = finished.wait_for(
            [&](const auto& p) { return p->number == description.number && !p->problem.empty(); });
        return picture ? picture->problem : "no answer";
    };
    PreviewDescription none = description_of(1);
    none.scene.product = nullptr;
    EXPECT_EQ(problem_of(none), "a preview of no product");

    thread.show(description_of(2));
    ASSERT_TRUE(final_picture(finished, 2));
    PreviewDescription bad = description_of(3);
    bad.view.width = 0;
    EXPECT_EQ(problem_of(bad), "a preview of 0 x 120 pixels");
    bad = description_of(4);
    bad.view.height = 100000;
    EXPECT_EQ(problem_of(bad), "a preview of 160 x 100000 pixels");
    bad = description_of(5);
    bad.highlighted_part = 2;
    EXPECT_EQ(problem_of(bad), "part 2 of 2, counted from 0");
    bad = description_of(6);
    bad.scene.part_materials.pop_back();
    EXPECT_EQ(problem_of(bad), "1 materials for 2 parts");
    // The ground's shadow may have come after the picture that was waited for.
    const auto all = finished.all();
    const auto last_good =
        std::find_if(all.rbegin(), all.rend(), [](const auto& p) { return p->problem.empty(); });
    ASSERT_NE(last_good, all.rend());
    EXPECT_EQ((*last_good)->number, 2u);
    EXPECT_EQ(all.back()->texture, (*last_good)->texture);

    thread.show(description_of(7));
    const auto again = final_picture(finished, 7);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->problem, "");
}

TEST(PreviewThread, EndsAtAnyMoment) {
    SharedContexts contexts;
    for (int k = 0; k < 12; ++k) {
        FinishedPictures finished;
        std::vector<PicturePointer> kept;
        {
            PreviewThread thread(contexts.theirs, finished.callback());
            thread.show(description_of(1));
            if (k % 3 == 1) thread.request_swatch(grey(0.3), 32, [](const Image8&) {});
            std::this_thread::sleep_for(std::chrono::milliseconds(4 * k));
            PreviewDescription description = description_of(2);
            description.scene.lights = {light_from({1, 1, k})};
            thread.show(description);
            std::this_thread::sleep_for(std::chrono::milliseconds(3 * k));
            kept = finished.all();
        }
        for (const auto& picture : kept) EXPECT_EQ(picture->problem, "");
    }
}

}  // namespace
}  // namespace livery
