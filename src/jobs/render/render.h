// The way of a frame, composed: scene -> radiance -> projector input; and pictures from files as
// its target, or for the path tracer to light a product with.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "compensation/compensation.h"
#include "core/image.h"
#include "core/progress.h"
#include "gl/context.h"
#include "mesh/mesh.h"
#include "reference/light_sampling.h"
#include "reference/path_tracer.h"
#include "scene/frame_plan.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

enum class RenderBackend { gl, reference };

struct RenderRequest {
    Scene scene;
    View view;
    Quality quality = Quality::normal;
    std::optional<EffectLevels> levels{};  ///< gl only; none: the quality's
    FrameStage stage = FrameStage::radiance;
    RenderBackend backend = RenderBackend::gl;
    GlDevice gl_device = GlDevice::automatic;
    int samples_per_pixel = 0;        ///< reference only; 0: by the quality
    double seconds = 0.0;             ///< reference only; 0: by samples
    double error = 0.0;               ///< reference only, as ReferenceOptions has it; 0: by samples
    int bounces = kReferenceBounces;  ///< reference only
    std::shared_ptr<const ProjectedLight> projected{};  ///< reference only; null: none
    std::uint64_t seed = 1;
    const CompensationTable* compensation = nullptr;  ///< needed for FrameStage::projector
};

struct RenderedFrame {
    ImageF radiance_working;  ///< R, G, B, coverage
    Image8 drive;             ///< projector input; empty unless the stage is projector
    FramePlan plan;           ///< with measured milliseconds
    CompensationStats compensation;
    double ms_total = 0.0;
    std::string renderer;                   ///< GL_RENDERER, or "reference"
    std::optional<ReferenceResult> traced;  ///< by reference: all but its picture
};

/// Everything from scratch, for files. Throws std::invalid_argument (projector stage without a
/// compensation, or one of another size).
RenderedFrame render_frame(const RenderRequest& request, const Progress& progress = {});

/// So that a wrong name fails before the work, not after it. Throws FileError for a suffix that
/// write_frame does not write, and for a folder that is not there.
void check_frame_file(const std::filesystem::path& file, FrameStage stage);

/// EXR: linear Rec.709, multiplied by the coverage in A as OpenEXR has it; of a traced picture also
/// what is known of it: variance.Y (of the mean luminance), confidence.Y (half of its 95%
/// interval), both of what covers the pixel, and samples.Y. PNG: sRGB over black for looking at, or
/// device values when the frame reached the projector stage. Throws FileError for another suffix.
void write_frame(const std::filesystem::path& file, const RenderedFrame& frame, FrameStage stage);

struct TargetPicture {
    ImageF wanted;  ///< working space, coverage in the fourth channel
    bool has_coverage = false;
};

/// Linear Rec.709 floats -> working space with coverage: 1 where the file has no A, by which colour
/// is multiplied where it has one (associated alpha). NaN and Inf stay: the compensation counts
/// them as invalid. Throws FileError (size, integers, channels).
TargetPicture read_target_picture(const std::filesystem::path& file, int width, int height);

/// Floats are light in linear Rec.709, what they do not cover dark; integers are sRGB. 1 is what
/// makes white of a white diffuser that faces the projector at the middle of the mesh. Throws
/// FileError (another size than the projector's, channels, a negative value or no number, a product
/// behind the projector).
std::shared_ptr<const ProjectedLight> read_projected_picture(const std::filesystem::path& file,
                                                             const View& projector,
                                                             const Mesh& mesh);

/// From the eye, of that size, by a lens that has all of the mesh in the picture.
View view_of_all(const Mesh& mesh, const glm::dvec3& eye_mm, int width, int height);

}  // namespace livery
