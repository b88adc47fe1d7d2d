// Pictures that the path tracer lights a product with: what files hold, and what is seen of them.
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/image_io.h"
#include "jobs/render/render.h"
#include "support/small_meshes.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

const View& projector() {
    static const View view = look_at({0, 1000, 0.001}, {0, 0, 0}, 0.1, 64, 48);
    return view;
}

void expect_refused(const std::filesystem::path& file, const Mesh& mesh, const std::string& part) {
    try {
        read_projected_picture(file, projector(), mesh);
        ADD_FAILURE() << "nothing was thrown";
    } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(ProjectedPicture, FloatsAreLightAndIntegersAreSrgb) {
    const TemporaryFolder folder;
    write_exr(folder / "half.exr", ImageF(64, 48, 3, 0.5f));
    Image8 png(64, 48, 3);
    for (auto& value : png.values) value = 188;  // half of the light
    write_png(folder / "half.png", png);
    for (const char* name : {"half.exr", "half.png"}) {
        // The floor's middle is 1 m away: there 1 makes white
        const auto light = read_projected_picture(folder / name, projector(), floor_mesh(50.0f));
        const auto at = light->at({0.0, 0.0, 0.0});
        EXPECT_NEAR(at.irradiance.y, 0.5 * 3.14159265, 0.01) << name;
        EXPECT_NEAR(at.distance_mm, 1000.0f, 0.01f);
    }
}

TEST(ProjectedPicture, SaysWhatIsWrongWithAFile) {
    const TemporaryFolder folder;
    const Mesh mesh = floor_mesh(50.0f);
    write_exr(folder / "small.exr", ImageF(32, 24, 3, 0.5f));
    expect_refused(folder / "small.exr", mesh, "64x48");
    ImageF bad(64, 48, 3, 0.5f);
    bad.at(3, 7, 1) = -0.5f;
    write_exr(folder / "negative.exr", bad);
    expect_refused(folder / "negative.exr", mesh, "(3, 7)");
    bad.at(3, 7, 1) = std::numeric_limits<float>::quiet_NaN();
    write_exr(folder / "nan.exr", bad);
    expect_refused(folder / "nan.exr", mesh, "(3, 7)");
    expect_refused(folder / "none.exr", mesh, "none.exr");
    Mesh behind = mesh;
    for (glm::vec3& p : behind.positions_mm) p.y += 3000.0f;
    write_exr(folder / "good.exr", ImageF(64, 48, 3, 0.5f));
    expect_refused(folder / "good.exr", behind, "behind");
}

TEST(ProjectedPicture, IsSeenWholeFromTheEye) {
    const Mesh mesh = make_sphere({100, 50, -30}, 40.0, 32, "ball");
    for (const auto& [width, height] : {std::pair(80, 60), std::pair(60, 80)}) {
        const View view = view_of_all(mesh, {0, 300, 400}, width, height);
        double widest = 0.0;
        for (const glm::vec3& p : mesh.positions_mm) {
            const auto pixel = project(view, glm::dvec3(p));
            ASSERT_TRUE(pixel && pixel->x > 0 && pixel->x < width && pixel->y > 0 &&
                        pixel->y < height);
            widest = std::max(widest, std::abs(pixel->y / height - 0.5));
        }
        EXPECT_GT(widest, 0.2);
    }
    // As a job does it: a white ball under an even picture is as bright as it says
    const TemporaryFolder folder;
    write_exr(folder / "half.exr", ImageF(64, 48, 3, 0.5f));
    RenderRequest request;
    auto product = std::make_shared<Product>();
    product->mesh = floor_mesh(20.0f);
    request.scene.part_materials.resize(1);
    request.scene.part_materials[0].diffuse = glm::dvec3(0.8);
    request.scene.eye_in_world_mm = {0, 300, 400};
    request.view = view_of_all(product->mesh, request.scene.eye_in_world_mm, 40, 30);
    request.projected = read_projected_picture(folder / "half.exr", projector(), product->mesh);
    request.scene.product = product;
    request.backend = RenderBackend::reference;
    request.samples_per_pixel = 4;
    const RenderedFrame frame = render_frame(request);
    EXPECT_NEAR(frame.radiance_working.at(20, 15, 1), 0.4f, 5e-3f);
}

}  // namespace
}  // namespace livery
