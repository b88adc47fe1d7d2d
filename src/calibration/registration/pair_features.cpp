#include "calibration/registration/pair_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>

#include <glm/geometric.hpp>

#include "calibration/registration/rotation.h"
#include "core/parallel.h"

namespace livery {

namespace {

constexpr int kAngleBins = 15;  // of 12 degrees
constexpr int kTurnBins = 30;   // of 12 degrees

/// Pairs of one kind that take part: those of a large flat face are as many as all others
/// together, and say little.
constexpr std::size_t kMostAlike = 300;

int angle_bin(const glm::dvec3& a, const glm::dvec3& b) {
    const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
    return std::min(static_cast<int>(angle / std::numbers::pi * kAngleBins), kAngleBins - 1);
}

struct PairKinds {
    int distances = 0;
    double spacing_mm = 1.0;

    std::size_t count() const {
        return static_cast<std::size_t>(distances) * kAngleBins * kAngleBins * kAngleBins;
    }
    /// -1: longer than any pair of the mesh, or too short to have a direction.
    std::ptrdiff_t of(const SurfaceSamples& samples, std::size_t a, std::size_t b) const {
        const glm::dvec3 apart = samples.points[b] - samples.points[a];
        const double distance = glm::length(apart);
        const int far = static_cast<int>(distance / spacing_mm);
        if (far < 1 || far >= distances) return -1;
        const glm::dvec3 along = apart / distance;
        std::ptrdiff_t kind = far;
        kind = kind * kAngleBins + angle_bin(samples.normals[a], along);
        kind = kind * kAngleBins + angle_bin(samples.normals[b], along);
        return kind * kAngleBins + angle_bin(samples.normals[a], samples.normals[b]);
    }
};

/// The frame of a sample: its point in the origin, its normal along x.
Rigid3 frame_of(const SurfaceSamples& samples, std::size_t at) {
    const glm::dmat3 rotation = rotation_between(samples.normals[at], {1.0, 0.0, 0.0});
    return {rotation, -(rotation * samples.points[at])};
}

double turn_of(const Rigid3& frame, const glm::dvec3& point) {
    const glm::dvec3 x = frame * point;
    return std::atan2(x.z, x.y);
}

struct MeshPair {
    std::uint32_t from = 0;
    float turn = 0.0f;
};

struct MeshPairs {
    PairKinds kinds;
    std::vector<std::uint32_t> begin;  ///< one a kind, and the end
    std::vector<MeshPair> pairs;
};

MeshPairs pairs_of(const SurfaceSamples& mesh, double spacing_mm) {
    MeshPairs result;
    Bounds box{glm::dvec3(1e300), glm::dvec3(-1e300)};
    for (const glm::dvec3& point : mesh.points) {
        box.low = glm::min(box.low, point);
        box.high = glm::max(box.high, point);
    }
    result.kinds = {static_cast<int>(glm::length(box.high - box.low) / spacing_mm) + 1, spacing_mm};
    std::vector<std::vector<MeshPair>> by_kind(result.kinds.count());
    for (std::uint32_t a = 0; a < mesh.size(); ++a) {
        const Rigid3 frame = frame_of(mesh, a);
        for (std::uint32_t b = 0; b < mesh.size(); ++b) {
            const std::ptrdiff_t kind = a == b ? -1 : result.kinds.of(mesh, a, b);
            if (kind < 0) continue;
            by_kind[static_cast<std::size_t>(kind)].push_back(
                {a, static_cast<float>(turn_of(frame, mesh.points[b]))});
        }
    }
    result.begin.push_back(0);
    for (const auto& alike : by_kind) {
        const std::size_t step = (alike.size() + kMostAlike - 1) / kMostAlike;
        for (std::size_t i = 0; i < alike.size(); i += std::max<std::size_t>(step, 1))
            result.pairs.push_back(alike[i]);
        result.begin.push_back(static_cast<std::uint32_t>(result.pairs.size()));
    }
    return result;
}

/// The poses that most pairs from one scan sample agree on.
void vote(const MeshPairs& model,
          const SurfaceSamples& mesh,
          const SurfaceSamples& scan,
          std::size_t reference,
          std::vector<float>& ballot,
          std::vector<PoseGuess>& guesses) {
    std::fill(ballot.begin(), ballot.end(), 0.0f);
    const Rigid3 frame = frame_of(scan, reference);
    for (std::size_t other = 0; other < scan.size(); ++other) {
        const std::ptrdiff_t kind =
            other == reference ? -1 : model.kinds.of(scan, reference, other);
        if (kind < 0) continue;
        const double turn = turn_of(frame, scan.points[other]);
        const auto at = static_cast<std::size_t>(kind);
        for (std::uint32_t k = model.begin[at]; k < model.begin[at + 1]; ++k) {
            const MeshPair& pair = model.pairs[k];
            double share = (turn - static_cast<double>(pair.turn)) / (2.0 * std::numbers::pi);
            share -= std::floor(share);
            const auto bin = static_cast<std::size_t>(share * kTurnBins) % kTurnBins;
            ballot[pair.from * kTurnBins + bin] += 1.0f;
        }
    }
    constexpr int kPeaks = 3;
    for (int peak = 0; peak < kPeaks; ++peak) {
        const auto best = std::max_element(ballot.begin(), ballot.end());
        if (*best < 3.0f) return;
        const auto at = static_cast<std::size_t>(best - ballot.begin());
        const double turn =
            (static_cast<double>(at % kTurnBins) + 0.5) / kTurnBins * 2.0 * std::numbers::pi;
        const Rigid3 turned{rotation_of({turn, 0.0, 0.0}), glm::dvec3(0.0)};
        guesses.push_back(
            {inverse(frame) * turned * frame_of(mesh, at / kTurnBins), static_cast<double>(*best)});
        *best = 0.0f;
    }
}

}  // namespace

std::vector<PoseGuess> poses_by_pairs(const SurfaceSamples& mesh,
                                      const SurfaceSamples& scan,
                                      double spacing_mm,
                                      std::size_t most) {
    if (mesh.size() < 3 || scan.size() < 3) return {};
    const MeshPairs model = pairs_of(mesh, spacing_mm);
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& point : mesh.points) middle += point / static_cast<double>(mesh.size());

    const std::size_t step = std::max<std::size_t>(1, scan.size() / 300);
    std::vector<std::vector<PoseGuess>> by_reference(scan.size() / step);
    parallel_for(by_reference.size(), 4, [&](std::size_t begin, std::size_t end) {
        std::vector<float> ballot(mesh.size() * kTurnBins);
        for (std::size_t i = begin; i < end; ++i)
            vote(model, mesh, scan, i * step, ballot, by_reference[i]);
    });
    std::vector<PoseGuess> guesses;
    for (const auto& some : by_reference) guesses.insert(guesses.end(), some.begin(), some.end());
    const auto more_votes = [](const PoseGuess& a, const PoseGuess& b) {
        return a.votes > b.votes;
    };
    std::stable_sort(guesses.begin(), guesses.end(), more_votes);

    std::vector<PoseGuess> distinct;
    for (const PoseGuess& guess : guesses) {
        const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const PoseGuess& one) {
            const glm::dvec3 apart = one.scan_from_mesh * middle - guess.scan_from_mesh * middle;
            return glm::length(apart) < 3.0 * spacing_mm &&
                   angle_of(glm::transpose(one.scan_from_mesh.rotation) *
                            guess.scan_from_mesh.rotation) < 15.0 * std::numbers::pi / 180.0;
        });
        if (same == distinct.end()) {
            distinct.push_back(guess);
        } else {
            same->votes += guess.votes;
        }
    }
    std::stable_sort(distinct.begin(), distinct.end(), more_votes);
    if (distinct.size() > most) distinct.resize(most);
    return distinct;
}

}  // namespace livery
