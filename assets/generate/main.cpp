// Writes every generated asset below a folder: livery_generate_assets FOLDER
#include <exception>
#include <filesystem>
#include <iostream>

#include "car.h"
#include "core/paths.h"
#include "environments.h"
#include "glb.h"
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
        write_text_file(folder / "car.glb", assets::glb_bytes("car", assets::make_car()));

        constexpr int kSphereRings = 96;
        auto sphere = assets::sphere(25.0, kSphereRings);
        sphere.name = "sphere";
        assets::compute_tangents(sphere);
        write_text_file(folder / "sphere.glb", assets::glb_bytes("sphere", {sphere}));

        constexpr int kEnvironmentWidth = 1024;
        const auto write_environment = [&](const char* name, auto* radiance) {
            write_text_file(
                folder / "environments" / name,
                assets::hdr_bytes(assets::environment_map(radiance, kEnvironmentWidth)));
        };
        write_environment("studio.hdr", assets::studio_radiance);
        write_environment("overcast.hdr", assets::overcast_radiance);
    } catch (const std::exception& error) {
        std::cerr << "livery_generate_assets: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
