// The shipped bench with few pixels, as a file: a capture on it takes seconds.
#pragma once

#include <array>
#include <filesystem>

#include "core/json.h"
#include "core/paths.h"
namespace livery::testing {

/// `projector`, `camera`: the shares of their pixels a side that are left.
inline std::filesystem::path small_bench_file(const std::filesystem::path& folder,
                                              double projector = 0.25,
                                              double camera = 0.25) {
    Json bench = read_json_file(shipped_path("calibration/default.json"));
    const auto shrink = [](Json& view, double factor) {
        for (const char* size : {"width", "height"})
            view[size] = static_cast<int>(view[size].get<double>() * factor);
        for (const std::size_t k : std::array<std::size_t, 4>{0, 2, 4, 5})
            view["matrix"][k] = view["matrix"][k].get<double>() * factor;
        for (auto& place : view["at_px"]) place = place.get<double>() * factor;
    };
    shrink(bench["projector"], projector);
    shrink(bench["camera"], camera);
    bench["name"] = "small";
    const auto file = folder / "small.json";
    write_json_file(file, bench);
    return file;
}

}  // namespace livery::testing
