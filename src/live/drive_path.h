// From radiance to the projector's texture, on the device that shades: a lane's last steps.
#pragma once

#include <cstddef>
#include <memory>

#include "compensation/compensation.h"
#include "live/frame_pictures.h"
#include "live/projector_setup.h"
#include "radiance/renderer.h"

namespace livery {

/// For one thread, with its context current from creation to destruction. Two pictures, the sides
/// of a wipe, are under way at once.
class DrivePath {
  public:
    DrivePath() = default;
    virtual ~DrivePath() = default;
    DrivePath(const DrivePath&) = delete;
    DrivePath& operator=(const DrivePath&) = delete;

    /// The renderer's last frame, which stays when it draws the next.
    virtual FramePicture<ImageF> take(const RadianceRenderer& renderer) = 0;

    /// Projector input by the setup's table, or sRGB where there is none. `covered_pixels` is
    /// count_covered().
    virtual FramePicture<Image8> correct(std::size_t side,
                                         const std::shared_ptr<const ProjectorSetup>& setup,
                                         const FramePicture<ImageF>& radiance,
                                         std::size_t covered_pixels) = 0;
    struct Measured {
        CompensationStats stats;
        double ms = 0.0;
    };
    /// What the side's last correct() counted and took. Waits for it: call it when everything of
    /// the frame has been asked for.
    virtual Measured measured(std::size_t side) = 0;

    /// The same picture with a texture for the projector's window, if it has none.
    virtual FramePicture<Image8> show(FramePicture<Image8> drive) = 0;
    /// A wipe, with such a texture.
    virtual FramePicture<Image8> join(const FramePicture<Image8>& left,
                                      const FramePicture<Image8>& right,
                                      int column) = 0;

    /// Programs compiled and textures made so far.
    virtual int programs() const = 0;
    virtual int textures() const = 0;
};

/// Of a device that is not ShadingDevice::automatic: what OpenGL shades never leaves it, what the
/// processor shades is corrected there and uploaded.
std::unique_ptr<DrivePath> make_drive_path(ShadingDevice device);

}  // namespace livery
