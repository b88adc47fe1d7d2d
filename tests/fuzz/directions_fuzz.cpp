#include <cmath>

#include <glm/geometric.hpp>

#include "appearance/directions.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    for (const livery::DirectionPair& pair : livery::parse_directions_csv(text, "a.csv")) {
        livery::fuzz::require(std::abs(glm::dot(pair.wi, pair.wi) - 1.0) < 1e-9, "unit");
        livery::fuzz::require(std::abs(glm::dot(pair.wo, pair.wo) - 1.0) < 1e-9, "unit");
    }
}
