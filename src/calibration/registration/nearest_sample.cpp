#include "calibration/registration/nearest_sample.h"

#include <utility>

#include <nanoflann.hpp>

namespace livery {

namespace {

/// Points as nanoflann asks for them.
struct Points {
    std::vector<glm::dvec3> all;
    std::size_t kdtree_get_point_count() const { return all.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return all[i][static_cast<glm::length_t>(axis)];
    }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;  // nanoflann finds it
    }
};

/// The nearest so far; none beyond what it begins with.
struct Nearest {
    using DistanceType = double;
    double squared;
    std::optional<std::uint32_t> index;
    double worstDist() const { return squared; }
    bool full() const { return index.has_value(); }
    void sort() const {}
    bool addPoint(double squared_distance, std::uint32_t of) {
        if (squared_distance < squared) {
            squared = squared_distance;
            index = of;
        }
        return true;
    }
};

}  // namespace

struct NearestSample::Tree {
    Points points;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>,
                                        Points,
                                        3,
                                        std::uint32_t>
        index;
    explicit Tree(std::vector<glm::dvec3> of) : points{std::move(of)}, index(3, points) {}
};

NearestSample::NearestSample(std::vector<glm::dvec3> points)
    : tree_(std::make_unique<const Tree>(std::move(points))) {}

NearestSample::~NearestSample() = default;

std::optional<std::uint32_t> NearestSample::of(const glm::dvec3& place, double most_mm) const {
    Nearest nearest{most_mm * most_mm, std::nullopt};
    tree_->index.findNeighbors(nearest, &place.x, {});
    return nearest.index;
}

}  // namespace livery
