// Draws the documentation's pictures of the car and of the paints as the window shows them, and
// prints what the preview costs here: livery_preview_pictures FOLDER.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>

#include "appearance/material_library.h"
#include "core/image_io.h"
#include "gl/context.h"
#include "gl/draw.h"
#include "gl/read_back.h"
#include "live/orbit.h"
#include "live/preview_picture.h"
#include "scene/library.h"

namespace livery {
namespace {

/// Milliseconds that passed and that all threads computed; medians.
struct Cost {
    double passed = 0.0, computed = 0.0;
};
Cost cost_of(const std::function<void(int)>& work) {
    std::vector<double> passed, computed;
    for (int k = 0; k < 9; ++k) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t clock = std::clock();
        work(k);
        finish_gl();
        const auto stop = std::chrono::steady_clock::now();
        passed.push_back(std::chrono::duration<double, std::milli>(stop - start).count());
        computed.push_back(1e3 * static_cast<double>(std::clock() - clock) / CLOCKS_PER_SEC);
    }
    std::sort(passed.begin(), passed.end());
    std::sort(computed.begin(), computed.end());
    return {passed[passed.size() / 2], computed[computed.size() / 2]};
}
void print_cost(const char* what, const Cost& cost) {
    std::printf("  %-24s %6.0f ms, %6.0f ms of processor time\n", what, cost.passed, cost.computed);
}

/// `top` over grey, into a part of a sheet.
void place(Image8& sheet, const Image8& top, int left, int above) {
    for (int y = 0; y < top.height; ++y) {
        for (int x = 0; x < top.width; ++x) {
            const double alpha = top.at(x, y, 3) / 255.0;
            for (int c = 0; c < 3; ++c) {
                std::uint8_t& under = sheet.at(left + x, above + y, c);
                under = static_cast<std::uint8_t>(
                    std::lround(alpha * top.at(x, y, c) + (1.0 - alpha) * under));
            }
        }
    }
}

class ProductPainter {
  public:
    explicit ProductPainter(const std::string& name)
        : product_(find_product(name)),
          preview_(product_),
          ground_(ground_shadow(*product_, Tracer(product_->mesh))) {
        encoder_.set_ground(&ground_);
    }

    Scene scene(const std::string& look, const View& view) const {
        return make_scene(
            product_, find_look_for(look, part_names(product_->mesh)), centre_in_world(view));
    }
    View view(double azimuth_rad, int width, int height) const {
        Orbit orbit;
        orbit.azimuth_rad = azimuth_rad;
        orbit.elevation_rad = 0.24;
        orbit.vertical_fov_rad = 0.3;
        const double aspect = static_cast<double>(width) / height;
        const Bounds bounds = bounds_of(product_->mesh);
        return view_of(zoomed(fitted(orbit, bounds, aspect), 1.4, bounds), width, height);
    }
    Image8 picture(const std::string& look, double azimuth_rad, int width, int height) {
        const View seen_from = view(azimuth_rad, width, height);
        preview_.set_supersampling(4);
        preview_.render(scene(look, seen_from), seen_from);
        return encoded(seen_from, std::nullopt);
    }
    void print_costs() {
        const View from = view(0.6, 1280, 800);
        Scene seen = scene("blue-metallic", from);
        VertexLightSolver solver(product_);
        solver.solve(seen.lights, seen.environment);
        print_cost("one light solved", cost_of([&](int k) {
                       seen.lights.front().direction.x += 0.01 * (k + 1);
                       solver.solve(seen.lights, seen.environment);
                   }));
        print_cost("environment solved", cost_of([&](int k) {
                       auto other = *seen.environment;
                       other.radiance_working.values.front() += 0.01f * static_cast<float>(k + 1);
                       seen.environment = std::make_shared<const Environment>(std::move(other));
                       solver.solve(seen.lights, seen.environment);
                   }));
        preview_.take(solver.solve(seen.lights, seen.environment));
        const Texture2D texture(from.width, from.height, TexelFormat::rgba8);
        const Framebuffer into({&texture});
        for (const int supersampling : {1, 2}) {
            preview_.set_supersampling(supersampling);
            const auto draw = [&](const View& view, std::optional<int> part) {
                preview_.draw(seen, view);
                encoder_.encode(preview_, view, part, true, into);
            };
            draw(from, 0);
            std::printf("1280x800, %d x %d samples a pixel\n", supersampling, supersampling);
            print_cost("new view", cost_of([&](int k) {
                           draw(view(0.6 + 0.02 * (k + 1), from.width, from.height), {});
                       }));
            draw(from, {});
            print_cost("new paint", cost_of([&](int) { draw(from, {}); }));
            print_cost("new paint, outlined", cost_of([&](int) { draw(from, 0); }));
        }
    }

  private:
    Image8 encoded(const View& view, std::optional<int> part) {
        const Texture2D texture(view.width, view.height, TexelFormat::rgba8);
        const Framebuffer into({&texture});
        encoder_.encode(preview_, view, part, true, into);
        return read_bytes(texture, 4);
    }

    std::shared_ptr<const Product> product_;
    RasterPreview preview_;
    GroundShadow ground_;
    PreviewEncoder encoder_;
};

void draw_pictures(const std::filesystem::path& folder) {
    const HeadlessContext context(GlDevice::automatic);
    {
        ProductPainter car("car");
        constexpr int kWidth = 640, kHeight = 340;
        Image8 sheet(2 * kWidth, kHeight, 3, 110);
        place(sheet, car.picture("solid-red", 0.75, kWidth, kHeight), 0, 0);
        place(sheet, car.picture("blue-metallic", -0.85, kWidth, kHeight), kWidth, 0);
        write_png(folder / "car.png", sheet);
        std::printf("%s\n", context.renderer().c_str());
        car.print_costs();
    }
    {
        ProductPainter player("player");
        constexpr int kWidth = 320, kHeight = 420;
        Image8 sheet(3 * kWidth, kHeight, 3, 110);
        place(sheet, player.picture("solid-ivory", 0.75, kWidth, kHeight), 0, 0);
        place(sheet, player.picture("blue-metallic", 1.15, kWidth, kHeight), kWidth, 0);
        place(sheet, player.picture("solid-red", 0.45, kWidth, kHeight), 2 * kWidth, 0);
        write_png(folder / "player.png", sheet);
    }
    const std::vector<Material> paints = read_paint_library()->shipped;
    SwatchPainter painter(make_swatch_studio());
    constexpr int kSize = 144, kStep = 160, kColumns = 8;
    const int rows = (static_cast<int>(paints.size()) + kColumns - 1) / kColumns;
    Image8 sheet(kColumns * kStep, rows * kStep, 3, 58);
    for (int k = 0; k < static_cast<int>(paints.size()); ++k) {
        const Material& paint = paints[static_cast<std::size_t>(k)];
        place(
            sheet, painter.paint(paint, kSize), k % kColumns * kStep + 8, k / kColumns * kStep + 8);
        std::printf("%s%s", paint.name.c_str(), k % kColumns == kColumns - 1 ? "\n" : ", ");
    }
    write_png(folder / "paints.png", sheet);
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: livery_preview_pictures FOLDER\n");
        return 2;
    }
    try {
        livery::draw_pictures(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
