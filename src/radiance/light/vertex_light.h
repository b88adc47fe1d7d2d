// Light at the vertices of a product, solved on the processor: what RasterPreview draws with.
#pragma once

#include <memory>
#include <vector>

#include <glm/vec4.hpp>

#include "core/progress.h"
#include "radiance/light/environment_filter.h"
#include "scene/look.h"
#include "scene/product.h"

namespace livery {

/// How many sides of its vertices a mesh has lit: all fronts, then, where any triangle has two
/// sides, all backs in the same order.
std::size_t lit_sides(const Mesh& mesh);

/// Immutable and shared: solved in one thread, drawn with in another. Of each of lit_sides().
struct VertexLight {
    std::vector<DirectionalLight> lights;            ///< that `visibility` was solved for
    std::shared_ptr<const Environment> environment;  ///< that `sky` was solved for; null: none
    std::vector<float> visibility;  ///< lights.size() a side: share of the disc that it sees
    std::vector<glm::vec4> sky;     ///< one a side: light on a white diffuser; openness
    std::shared_ptr<const FilteredEnvironment> filtered;  ///< mirrored and diffuse; null: none
    bool guessed = false;                                 ///< of guessed_light()
};

/// Whether it was solved for these: brightness and colour of a light play no part.
bool is_solved_for(const VertexLight& light,
                   const std::vector<DirectionalLight>& lights,
                   const Environment* environment);

/// What a first picture can be drawn in at once, without a ray: nothing hides any light, and the
/// environment is mirrored blurred. is_solved_for() nothing.
std::shared_ptr<const VertexLight> guessed_light(const Product& product,
                                                 const std::vector<DirectionalLight>& lights,
                                                 const Environment* environment);

/// Keeps what the next light may use again: openness, the filtered map (a change of rotation or
/// scale needs no filtering), shadows of lights that stayed. For one thread at a time.
class VertexLightSolver {
  public:
    explicit VertexLightSolver(std::shared_ptr<const Product> product);
    ~VertexLightSolver();
    VertexLightSolver(const VertexLightSolver&) = delete;
    VertexLightSolver& operator=(const VertexLightSolver&) = delete;

    std::shared_ptr<const VertexLight> solve(const std::vector<DirectionalLight>& lights,
                                             std::shared_ptr<const Environment> environment,
                                             const Progress& progress = {});

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
