// Photographing with a camera on a thread of its own: live view, preflight, and the capture of a
// calibration, kept as it happens.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/correspondence/patterns.h"
#include "core/bench_ports.h"
#include "core/grade.h"
#include "core/image.h"
#include "core/progress.h"
#include "gl/context.h"
#include "jobs/capture_bench.h"
#include "scene/data_sheet.h"
#include "scene/product.h"
#include "scene/view.h"

namespace livery {

/// What is photographed, and with what. A simulated bench has its own projector and pose.
struct CaptureSetup {
    CameraChoice camera;
    std::shared_ptr<const Product> product;
    std::string projector;               ///< its name, in words; empty: none is chosen
    int width = 0, height = 0;           ///< its pixels
    std::optional<View> projector_view;  ///< where it stands, if that is known
    /// Where it is not: what tells it with the photographs. A simulated bench has its own.
    std::optional<DataSheets> data_sheets;
    int colour_shots = 2;                ///< photographs of each colour picture
    PlaceCode places = PlaceCode::gray;  ///< what is shown to find where the camera sees pixels
    std::filesystem::path in_use;        ///< a calibration to compare with; empty: none
    /// Shows on it, on the capture's thread with its context current.
    std::function<ShowPicture(const Progress&, TellWait)> projector_port;
};

/// A picture that was photographed.
struct CaptureTile {
    std::string of;                      ///< "gray-column-3"
    std::shared_ptr<const Image8> seen;  ///< small, sRGB
    int photographs = 0;
};

/// Brightness of a photograph's pixels, of full scale.
struct CaptureHistogram {
    std::array<float, 64> share{};  ///< the largest but black's is 1
    double clipped = 0.0;           ///< of all pixels, in any channel
};

/// The steps to a calibration, in their order.
enum class CaptureStep { look, geometry, colour, check };
inline constexpr int kCaptureSteps = 4;

struct CaptureStepView {
    bool called_for = true;  ///< as things are; the geometry is not where the pose is known
    bool done = false;
    bool can_go_on = false;  ///< one that was stopped lies there
    std::vector<GradedFigure> figures;
    double seconds = 0.0;     ///< that it took
    double expected_s = 0.0;  ///< that it will take by the photographs so far; 0: nobody knows
    std::shared_ptr<const Image8> finding;  ///< sRGB: what it found, marked; null: nothing to see
    std::string finding_of;                 ///< what that shows
};

/// What it does now and what came of it.
struct CaptureView {
    enum class Doing { nothing, opening, watching, preflight, fitting, capturing, checking };
    Doing doing = Doing::nothing;
    std::string camera;  ///< its name; empty: none is open
    std::vector<CameraSetting> settings;
    std::vector<std::string> warnings;  ///< of the camera
    bool has_live_view = true;          ///< as far as is known
    bool may_have_curve = false;        ///< its files may be of 8 bits
    std::string curve;                  ///< what they are read with, in words
    double fraction = 0.0;
    std::string stage;
    double elapsed_s = 0.0;
    std::optional<double> remaining_s;
    bool paused = false;
    bool waits_for_next = false;  ///< somebody shoots by hand, and says when
    std::string found_before;     ///< in the folder of a capture by hand, in words
    CaptureWait wait;             ///< what it waits for; empty: nothing
    std::string why, fix;         ///< why the last thing that was asked for failed
    std::array<CaptureStepView, kCaptureSteps> steps;
    CaptureStep doing_step = CaptureStep::look;  ///< while it is busy
    /// Of the calibration that came of it against the one in use, and of the bench against how that
    /// one left it.
    std::vector<GradedFigure> compared, drift;
    /// Of a mock-up that was found again, and the calibration in use as carried along with it.
    std::vector<GradedFigure> found_again;
    std::optional<std::filesystem::path> reposed;
    std::shared_ptr<const Image8> live, shown;  ///< sRGB; device values, small
    std::vector<CaptureTile> tiles;             ///< by showing
    CaptureHistogram histogram;                 ///< of the newest photograph or live view
    int taken = 0, kept_from_before = 0;
    /// Of the finished capture's geometry and colours, each from its start to its last photograph,
    /// and what of it was waiting for the camera and for the projector.
    double capture_s = 0.0, camera_s = 0.0, projector_s = 0.0;
    std::optional<std::filesystem::path> finished;  ///< the calibration that came of it

    CaptureStepView& step(CaptureStep which) { return steps[static_cast<std::size_t>(which)]; }
    const CaptureStepView& step(CaptureStep which) const {
        return steps[static_cast<std::size_t>(which)];
    }
};

class CaptureThread {
  public:
    /// A context of the share group, current nowhere; it must outlive this. `on_change` is called
    /// on the capture's thread and must not throw.
    CaptureThread(GlContext& context, std::function<void()> on_change);
    ~CaptureThread();
    CaptureThread(const CaptureThread&) = delete;
    CaptureThread& operator=(const CaptureThread&) = delete;

    /// Opens that camera (for a live view) in place of the one before; stops what runs. The same
    /// camera stays open, and what does not follow from what has changed is kept.
    void use(CaptureSetup setup);
    void close();  ///< lets the camera go
    /// Sets the camera: CameraState::settings.
    void set(const std::string& setting, const std::string& value);
    /// Fits the curve of a camera that gives no RAW, and keeps it for its model.
    void start_curve_fit();
    /// Goes on with what was stopped, unless `anew`, which forgets the step and what follows.
    void start(CaptureStep step, bool anew);
    /// Compares the bench with how that calibration left it.
    void look_for_drift(std::filesystem::path calibration);
    /// Finds a mock-up that was bumped, with two photographs, and carries that calibration along.
    void find_mockup_again(std::filesystem::path calibration);
    void take_again(std::size_t showing);  ///< at once while it captures, else goes on with that
    void set_paused(bool paused);          ///< before the next picture
    void next();                           ///< the picture by hand was taken
    void cancel();                         ///< returns at once
    CaptureView view() const;

    /// Where the photographs lie that are taken with this camera and projector.
    static std::filesystem::path folder(const std::string& made_with);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
