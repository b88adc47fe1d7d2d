#include "compensation/drive_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <glm/glm.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace livery {
namespace {

constexpr int kStartGrid = 33;
constexpr float kSliver = 1e-6f;

/// The tetrahedron of a grid cell that holds a point: its corner and the order of its axes.
struct Tetrahedron {
    std::array<std::size_t, 4> node;
    glm::vec4 weight;
    std::array<int, 3> axis;  ///< from the largest fraction to the smallest
};

Tetrahedron tetrahedron_at(int grid, const glm::vec3& position) {
    const std::array<std::size_t, 3> stride = {
        1,
        static_cast<std::size_t>(grid),
        static_cast<std::size_t>(grid) * static_cast<std::size_t>(grid)};
    glm::vec3 fraction;
    std::size_t corner = 0;
    for (int k = 0; k < 3; ++k) {
        const int cell = std::clamp(static_cast<int>(position[k]), 0, grid - 2);
        fraction[k] = position[k] - static_cast<float>(cell);
        corner += static_cast<std::size_t>(cell) * stride[static_cast<std::size_t>(k)];
    }
    Tetrahedron t;
    t.axis = {0, 1, 2};
    if (fraction[t.axis[0]] < fraction[t.axis[1]]) std::swap(t.axis[0], t.axis[1]);
    if (fraction[t.axis[1]] < fraction[t.axis[2]]) std::swap(t.axis[1], t.axis[2]);
    if (fraction[t.axis[0]] < fraction[t.axis[1]]) std::swap(t.axis[0], t.axis[1]);
    t.node[0] = corner;
    for (std::size_t i = 0; i < 3; ++i) {
        t.node[i + 1] = t.node[i] + stride[static_cast<std::size_t>(t.axis[i])];
    }
    const float a = fraction[t.axis[0]], b = fraction[t.axis[1]], c = fraction[t.axis[2]];
    t.weight = glm::vec4(1.0f - a, a - b, b - c, c);
    return t;
}

glm::vec3 interpolate(const std::vector<glm::vec3>& values, const Tetrahedron& t) {
    return values[t.node[0]] * t.weight[0] + values[t.node[1]] * t.weight[1] +
           values[t.node[2]] * t.weight[2] + values[t.node[3]] * t.weight[3];
}

/// Where a rising curve over [0, 1] reaches a value.
float inverse_look_up(const std::vector<float>& curve, float value) {
    const auto above = std::upper_bound(curve.begin(), curve.end(), value);
    if (above == curve.begin()) return 0.0f;
    if (above == curve.end()) return 1.0f;
    const auto i = static_cast<std::size_t>(above - curve.begin());
    const float f = (value - curve[i - 1]) / (curve[i] - curve[i - 1]);
    return (static_cast<float>(i - 1) + f) / static_cast<float>(curve.size() - 1);
}

/// Bounded least squares over the whole cube, for the start grid: Gauss-Newton with the
/// variables that push against their bound held there.
glm::vec3 nearest_linear(const NonAdditive& table, const glm::vec3& n, glm::vec3 linear) {
    glm::mat3 jacobian;
    glm::vec3 residual = n_at_linear(table, linear, &jacobian) - n;
    float error = glm::dot(residual, residual);
    for (int iteration = 0; iteration < 40 && error > 1e-14f; ++iteration) {
        const glm::vec3 gradient = glm::transpose(jacobian) * residual;
        glm::mat3 normal = glm::transpose(jacobian) * jacobian;
        glm::vec3 right = -gradient;
        const float ridge = 1e-7f * (normal[0][0] + normal[1][1] + normal[2][2]) + 1e-20f;
        for (int k = 0; k < 3; ++k) {
            normal[k][k] += ridge;
            const bool held = (linear[k] <= 0.0f && gradient[k] > 0.0f) ||
                              (linear[k] >= 1.0f && gradient[k] < 0.0f);
            if (!held) continue;
            for (int j = 0; j < 3; ++j) normal[j][k] = normal[k][j] = j == k ? 1.0f : 0.0f;
            right[k] = 0.0f;
        }
        const glm::vec3 step = glm::inverse(normal) * right;
        bool better = false;
        for (float scale = 1.0f; scale > 1e-3f && !better; scale *= 0.5f) {
            const glm::vec3 tried =
                glm::clamp(linear + scale * step, glm::vec3(0.0f), glm::vec3(1.0f));
            const glm::vec3 r = n_at_linear(table, tried, nullptr) - n;
            if (glm::dot(r, r) < error) {
                linear = tried;
                error = glm::dot(r, r);
                better = true;
            }
        }
        if (!better) break;
        residual = n_at_linear(table, linear, &jacobian) - n;
    }
    return linear;
}

glm::vec3 nearest_node(const NonAdditive& table, const glm::vec3& n) {
    std::size_t best = 0;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < table.n_from_nodes.size(); ++i) {
        const glm::vec3 d = table.n_from_nodes[i] - n;
        if (glm::dot(d, d) < least) {
            least = glm::dot(d, d);
            best = i;
        }
    }
    const auto grid = static_cast<std::size_t>(table.grid);
    return glm::vec3(table.linear_of_node[0][best % grid],
                     table.linear_of_node[1][best / grid % grid],
                     table.linear_of_node[2][best / (grid * grid)]);
}

/// A node's number, fractional: linear in linear light between nodes.
float node_of_linear(const NonAdditive& table, std::size_t channel, float linear, float* per_node) {
    const std::vector<float>& nodes = table.linear_of_node[channel];
    const float drive = look_up(table.rho[channel], linear);
    const int cell =
        std::clamp(static_cast<int>(drive * static_cast<float>(table.grid - 1) * (1.0f / 255.0f)),
                   0,
                   table.grid - 2);
    const auto i = static_cast<std::size_t>(cell);
    *per_node = 1.0f / (nodes[i + 1] - nodes[i]);
    // Just beyond a node by rounding is as good as on it.
    const float fraction = std::clamp((linear - nodes[i]) * *per_node, 0.0f, 1.0f);
    return static_cast<float>(cell) + fraction;
}

float linear_of_node(const NonAdditive& table, std::size_t channel, float node) {
    const std::vector<float>& nodes = table.linear_of_node[channel];
    const int cell = std::clamp(static_cast<int>(node), 0, table.grid - 2);
    const auto i = static_cast<std::size_t>(cell);
    return nodes[i] + (node - static_cast<float>(cell)) * (nodes[i + 1] - nodes[i]);
}

}  // namespace

float look_up(const std::vector<float>& curve, float at) {
    const float scaled = std::clamp(at, 0.0f, 1.0f) * static_cast<float>(curve.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(scaled), curve.size() - 2);
    return curve[i] + (scaled - static_cast<float>(i)) * (curve[i + 1] - curve[i]);
}

std::vector<float> shaper_of(const ResponseCurve& response) {
    std::vector<float> curve = response.drive_from_n;
    bool usable = curve.size() >= 2 && std::abs(curve.front()) <= 0.5f &&
                  std::abs(curve.back() - 255.0f) <= 0.5f;
    if (usable) {
        curve.front() = 0.0f;
        curve.back() = 255.0f;
        for (std::size_t i = 1; i < curve.size(); ++i) usable = usable && curve[i] >= curve[i - 1];
    }
    if (usable) return curve;
    curve.resize(1024);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const double n = static_cast<double>(i) / static_cast<double>(curve.size() - 1);
        curve[i] = static_cast<float>(255.0 * std::pow(n, 1.0 / 2.2));
    }
    return curve;
}

NonAdditive make_non_additive(const DriveTable& drive_table,
                              const std::array<ResponseCurve, 3>& response) {
    const auto grid = static_cast<std::size_t>(std::max(drive_table.grid, 0));
    check_argument(drive_table.grid >= 2 && drive_table.grid <= 65 &&
                       drive_table.n_from_drive.size() == grid * grid * grid,
                   "drive table of " + std::to_string(drive_table.grid) + " nodes a side holds " +
                       std::to_string(drive_table.n_from_drive.size()) +
                       " values, expected 2 to 65 nodes and their cube");
    for (const glm::vec3& n : drive_table.n_from_drive) {
        check_argument(std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z),
                       "drive table holds a number that is not finite");
    }
    NonAdditive table;
    table.grid = drive_table.grid;
    table.n_from_nodes = drive_table.n_from_drive;
    for (std::size_t k = 0; k < 3; ++k) {
        table.rho[k] = shaper_of(response[k]);
        for (std::size_t i = 0; i < grid; ++i) {
            const float drive = 255.0f * static_cast<float>(i) / static_cast<float>(grid - 1);
            table.linear_of_node[k].push_back(inverse_look_up(table.rho[k], drive));
        }
        // Drives that give no more light than the one before (a dead zone) keep a sliver, so that
        // every cell can be divided by its width.
        std::vector<float>& nodes = table.linear_of_node[k];
        nodes.back() = 1.0f;
        for (std::size_t i = 1; i + 1 < grid; ++i)
            nodes[i] = std::max(nodes[i], nodes[i - 1] + kSliver);
        for (std::size_t i = grid - 1; i > 0; --i)
            nodes[i - 1] = std::min(nodes[i - 1], nodes[i] - kSliver);
    }
    table.start_grid = kStartGrid;
    constexpr std::size_t kSide = kStartGrid;
    table.start.resize(kSide * kSide * kSide);
    parallel_for(table.start.size(), kSide, [&](std::size_t begin, std::size_t end) {
        glm::vec3 previous(0.0f);
        for (std::size_t i = begin; i < end; ++i) {
            const std::array<std::size_t, 3> at = {
                i % kSide, i / kSide % kSide, i / (kSide * kSide)};
            glm::vec3 n;
            for (std::size_t k = 0; k < 3; ++k) {
                const float v = static_cast<float>(at[k]) / static_cast<float>(kSide - 1);
                n[static_cast<int>(k)] = inverse_look_up(table.rho[k], 255.0f * v);
            }
            // The neighbour before is close by; the nearest node guards against a bad corner.
            const glm::vec3 a = nearest_linear(table, n, previous);
            const glm::vec3 b = nearest_linear(table, n, nearest_node(table, n));
            const glm::vec3 error_a = n_at_linear(table, a, nullptr) - n;
            const glm::vec3 error_b = n_at_linear(table, b, nullptr) - n;
            previous = glm::dot(error_a, error_a) < glm::dot(error_b, error_b) ? a : b;
            float per_node = 0.0f;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto axis = static_cast<int>(k);
                table.start[i][axis] = node_of_linear(table, k, previous[axis], &per_node);
            }
        }
    });
    return table;
}

glm::vec3 n_at_linear(const NonAdditive& table, const glm::vec3& linear, glm::mat3* jacobian) {
    glm::vec3 node, per_node;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<int>(k);
        node[axis] = node_of_linear(table, k, linear[axis], &per_node[axis]);
    }
    const Tetrahedron t = tetrahedron_at(table.grid, node);
    if (jacobian) {
        for (std::size_t i = 0; i < 3; ++i) {
            const int axis = t.axis[i];
            (*jacobian)[axis] =
                (table.n_from_nodes[t.node[i + 1]] - table.n_from_nodes[t.node[i]]) *
                per_node[axis];
        }
    }
    return interpolate(table.n_from_nodes, t);
}

glm::vec3 drive_of_n(const NonAdditive& table, const glm::vec3& n, glm::vec3* residual) {
    glm::vec3 in_start, linear;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<int>(k);
        in_start[axis] = look_up(table.rho[k], n[axis]) * (1.0f / 255.0f) *
                         static_cast<float>(table.start_grid - 1);
    }
    const glm::vec3 node = interpolate(table.start, tetrahedron_at(table.start_grid, in_start));
    for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<int>(k);
        linear[axis] = linear_of_node(table, k, node[axis]);
    }
    glm::mat3 jacobian;
    glm::vec3 error = n_at_linear(table, linear, &jacobian) - n;
    for (int step = 0; step < kNewtonSteps; ++step) {
        if (glm::dot(error, error) < kSolvedN * kSolvedN ||
            std::abs(glm::determinant(jacobian)) < 1e-18f) {
            break;
        }
        const glm::vec3 tried =
            glm::clamp(linear - glm::inverse(jacobian) * error, glm::vec3(0.0f), glm::vec3(1.0f));
        glm::mat3 jacobian_there;
        const glm::vec3 error_there = n_at_linear(table, tried, &jacobian_there) - n;
        // Outside the reachable set a full step may overshoot: never move away from the wanted N.
        if (glm::dot(error_there, error_there) >= glm::dot(error, error)) break;
        linear = tried;
        error = error_there;
        jacobian = jacobian_there;
    }
    *residual = error;
    return {look_up(table.rho[0], linear.x),
            look_up(table.rho[1], linear.y),
            look_up(table.rho[2], linear.z)};
}

double brightest_reachable(const NonAdditive& table,
                           const glm::dvec3& direction,
                           const glm::dvec3& offset,
                           double upper) {
    const auto reachable = [&](double g) {
        glm::vec3 residual;
        drive_of_n(table, glm::vec3(direction * g + offset), &residual);
        return glm::dot(residual, residual) <= kReachableN * kReachableN;
    };
    if (upper <= 0.0 || reachable(upper)) return std::max(upper, 0.0);
    double low = 0.0, high = upper;
    for (int i = 0; i < 16; ++i) {
        const double middle = 0.5 * (low + high);
        (reachable(middle) ? low : high) = middle;
    }
    return low;
}

}  // namespace livery
