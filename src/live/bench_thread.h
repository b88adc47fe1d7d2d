// The simulated bench on a thread of its own: its photograph of the mock-up, for people to look at,
// and its calibration.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/bench_ports.h"
#include "core/image.h"
#include "jobs/comparison.h"
#include "mesh/mesh.h"
#include "scene/product.h"
#include "twin/description.h"

namespace livery {

/// From linear camera colour a second to XYZ, exact for a neutral surface under the projector's
/// primaries; a white diffuser that faces full red + green + blue has Y = 1.
glm::dmat3 xyz_from_bench_camera(const BenchDescription& bench);

/// A photograph as sRGB where `white_y` is white; 0: its 99.9th percentile.
Image8 srgb_from_photograph(const Photograph& photograph,
                            const BenchDescription& bench,
                            const PixelRectangle& part,
                            double white_y);

struct BenchPhotograph {
    std::uint64_t number = 0;  ///< of the frame that it shows
    Image8 srgb;               ///< 3 channels, cropped to the mock-up; empty: none yet
    double seconds = 0.0;
    std::string problem;  ///< why there is none of this frame; `srgb` is the last good one
};

class BenchThread {
  public:
    /// `on_change` is called on the bench's thread after every change and must not throw.
    explicit BenchThread(std::function<void()> on_change);
    ~BenchThread();
    BenchThread(const BenchThread&) = delete;
    BenchThread& operator=(const BenchThread&) = delete;

    /// Which bench with which mock-up; traced when first needed. Another one than before ends a
    /// calibration that runs.
    void use(const std::string& bench, std::shared_ptr<const Product> product);
    /// Shows a drive picture on the bench and photographs it from the audience's eye, where its
    /// highlights belong; the bench's own camera stands elsewhere and calibrates. The newest wins,
    /// and waits while the bench is being calibrated. `design_white_y` scales the photograph for
    /// looking at (0: by its own brightest). Throws std::invalid_argument before use() and without
    /// a picture.
    void photograph(std::uint64_t number,
                    std::shared_ptr<const Image8> drive,
                    const glm::dvec3& eye_mm,
                    double design_white_y);
    std::shared_ptr<const BenchPhotograph> newest_photograph() const;  ///< null: none yet

    struct Calibrating {
        bool running = false;
        double fraction = 0.0;  ///< of the stage
        std::string stage;
        std::string refused_why, refused_fix;           ///< after a refusal
        std::optional<std::filesystem::path> finished;  ///< the new calibration's folder
    };
    /// Nothing happens when one runs already. Throws std::invalid_argument before use().
    void start_calibration();
    void cancel_calibration();  ///< returns at once; running becomes false when it has stopped
    Calibrating calibrating() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
