#include "radiance/light/mirror_quadrature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "appearance/bsdf.h"
#include "core/error.h"
#include "core/parallel.h"

namespace livery {
namespace {

/// Slopes of a ring that every size has, of the innermost at most, within the sharpest lobe's
/// width, and of the last, past which even alpha 1 has 3% of its normals, nearly all of them
/// masked.
constexpr double kCommonRing = 0.0075, kInnermostRing = 0.0024, kLastRing = 5.9;
/// Rays within this slope of the mirror direction, 3 degrees of the reflection, say the same.
constexpr double kStraightSlope = 0.03;
/// A Gaussian's width may be this share of its height over the surface's horizon: nothing is
/// mirrored from below.
constexpr double kWidthOverHorizon = 0.5;
/// Of the dielectric whose Fresnel term stands for all others' between f0 and 1.
constexpr double kDielectric = 0.04;
constexpr bool are_alphas(const GrazingLobes& lobes, float a, float b, float c) {
    return kMirrorAlphas[lobes[0]] == a && kMirrorAlphas[lobes[1]] == b &&
           kMirrorAlphas[lobes[2]] == c;
}
static_assert(are_alphas(kHalfAngleLobes[0], 0.02f, 0.042f, 0.06f) &&
                  are_alphas(kHalfAngleLobes[1], 0.085f, 0.12f, 0.17f) &&
                  are_alphas(kHalfAngleLobes[2], 0.24f, 0.5f, 1.0f) &&
                  are_alphas(kEntryLobes, 0.06f, 0.17f, 0.5f),
              "shade.glsl interpolates between these");

/// Rows of the table, even in the root of 1 - sine: that is linear in the cosine at grazing and in
/// the sine at the normal, and so is what changes there.
constexpr std::size_t kRows = 128;
constexpr double kSteepestCosine = 1e-4;
/// Every so many rows the albedo is integrated, and interpolated in between.
constexpr std::size_t kAlbedoRows = 8;

/// Masking and shadowing, with all that turns slopes of half vectors into light from there:
/// f cos dwi = P22 dslope x this. `wo` and `wi` around `h`, its z component that of unit length.
double masking(const glm::dvec3& h, const glm::dvec3& wi, const glm::dvec3& wo, double alpha) {
    const auto slope_length = [&](double mu) {
        return std::sqrt(alpha * alpha + (1.0 - alpha * alpha) * mu * mu);
    };
    const double g2 = 2.0 * wi.z * wo.z / (wi.z * slope_length(wo.z) + wo.z * slope_length(wi.z));
    return g2 * glm::dot(wo, h) / (h.z * wo.z);
}

using Shares = std::array<double, kMirrorAlphas.size()>;

/// How the slopes are parted.
struct Cells {
    glm::dvec3 wo;
    double across = 1.0;     ///< how much longer cells are across the eye's plane than along
    double of_slope2 = 0.0;  ///< area along rings, in squares of their slope
    double least = 0.0;      ///< area of the innermost cell
    double overlap = 1.0;
};

struct Cell {
    Shares share{};         ///< of each lobe that lies in it
    double variance = 0.0;  ///< of the Gaussian that overlaps with its neighbours'
    double cut = 0.0;       ///< the share of that variance which the horizon leaves
};

/// The cell around the half vector of a direction.
Cell cell_around(const glm::dvec3& wi, const Cells& cells) {
    Cell cell;
    const glm::dvec3 h = glm::normalize(wi + cells.wo);
    if (wi.z <= 0.0 || h.z <= 0.0) return cell;
    const double x = h.x / h.z, y = h.y / h.z;
    const double ring2 = x * x + y * y / (cells.across * cells.across);
    const double area = std::max(ring2 * cells.of_slope2, cells.least) * cells.across;
    const double solid_angle =
        area * 4.0 * std::max(glm::dot(cells.wo, h), 1e-4) * std::pow(h.z, 3);
    cell.variance = cells.overlap * cells.overlap * solid_angle / (4.0 * std::numbers::pi);
    cell.cut = std::min(std::pow(kWidthOverHorizon * wi.z, 2) / cell.variance, 1.0);
    for (std::size_t k = 0; k < cell.share.size(); ++k) {
        const double alpha = static_cast<double>(kMirrorAlphas[k]), a2 = alpha * alpha;
        const double spread = 1.0 + (x * x + y * y) / a2;
        cell.share[k] =
            area / (std::numbers::pi * a2 * spread * spread) * masking(h, wi, cells.wo, alpha);
    }
    return cell;
}

/// Weights that make up for what the nodes' Gaussians smear: what is smeared so comes out as it
/// should be, to the second moment. The Laplacian of density times variance is what a Gaussian of
/// that variance adds (half of it); here over four directions as far away as three-point
/// Gauss-Hermite quadrature has them.
Shares sharpened(const Cell& cell, const glm::dvec3& wi, const Cells& cells) {
    const double variance = cell.cut * cell.variance;
    const double step = std::min(std::sqrt(3.0 * variance), 0.7);
    const glm::dvec3 s = glm::normalize(glm::cross(wi, glm::dvec3(0.0, 1.0, 0.0)));
    const glm::dvec3 t = glm::cross(wi, s);
    Shares smeared{};
    for (const glm::dvec3& aside : {s, -s, t, -t}) {
        const Cell beside = cell_around(std::cos(step) * wi + std::sin(step) * aside, cells);
        for (std::size_t k = 0; k < smeared.size(); ++k) {
            smeared[k] += beside.cut * beside.share[k] - cell.cut * cell.share[k];
        }
    }
    Shares weights{};
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const double own = cell.share[k];
        const double more = smeared[k] * cell.variance / (2.0 * step * step);
        if (own > 0.0) weights[k] = own * own / std::max(own + more, own / 3.0);
    }
    return weights;
}

const f64::Fresnel& dielectric() {
    static const f64::Fresnel prepared = f64::fresnel_prepare(kDielectric);
    return prepared;
}

/// Fresnel's weight under an angle; f64::fresnel_weight() takes |wi + wo|^2.
double grazing_weight(double cosine) {
    return f64::fresnel_weight(dielectric(), 4.0 * cosine * cosine);
}

MirrorQuadrature::Even even_under(double mu) {
    const auto of = [&](const GrazingLobes& lobes, const auto& weight) {
        Texel texel{};
        for (int k = 0; k < 3; ++k) {
            const float alpha = kMirrorAlphas[lobes[static_cast<std::size_t>(k)]];
            texel[k] = static_cast<float>(weight(static_cast<double>(alpha)));
        }
        return texel;
    };
    const auto reflected = [&](double alpha) {
        double white = 0.0, grazing = 0.0;
        f64::ggx_albedo(mu, f64::albedo_fit(alpha), dielectric(), white, grazing);
        return grazing / white;
    };
    const auto entering = [&](double alpha) {
        return grazing_weight(f64::coat_entry_cosine(f64::coat_entry(alpha), mu));
    };
    MirrorQuadrature::Even even;
    for (std::size_t i = 0; i < kHalfAngleLobes.size(); ++i) {
        even.of[i] = of(kHalfAngleLobes[i], reflected);
    }
    even.of.back() = of(kEntryLobes, entering);
    return even;
}

static_assert(kMirrorAlphas.size() == kLastLobe + 1 - kFirstLobe && kLastLobe + 1 == kRowLists);

using Node = MirrorQuadrature::Node;

/// A node around the slope (x, y); weights not yet normalised.
Node node_at(double x, double y, const Cells& cells) {
    Node node{};
    const glm::dvec3 h = glm::normalize(glm::dvec3(x, y, 1.0));
    const glm::dvec3 wi = 2.0 * glm::dot(cells.wo, h) * h - cells.wo;
    const Cell cell = cell_around(wi, cells);
    node[kHalfVectorX] = static_cast<float>(h.x);
    node[kHalfVectorY] = static_cast<float>(h.y);
    node[kHalfVectorZ] = static_cast<float>(h.z);
    node[kVariance] = static_cast<float>(cell.cut * cell.variance);
    if (cell.variance <= 0.0) return node;
    node[kHalfAngleWeight] = static_cast<float>(grazing_weight(glm::dot(cells.wo, h)));
    node[kEntryWeight] = static_cast<float>(grazing_weight(wi.z));
    const Shares weights = sharpened(cell, wi, cells);
    for (std::size_t k = 0; k < weights.size(); ++k) {
        node[kFirstLobe + k] = static_cast<float>(weights[k]);
    }
    return node;
}

/// Rings inside of the common one.
std::size_t inner_rings_of(const MirrorRings& size) {
    return static_cast<std::size_t>(std::ceil(std::log(kCommonRing / kInnermostRing) / size.step));
}

std::size_t rings_of(const MirrorRings& size) {
    return inner_rings_of(size) +
           static_cast<std::size_t>(std::ceil(std::log(kLastRing / kCommonRing) / size.step));
}

double slope_of(const MirrorRings& size, std::size_t ring) {
    const double from_common =
        static_cast<double>(ring) - static_cast<double>(inner_rings_of(size));
    return kCommonRing * std::exp(size.step * from_common);
}

/// How far a ring's nodes are turned, in nodes: half of one from that below, and by another facet,
/// so that each looks all around.
double first_of(const MirrorRings& size, std::size_t ring) {
    return 1.5 * static_cast<double>((ring + 8 - inner_rings_of(size) % 8) % 8);
}

std::vector<Node> nodes_under(double mu, const MirrorRings& size, const Shares& returned) {
    const glm::dvec3 wo(std::sqrt(1.0 - mu * mu), 0.0, mu);
    // Mirrored, slopes along the eye's plane move light 1 / mu times as far as those across it.
    // Half way between slopes and directions, cells are stretched by little in either.
    const double across = std::pow(std::max(mu, 0.02), -0.4);
    const double turn = 2.0 * std::numbers::pi / size.nodes;
    const double inner = slope_of(size, 0) * std::exp(-0.5 * size.step);
    const Cells middle{wo, across, 0.0, std::numbers::pi * inner * inner, size.overlap};
    const Cells around{wo, across, std::sinh(size.step) * turn, 0.0, size.overlap};
    std::vector<Node> nodes;
    for (std::size_t k = 0; k < MirrorQuadrature::kFacets; ++k) {
        nodes.push_back(node_at(0.0, 0.0, middle));
        for (std::size_t list = kFirstLobe; list < kRowLists; ++list) {
            nodes.back()[list] *= 1.0f / MirrorQuadrature::kFacets;
        }
    }
    for (std::size_t ring = 0; ring < rings_of(size); ++ring) {
        const double slope = slope_of(size, ring);
        for (int k = 0; k < size.nodes; ++k) {
            const double phi = turn * (k + first_of(size, ring));
            nodes.push_back(node_at(slope * std::cos(phi), slope * std::sin(phi) * across, around));
        }
    }
    for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
        float whole = 0.0f;
        for (const Node& node : nodes) whole += node[kFirstLobe + k];
        const float scale = static_cast<float>(returned[k]) / whole;
        for (Node& node : nodes) node[kFirstLobe + k] *= scale;
    }
    return nodes;
}

}  // namespace

double mirror_correction(double cosine_to_eye, double alpha) {
    // Over the visible normals, of which one half mirrors the other; closer together toward those
    // that are tilted most, where some mirror below the horizon
    constexpr int kAround = 16, kTilted = 48;
    const double mu = std::max(cosine_to_eye, kSteepestCosine);
    const glm::dvec3 wo(std::sqrt((1.0 - mu) * (1.0 + mu)), 0.0, mu);
    double sum = 0.0;
    for (int i = 0; i < kAround; ++i) {
        for (int j = 0; j < kTilted; ++j) {
            const double rest = (j + 0.5) / kTilted;
            const glm::dvec2 u((i + 0.5) / (2.0 * kAround), 1.0 - rest * rest * rest);
            const glm::dvec3 wi = f64::ggx_sample_lobe(wo, u, alpha, alpha);
            if (wi.z <= 0.0) continue;
            const glm::dvec3 h = wi + wo;
            sum += 3.0 * rest * rest * wi.z *
                   f64::ggx_distribution_visibility(wi, wo, glm::dot(h, h), alpha, alpha) /
                   f64::ggx_pdf_lobe(wi, wo, alpha, alpha);
        }
    }
    double loss = 0.0, cosine = 0.0;
    f64::ggx_albedo_fit(mu, f64::albedo_fit(alpha), loss, cosine);
    return sum / (kAround * kTilted) / (1.0 - loss);
}

MirrorRings mirror_rings(int nodes) {
    if (nodes == 0) return {4, 0.6, 1.2};
    return {nodes, 2.0 * std::numbers::pi / nodes, 1.7};
}

int mirror_nodes(int nodes) {
    if (nodes == kNoNodes) return 1;
    const MirrorRings size = mirror_rings(nodes);
    return static_cast<int>(MirrorQuadrature::kFacets +
                            rings_of(size) * static_cast<std::size_t>(size.nodes));
}

int mirror_rays(int nodes) {
    if (nodes <= 0) return 0;
    const MirrorRings size = mirror_rings(nodes);
    std::size_t straight = 0;
    while (slope_of(size, straight) < kStraightSlope) ++straight;
    const std::size_t all = (rings_of(size) - straight) * static_cast<std::size_t>(nodes);
    return static_cast<int>(MirrorQuadrature::kFacets + all / MirrorQuadrature::kTurns);
}

MirrorQuadrature::MirrorQuadrature(const MirrorRings& size) : nodes_(size.nodes) {
    check_argument(size.nodes > 0 && size.nodes % static_cast<int>(kFacets) == 0 && size.step > 0.1,
                   fmt::format("rings of {} nodes, {} apart", size.nodes, size.step));
    count_ = kFacets + rings_of(size) * static_cast<std::size_t>(size.nodes);
    const auto cosine_of = [](std::size_t row) {
        const double root = static_cast<double>(row) / kRows;
        const double sine = 1.0 - root * root;
        return std::max(std::sqrt((1.0 - sine) * (1.0 + sine)), kSteepestCosine);
    };
    std::array<Shares, kRows / kAlbedoRows + 1> returned;
    parallel_for(returned.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
                returned[i][k] = mirror_correction(cosine_of(i * kAlbedoRows),
                                                   static_cast<double>(kMirrorAlphas[k]));
            }
        }
    });
    places_ = (count_ / kFacets + kNodeBlock - 1) / kNodeBlock * kNodeBlock;
    rows_.resize((kRows + 1) * kFacets * kRowLists * places_);
    for (std::size_t row = 0; row <= kRows; ++row) even_.push_back(even_under(cosine_of(row)));
    parallel_for(kRows + 1, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const std::size_t below = std::min(row / kAlbedoRows, returned.size() - 2);
            const double share =
                static_cast<double>(row) / kAlbedoRows - static_cast<double>(below);
            Shares its_own;
            for (std::size_t k = 0; k < its_own.size(); ++k) {
                its_own[k] = std::lerp(returned[below][k], returned[below + 1][k], share);
            }
            fill_row(row, nodes_under(cosine_of(row), size, its_own));
        }
    });
    find_beside(size);
    share_out_rays(rings_of(size), size);
}

void MirrorQuadrature::fill_row(std::size_t row, std::span<const Node> nodes) {
    for (std::size_t facet = 0; facet < kFacets; ++facet) {
        float* lists = &rows_[(row * kFacets + facet) * kRowLists * places_];
        // Places without a node look the way that the facet does
        std::fill_n(lists + kHalfVectorZ * places_, places_, 1.0f);
        for (std::size_t k = facet; k < nodes.size(); k += kFacets) {
            for (std::size_t list = 0; list < kRowLists; ++list) {
                lists[list * places_ + k / kFacets] = nodes[k][list];
            }
        }
    }
}

void MirrorQuadrature::find_beside(const MirrorRings& size) {
    const std::size_t rings = rings_of(size);
    beside_.resize(count_ * kBeside);
    const auto nodes = static_cast<std::size_t>(nodes_);
    for (std::size_t k = 0; k < kFacets; ++k) {
        // The middle looks for itself
        std::fill_n(beside_.begin() + static_cast<std::ptrdiff_t>(k * kBeside),
                    kBeside,
                    static_cast<std::uint16_t>(k));
    }
    for (std::size_t ring = 0; ring < rings; ++ring) {
        const std::size_t inner = ring == 0 ? ring : ring - 1;
        const std::size_t outer = ring + 1 == rings ? ring : ring + 1;
        for (std::size_t k = 0; k < nodes; ++k) {
            // Nodes of a ring, by how far they are turned from its own
            const auto node = [&](std::size_t of, double turned) {
                const double at =
                    static_cast<double>(k + nodes) + first_of(size, ring) - first_of(size, of);
                const auto place =
                    static_cast<std::size_t>(std::lround(at + turned + static_cast<double>(nodes)));
                return static_cast<std::uint16_t>(kFacets + of * nodes + place % nodes);
            };
            const std::array<std::uint16_t, kBeside> around{node(ring, -1.0),
                                                            node(ring, 1.0),
                                                            node(inner, -0.5),
                                                            node(inner, 0.5),
                                                            node(outer, -0.5),
                                                            node(outer, 0.5)};
            std::copy(around.begin(),
                      around.end(),
                      beside_.begin() +
                          static_cast<std::ptrdiff_t>((kFacets + ring * nodes + k) * kBeside));
        }
    }
}

void MirrorQuadrature::share_out_rays(std::size_t rings, const MirrorRings& size) {
    const auto nodes = static_cast<std::size_t>(size.nodes);
    rays_.resize(count_);
    nearest_.resize(count_);
    for (std::size_t k = 0; k < kFacets; ++k) {
        rays_[k].bit = static_cast<std::uint8_t>(k);
        for (auto& traced : traced_) traced.push_back(k);
    }
    for (std::size_t ring = 0; ring < rings; ++ring) {
        const std::size_t first = kFacets + ring * nodes;
        const double slope = slope_of(size, ring);
        for (std::size_t k = 0; k < nodes; ++k) {
            Ray& ray = rays_[first + k];
            if (slope < kStraightSlope) {
                ray.bit = static_cast<std::uint8_t>((first + k) % kFacets);
                continue;
            }
            // Of each facet, too, every turn gets some
            const std::size_t turn = (k + k / kTurns + ring) % kTurns;
            ray = {static_cast<std::uint8_t>(turn),
                   static_cast<std::uint8_t>(traced_[turn].size())};
            traced_[turn].push_back(first + k);
        }
        for (std::size_t k = 0; k < nodes; ++k) {
            for (std::size_t turn = 0; turn < kTurns; ++turn) {
                std::size_t closest = 2 * nodes;
                for (std::size_t j = 0; j < nodes; ++j) {
                    const Ray& ray = rays_[first + j];
                    const std::size_t apart =
                        std::min((j + nodes - k) % nodes, (k + nodes - j) % nodes);
                    if (ray.turn != turn || apart >= closest) continue;
                    closest = apart;
                    nearest_[first + k][turn] = ray.bit;
                }
            }
        }
    }
    for (const auto& traced : traced_) {
        check_argument(traced.size() <= 64,
                       fmt::format("rings of {} nodes, {} apart", size.nodes, size.step));
    }
}

MirrorQuadrature::Row MirrorQuadrature::seen_under(float sine) const {
    const float at = std::sqrt(std::clamp(1.0f - sine, 0.0f, 1.0f)) * static_cast<float>(kRows);
    const std::size_t below = std::min(static_cast<std::size_t>(at), kRows - 1);
    Row row;
    row.places_ = places_;
    row.facet_size_ = kRowLists * places_;
    row.row_size_ = kFacets * row.facet_size_;
    row.below_ = &rows_[below * row.row_size_];
    row.even_ = &even_[below];
    row.share_ = at - static_cast<float>(below);
    return row;
}

}  // namespace livery
