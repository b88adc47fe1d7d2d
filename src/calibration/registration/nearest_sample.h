// The nearest of many points.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

namespace livery {

/// A k-d tree (Bentley 1975). May be asked by several threads at once.
class NearestSample {
  public:
    explicit NearestSample(std::vector<glm::dvec3> points);
    ~NearestSample();
    /// Its index; nothing where none is within `most_mm`.
    std::optional<std::uint32_t> of(const glm::dvec3& place, double most_mm) const;

  private:
    struct Tree;
    std::unique_ptr<const Tree> tree_;
};

}  // namespace livery
