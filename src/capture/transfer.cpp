#include "capture/transfer.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include "capture/manifest_io.h"
#include "core/colour.h"

namespace livery {

std::function<double(double)> linearisation(const std::string& transfer, double full_scale) {
    if (transfer == "linear") return {};
    if (transfer == "srgb") {
        return [=](double value) { return full_scale * srgb_decode(value / full_scale); };
    }
    return [=, table = read_response(transfer)](double value) {
        const double last = static_cast<double>(table.size() - 1);
        const double place = std::clamp(value / full_scale, 0.0, 1.0) * last;
        const auto below = static_cast<std::size_t>(std::min(place, last - 1.0));
        const double t = place - static_cast<double>(below);
        return full_scale * ((1.0 - t) * table[below] + t * table[below + 1]);
    };
}

std::string usual_transfer(const std::filesystem::path& file) {
    std::string suffix = file.extension().string();
    for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return suffix == ".jpg" || suffix == ".jpeg" ? "srgb" : "linear";
}

std::vector<float> linear_from_eight_bits(const std::string& transfer) {
    const auto linear = linearisation(transfer, 255.0);
    std::vector<float> table(256);
    for (std::size_t k = 0; k < table.size(); ++k) {
        const auto value = static_cast<double>(k);
        table[k] = static_cast<float>(linear ? linear(value) : value);
    }
    return table;
}

}  // namespace livery
