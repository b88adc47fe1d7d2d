#include "subdivision.h"

#include <memory>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

namespace livery::assets {

namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

/// What OpenSubdiv interpolates: position and parameters together.
struct Carried {
    glm::dvec3 position{0.0};
    glm::dvec2 parameters{0.0};
    void Clear() { *this = Carried{}; }
    void AddWithWeight(const Carried& other, double weight) {
        position += other.position * weight;
        parameters += other.parameters * weight;
    }
};

std::unique_ptr<Far::TopologyRefiner> make_refiner(const Cage& cage, int levels) {
    std::vector<int> corners_per_face(cage.faces.size(), 4);
    std::vector<int> corners;
    for (const auto& face : cage.faces) {
        for (int k = 0; k < 4; ++k) corners.push_back(face.corners[k]);
    }
    std::vector<int> crease_pairs;
    std::vector<float> sharpness;
    for (const auto& crease : cage.creases) {
        crease_pairs.push_back(crease.edge.x);
        crease_pairs.push_back(crease.edge.y);
        sharpness.push_back(static_cast<float>(crease.sharpness));
    }
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(cage.surface_points.size());
    descriptor.numFaces = static_cast<int>(cage.faces.size());
    descriptor.numVertsPerFace = corners_per_face.data();
    descriptor.vertIndicesPerFace = corners.data();
    descriptor.numCreases = static_cast<int>(sharpness.size());
    descriptor.creaseVertexIndexPairs = crease_pairs.data();
    descriptor.creaseWeights = sharpness.data();
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_CATMARK, Sdc::Options())));
    if (!refiner) throw std::invalid_argument("limit_surface: the cage is not a surface");
    Far::TopologyRefiner::UniformOptions options(levels);
    options.fullTopologyInLastLevel = true;  // limit points need it
    refiner->RefineUniform(options);
    return refiner;
}

/// The refined control points of the last level.
std::vector<Carried> refine(const Far::TopologyRefiner& refiner, std::vector<Carried> values) {
    const Far::PrimvarRefinerReal<double> primvar(refiner);
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        const auto count = static_cast<std::size_t>(refiner.GetLevel(level).GetNumVertices());
        std::vector<Carried> next(count);
        primvar.Interpolate(level, values, next);
        values = std::move(next);
    }
    return values;
}

struct Limits {
    std::vector<Carried> points, along_1, along_2;
};

Limits limits(const Far::TopologyRefiner& refiner, const std::vector<Carried>& control) {
    const auto refined = refine(refiner, control);
    Limits result;
    result.points.resize(refined.size());
    result.along_1.resize(refined.size());
    result.along_2.resize(refined.size());
    Far::PrimvarRefinerReal<double>(refiner).Limit(
        refined, result.points, result.along_1, result.along_2);
    return result;
}

}  // namespace

LimitMesh limit_surface(const Cage& cage, int levels, int fit_iterations) {
    std::vector<Carried> control(cage.surface_points.size());
    for (std::size_t k = 0; k < control.size(); ++k) {
        control[k] = {cage.surface_points[k], cage.parameters[k]};
    }

    // Fit on one refinement: a cage vertex's child has the same limit point.
    const auto coarse = make_refiner(cage, 1);
    for (int step = 0; step < fit_iterations; ++step) {
        const auto now = limits(*coarse, control);
        for (std::size_t k = 0; k < control.size(); ++k) {
            const int child = coarse->GetLevel(0).GetVertexChildVertex(static_cast<int>(k));
            control[k].position +=
                cage.surface_points[k] - now.points[static_cast<std::size_t>(child)].position;
        }
    }

    const auto refiner = make_refiner(cage, levels);
    const auto fine = limits(*refiner, control);
    LimitMesh mesh;
    for (std::size_t k = 0; k < fine.points.size(); ++k) {
        const auto normal = glm::cross(fine.along_1[k].position, fine.along_2[k].position);
        mesh.vertices.push_back(
            {fine.points[k].position, glm::normalize(normal), fine.points[k].parameters});
    }
    const auto& finest = refiner->GetLevel(levels);
    for (int face = 0; face < finest.GetNumFaces(); ++face) {
        const auto corners = finest.GetFaceVertices(face);
        int ancestor = face;
        for (int level = levels; level > 0; --level) {
            ancestor = refiner->GetLevel(level).GetFaceParentFace(ancestor);
        }
        mesh.quads.push_back({{corners[0], corners[1], corners[2], corners[3]},
                              cage.faces[static_cast<std::size_t>(ancestor)].region});
    }
    return mesh;
}

}  // namespace livery::assets
