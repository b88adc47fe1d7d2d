// Writes every generated asset below a folder: livery_generate_assets FOLDER
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "car.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "environments.h"
#include "glb.h"
#include "patterns.h"
#include "player.h"
#include "solids.h"

int main(int argument_count, char** arguments) {
    using namespace livery;
    if (argument_count != 2) {
        std::cerr << "usage: livery_generate_assets FOLDER\n";
        return 2;
    }
    try {
        const std::filesystem::path folder = arguments[1];
        make_output_folder(folder / "environments");
        make_output_folder(folder / "patterns");
        const auto write_product = [&](const std::string& name,
                                       const std::vector<assets::PartMesh>& parts) {
            write_text_file(folder / (name + ".glb"), assets::glb_bytes(name, parts));
            std::size_t triangles = 0;
            for (const auto& part : parts) triangles += part.triangles.size();
            std::cout << name << ".glb: " << triangles << " triangles\n";
        };
        write_product("car", assets::make_car());
        write_product("player", assets::make_player());

        constexpr int kSphereRings = 96;
        auto sphere = assets::sphere(25.0, kSphereRings);
        sphere.name = "sphere";
        assets::compute_tangents(sphere);
        write_product("sphere", {sphere});

        constexpr int kEnvironmentWidth = 1024;
        const auto write_environment = [&](const std::string& name, auto* radiance) {
            const auto map = assets::environment_map(radiance, kEnvironmentWidth);
            write_text_file(folder / "environments" / name, assets::hdr_bytes(map));
            const auto average = assets::averages(map);
            std::cout << name << ": mean radiance " << average.mean_radiance
                      << ", a level white diffuser " << average.level_white << "\n";
        };
        write_environment("studio.hdr", assets::studio_radiance);
        write_environment("overcast.hdr", assets::overcast_radiance);

        constexpr int kPatternSize = 512;
        write_png(folder / "patterns/blossoms.png", assets::blossoms(2 * kPatternSize));
        write_png(folder / "patterns/roundel.png", assets::roundel(kPatternSize));
        write_png(folder / "patterns/weave.png", assets::weave(kPatternSize));
    } catch (const std::exception& error) {
        std::cerr << "livery_generate_assets: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
