// The sparse sum that makes a picture: light of the projector's pixels over traced paths.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "twin/factors.h"
#include "twin/light_transport.h"

namespace livery {

/// Everything fixed about one kind of receiver.
struct Receivers {
    const TracedReceivers* traced = nullptr;  ///< outlives this
    Factors factors;
};

/// What each gather place throws on: [place * surfaces + surface seen], in the sensor's units.
std::vector<glm::vec3> bounced_light(const Gathers& gathers,
                                     const Factors& factors,
                                     const ImageF& light);

/// Reading of receiver i, ambient light apart.
glm::vec3 receive(const Receivers& receivers,
                  const std::vector<glm::vec3>& bounced,
                  const ImageF& light,
                  std::size_t i);

/// All of them as a picture (3 channels); 0 where nothing of the mock-up is.
ImageF receive_all(const Receivers& receivers, const Gathers& gathers, const ImageF& light);

/// Reading of receiver i in the room's light alone, and the picture of it.
glm::vec3 receive_ambient(const Receivers& receivers, std::size_t i);
ImageF receive_ambient(const Receivers& receivers);

}  // namespace livery
