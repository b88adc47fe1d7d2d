#include "ledger/accuracy/scenes.h"

#include <functional>
#include <memory>

#include "core/random.h"
#include "mesh/mesh_sides.h"
#include "scene/library.h"
#include "twin/description.h"

namespace livery {

namespace {

constexpr int kWidth_px = 640, kHeight_px = 400;
/// Pictures' sides, and those of the squares over which they are compared.
constexpr int kTranslucentSmaller = 4, kTranslucentMean_px = 4;
constexpr std::uint64_t kOpenCarSeed = 1;

struct NamedLook {
    const char* name;
    Look look;
    std::function<void(Scene&)> change{};
};

Look with_body(const char* paint) {
    Look look = find_look("solid-red");
    look.parts["body"] = paint;
    return look;
}

Material& body_of(Scene& scene) {
    return scene.part_materials.at(static_cast<std::size_t>(part_index(*scene.product, "body")));
}

std::vector<NamedLook> looks() {
    std::vector<NamedLook> all;
    all.push_back({"solid red", find_look("solid-red")});
    all.push_back({"silver with glints", with_body("grey silver metallic"), [](Scene& scene) {
                       body_of(scene).glint_density_per_mm2 = 1000.0;
                       body_of(scene).glint_scale = 30.0;
                   }});
    all.push_back({"pearl with a film", with_body("blue-green pearl")});
    // Bright and matt, so that parts light one another; with stripes and a woven relief
    NamedLook satin{"satin white", with_body("satin white")};
    Artwork stripes;
    stripes.name = "stripes";
    stripes.part = "body";
    stripes.paint = "satin raspberry";
    stripes.size_mm = 30.0;
    stripes.place.direction = {0.0, -1.0, 0.0};
    stripes.place.up = {0.0, 0.0, 1.0};
    Artwork weave;
    weave.name = "weave";
    weave.part = "trim";
    weave.shape = ArtworkShape::picture;
    weave.picture = "assets/patterns/weave.png";
    weave.use = PictureUse::relief;
    weave.repeat = true;
    weave.size_mm = 6.0;
    satin.look.artwork = {stripes, weave};
    all.push_back(std::move(satin));
    return all;
}

struct NamedLight {
    const char* name;
    std::function<void(Look&)> put_in;
};
/// The studio as shipped; and a grey sky with a low sun.
std::vector<NamedLight> lights() {
    return {{"studio", [](Look&) {}}, {"overcast", [](Look& look) {
                                           look.environment.file =
                                               "assets/environments/overcast.hdr";
                                           DirectionalLight sun;
                                           sun.direction = unit_direction({0.8, 0.5, 0.35});
                                           sun.angle_rad = 0.0093;
                                           look.lights = {sun};
                                       }}};
}
/// Where mirrors show parts and nothing else.
NamedLight lamps_alone() {
    return {"lamps alone", [](Look& look) { look.environment.file.clear(); }};
}

/// Marble at its own size, where light goes through what is as large as a hand: a ball, and the
/// shell of the player. Walks in it are hundreds of scatterings long, so that pictures are smaller;
/// and each is nearly of one channel, which leaves pixels noisy. Squares of which one is as wide as
/// blue light spreads show what spreads as well.
void add_translucent(std::vector<AccuracyScene>& scenes, const Progress& progress) {
    for (const std::string name : {"sphere", "player"}) {
        const auto product = find_product(name);
        const BenchDescription bench = read_bench_file(*bench_of_shipped_product(name));
        for (const auto& [light_name, light] : lights()) {
            progress.check_stop();
            Look look = find_look_for("solid-red", product->mesh);
            const std::string part = name == "player" ? "shell" : look.parts.begin()->first;
            // Which mirror nothing that a coarse picture could not show
            for (auto& other : look.parts) other.second = "tyre rubber";
            look.parts[part] = "marble";
            light(look);
            AccuracyScene& scene = scenes.emplace_back();
            scene.name = name + ", marble, " + light_name;
            scene.view = resized(bench.projector.view,
                                 kWidth_px / kTranslucentSmaller,
                                 kHeight_px / kTranslucentSmaller);
            scene.scene = make_scene(product, look, bench.eye_mm, nullptr);
            scene.mean_px = kTranslucentMean_px;
            scene.only = Effect::subsurface;
        }
    }
}

/// The car without its windows, as meshes from elsewhere come: every triangle twice, half of them
/// wound the wrong way. Its shells show both of their sides.
std::shared_ptr<const Product> open_car() {
    auto product = std::make_shared<Product>(*find_product("car"));
    Mesh& mesh = product->mesh;
    const auto glass = static_cast<std::size_t>(part_index(*product, "glass"));
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint16_t> parts;
    Random random(kOpenCarSeed);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.triangle_part[t] == glass) continue;
        const glm::uvec3& front = mesh.triangles[t];
        const glm::uvec3 back(front.x, front.z, front.y);
        const bool turned = random.below(2) == 0;
        triangles.push_back(turned ? back : front);
        triangles.push_back(turned ? front : back);
        parts.insert(parts.end(), 2, mesh.triangle_part[t]);
    }
    mesh.triangles = std::move(triangles);
    mesh.triangle_part = std::move(parts);
    settle_sides(mesh, std::vector<bool>(mesh.positions_mm.size(), true), product->notes);
    product->exchange = part_exchange(mesh);
    return product;
}

void add_open(std::vector<AccuracyScene>& scenes, const Progress& progress) {
    const auto product = open_car();
    const BenchDescription bench = read_bench_file(*bench_of_shipped_product("car"));
    for (const auto& [light_name, light] : lights()) {
        progress.check_stop();
        Look look = find_look("solid-red");
        look.parts.erase("glass");
        light(look);
        AccuracyScene& scene = scenes.emplace_back();
        scene.name = std::string("car without windows, solid red, ") + light_name;
        scene.view = resized(bench.projector.view, kWidth_px, kHeight_px);
        scene.scene = make_scene(product, look, bench.eye_mm, nullptr);
    }
}

}  // namespace

AccuracyScene resized(const AccuracyScene& scene, int width, int height) {
    return {scene.name, scene.scene, resized(scene.view, width, height), scene.mean_px, scene.only};
}

std::vector<AccuracyScene> accuracy_scenes(bool quick, const Progress& progress) {
    std::vector<AccuracyScene> scenes;
    for (const char* name : {"car", "sphere"}) {
        const std::string product_name = name;
        const auto product = find_product(product_name);
        const BenchDescription bench = read_bench_file(*bench_of_shipped_product(product_name));
        const View view = resized(bench.projector.view, kWidth_px, kHeight_px);
        std::vector<NamedLight> all_lights = lights();
        if (product_name == "car") all_lights.push_back(lamps_alone());
        for (const auto& [light_name, light] : all_lights) {
            std::shared_ptr<const Environment> environment;
            for (const NamedLook& one : looks()) {
                progress.check_stop();
                Look look =
                    product_name == "car" ? one.look : find_look_for("solid-red", product->mesh);
                if (product_name != "car") look.parts.begin()->second = one.look.parts.at("body");
                light(look);
                AccuracyScene& scene = scenes.emplace_back();
                scene.name = product_name + ", " + one.name + ", " + light_name;
                scene.view = view;
                scene.scene = make_scene(product, look, bench.eye_mm, environment);
                environment = scene.scene.environment;
                if (product_name == "car" && one.change) one.change(scene.scene);
                if (quick) return scenes;
            }
        }
    }
    add_translucent(scenes, progress);
    add_open(scenes, progress);
    return scenes;
}

}  // namespace livery
