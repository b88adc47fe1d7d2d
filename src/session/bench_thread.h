// The simulated bench on a thread of its own: its photograph of the mock-up, and its calibration.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/image.h"
#include "scene/product.h"

namespace livery {

struct BenchPhotograph {
    std::uint64_t number = 0;  ///< of the frame that it shows
    Image8 srgb;               ///< 3 channels, cropped to the mock-up
    double seconds = 0.0;
    std::string problem;
};

class BenchThread {
  public:
    explicit BenchThread(std::function<void()> on_change);  ///< called on the bench's thread
    ~BenchThread();
    BenchThread(const BenchThread&) = delete;
    BenchThread& operator=(const BenchThread&) = delete;

    /// Which bench with which mock-up; traced when first needed.
    void use(const std::string& bench, std::shared_ptr<const Product> product);
    /// Shows a drive picture on the bench and photographs it; the newest wins. `design_white_y`
    /// scales the photograph for looking at (0: by its own brightest).
    void photograph(std::uint64_t number,
                    std::shared_ptr<const Image8> drive,
                    double design_white_y);
    std::shared_ptr<const BenchPhotograph> newest_photograph() const;

    struct Calibrating {
        bool running = false;
        double fraction = 0.0;
        std::string stage;
        std::string refused_why, refused_fix;           ///< after a refusal
        std::optional<std::filesystem::path> finished;  ///< the new calibration's folder
    };
    void start_calibration();
    void cancel_calibration();
    Calibrating calibrating() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
