#include "patterns.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/colour.h"
#include "core/random.h"

namespace livery::assets {

namespace {

constexpr int kSamples = 4;  // a pixel's side

/// Means of linear colours over each pixel, encoded as sRGB.
Image8 drawn(int size, const std::function<glm::dvec3(const glm::dvec2&)>& colour) {
    Image8 image(size, size, 3);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            glm::dvec3 sum(0.0);
            for (int k = 0; k < kSamples * kSamples; ++k) {
                const glm::dvec2 at(x + (k % kSamples + 0.5) / kSamples,
                                    y + (k / kSamples + 0.5) / kSamples);
                sum += colour(at / static_cast<double>(size));
            }
            for (int c = 0; c < 3; ++c) {
                const double encoded = srgb_encode(sum[c] / (kSamples * kSamples));
                image.at(x, y, c) = static_cast<std::uint8_t>(std::lround(255.0 * encoded));
            }
        }
    }
    return image;
}

glm::dvec3 srgb(int red, int green, int blue) {
    return {srgb_decode(red / 255.0), srgb_decode(green / 255.0), srgb_decode(blue / 255.0)};
}

/// From a to b the short way around a tile.
glm::dvec2 around(const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 d = b - a;
    return d - glm::round(d);
}

struct Flower {
    glm::dvec2 at;
    double radius, turn;
    glm::dvec3 petal;
};

/// Loosely packed: each candidate keeps its distance from those before it.
std::vector<Flower> flowers() {
    const glm::dvec3 petals[] = {
        srgb(214, 92, 78), srgb(236, 168, 92), srgb(72, 112, 150), srgb(200, 128, 140)};
    std::vector<Flower> list;
    Random random(5);
    constexpr int kCandidates = 8000;
    for (int k = 0; k < kCandidates; ++k) {
        // Large ones first, small ones into what they leave
        const double room = 1.0 - static_cast<double>(k) / kCandidates;
        const glm::dvec2 at(random.uniform(), random.uniform());
        const double radius = 0.035 + 0.085 * room * random.uniform();
        const bool free = std::all_of(list.begin(), list.end(), [&](const Flower& other) {
            return glm::length(around(at, other.at)) > 1.15 * (radius + other.radius);
        });
        if (free)
            list.push_back(
                {at, radius, 2.0 * std::numbers::pi * random.uniform(), petals[random.below(4)]});
    }
    return list;
}

/// A leaf from the flower's middle outward, pointed at both ends.
bool in_leaf(const glm::dvec2& d, double turn, double radius) {
    const double length = 1.45 * radius;
    const double along = (d.x * std::cos(turn) + d.y * std::sin(turn)) / length;
    const double across = (d.y * std::cos(turn) - d.x * std::sin(turn)) / length;
    return along > 0.0 && along < 1.0 &&
           std::abs(across) < 0.22 * std::sin(std::numbers::pi * along);
}

}  // namespace

Image8 blossoms(int size) {
    const std::vector<Flower> list = flowers();
    const glm::dvec3 ground = srgb(243, 238, 228), leaf = srgb(104, 132, 96);
    const glm::dvec3 heart = srgb(240, 206, 110);
    return drawn(size, [&](const glm::dvec2& at) {
        glm::dvec3 colour = ground;
        for (const Flower& flower : list) {
            const glm::dvec2 d = around(flower.at, at);
            for (const double side : {0.9, 2.7}) {
                if (in_leaf(d, flower.turn + side, flower.radius)) colour = leaf;
            }
        }
        for (const Flower& flower : list) {
            const glm::dvec2 d = around(flower.at, at);
            const double r = glm::length(d) / flower.radius;
            if (r > 1.0) continue;
            const double angle = std::atan2(d.y, d.x) - flower.turn;
            const double petal = 0.68 + 0.32 * std::abs(std::cos(2.5 * angle));
            if (r < petal) colour = flower.petal * (0.72 + 0.28 * r / petal);
            if (r < 0.24) colour = heart;
        }
        return colour;
    });
}

Image8 roundel(int size) {
    const auto seven = [](const glm::dvec2& at) {
        // A bar and a leg that leans to its left end
        const bool bar = std::abs(at.x - 0.5) < 0.2 && at.y > 0.2 && at.y < 0.31;
        const double down = (at.y - 0.2) / 0.6;
        const double middle = 0.63 - 0.21 * down;
        return bar || (down > 0.0 && down < 1.0 && std::abs(at.x - middle) < 0.072);
    };
    return drawn(size, [&](const glm::dvec2& at) {
        const bool disc = glm::length(at - 0.5) < 0.49;
        return glm::dvec3(disc && !seven(at) ? 1.0 : 0.0);
    });
}

Image8 weave(int size) {
    // Two by two threads a tile, each rising over one and diving under the next
    constexpr int kThreads = 4;
    Image8 image(size, size, 3);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const double u = kThreads * (x + 0.5) / size, v = kThreads * (y + 0.5) / size;
            const bool warp = (static_cast<int>(u) + static_cast<int>(v)) % 2 == 0;
            const double along = (warp ? v : u), across = (warp ? u : v);
            // Heights in threads: round across, a wave along
            const double slope_across = -0.9 * (across - std::floor(across) - 0.5);
            const double slope_along =
                -0.55 * std::sin(2.0 * std::numbers::pi * (along - std::floor(along) - 0.5) * 0.5);
            const double right = warp ? slope_across : slope_along;
            const double down = warp ? slope_along : slope_across;
            const glm::dvec3 normal = glm::normalize(glm::dvec3(-right, down, 1.0));
            for (int c = 0; c < 3; ++c) {
                image.at(x, y, c) =
                    static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * normal[c]));
            }
        }
    }
    return image;
}

}  // namespace livery::assets
