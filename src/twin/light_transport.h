// One bounce of light between places of the mock-up, gathered at a few thousand places of its
// surface.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/progress.h"
#include "scene/product.h"
#include "twin/light_paths.h"

namespace livery {

/// Light from one projector pixel that reaches a gather place by way of another place of the
/// mock-up: weight times the pixel's light times the reflectance there.
struct Gathers {
    std::vector<std::uint32_t> begin;  ///< places + 1
    std::vector<PathTerm> terms;       ///< of one place: by surface, then by projector pixel

    /// Up to eight places around each receiver; weights sum to 1 (or are all 0: none near).
    struct Blend {
        std::array<std::uint32_t, 8> place{};
        std::array<float, 8> weight{};
    };
};

/// Which places there are follows from the receivers: one in each cell of a grid in space and each
/// of the six directions that the surface mainly faces there.
class GatherPlaces {
  public:
    explicit GatherPlaces(double cell_mm) : cell_mm_(cell_mm) {}
    void add(const LightPaths& receivers);
    Gathers gather(const TracedWorld& world, int rays_a_place, const Progress& progress) const;
    std::vector<Gathers::Blend> blend(const LightPaths& receivers) const;
    std::size_t size() const { return places_.size(); }

  private:
    struct Place {
        glm::dvec3 mean_mm{0.0};  ///< of all receivers of the cell so far
        double count = 0.0;
        glm::dvec3 position_mm{0.0}, normal{0.0};  ///< of the receiver nearest the mean
    };
    std::unordered_map<std::uint64_t, std::uint32_t> index_;
    std::vector<Place> places_;
    double cell_mm_;
};

/// Whether the observer's own picture is traced besides what each projector pixel lights.
enum class EyePicture { none, traced };

/// What the pixels of one picture get. Without interreflection `blends` is empty.
struct TracedReceivers {
    int width = 0, height = 0;
    LightPaths paths;
    std::vector<Gathers::Blend> blends;
};

struct TracedObserver {
    TracedReceivers receivers;
    Image8 lit, edge, seen_by_eye;  ///< as ObservedPaths
};

struct LightTransport {
    std::string made_of;  ///< key_of_transport()
    TracedReceivers camera;
    TracedObserver projector;  ///< what each projector pixel lights, seen from the eye
    std::optional<View> eye_view;
    std::optional<TracedObserver> eye;
    Gathers gathers;
};

/// Hash of all that light transport depends on: views, vignetting, samples, the mock-up with what
/// stands around it, and which place has which reflectance, whatever its spectrum.
std::string key_of_transport(const BenchDescription& description,
                             const Product& product,
                             EyePicture eye_picture);

/// Throws std::invalid_argument as Bench.
std::shared_ptr<const LightTransport> trace_light(const BenchDescription& description,
                                                  const Product& product,
                                                  EyePicture eye_picture,
                                                  const Progress& progress);

}  // namespace livery
