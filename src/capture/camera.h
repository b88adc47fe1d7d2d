// A camera that the program has hold of: over a cable, as a video stream, or simulated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/bench_ports.h"
#include "core/error.h"
#include "core/progress.h"

namespace livery {

/// Why a camera did not do what it was asked for.
enum class CameraTrouble {
    gone,       ///< cable pulled, switched off, asleep: it may come back
    silent,     ///< it is there and does not answer in time
    held,       ///< another program has it
    card_full,  ///< nowhere to put a photograph
    refused,    ///< it says no: busy, no such setting, lens cap, no focus
    unusable,   ///< what it gave is no photograph that can be used
};

class CameraFault : public Refused {
  public:
    CameraFault(CameraTrouble trouble, std::string why, std::string fix)
        : Refused(std::move(why), std::move(fix)), trouble_(trouble) {}
    CameraTrouble trouble() const { return trouble_; }

  private:
    CameraTrouble trouble_;
};

/// One setting as the camera offers it.
struct CameraSetting {
    std::string name;                  ///< "exposure", "iso", "aperture", "format", "focus", ...
    std::string value;                 ///< in the camera's own words: "1/60", "RAW"
    std::vector<std::string> choices;  ///< empty: anything, or it cannot be set
    bool can_be_set = false;
};

struct CameraState {
    std::string model;  ///< in its own words; the same camera has it at every port
    std::vector<CameraSetting> settings;
    std::optional<double> battery;      ///< 0 to 1
    std::optional<int> shots_left;      ///< on its card
    std::vector<std::string> warnings;  ///< what would spoil photographs: automatic exposure, ...
};

/// All calls block, for as long as a deadline of the camera's own at most; one thread at a time.
/// They throw CameraFault; a camera that is `gone` is looked for anew by the next call.
class Camera {
  public:
    virtual ~Camera() = default;
    /// What to call it: "Nikon D7500 at usb:001,004".
    virtual std::string name() const = 0;
    virtual CameraState state() = 0;
    /// Chooses one of `choices`, or where there are none any value. Throws CameraFault `refused`
    /// where the camera has no such setting or value, or keeps another.
    virtual void set(const std::string& setting, const std::string& value) = 0;
    /// Photographs what is there now: TakePhotograph. The exposure that was really used stands in
    /// the photograph: the nearest that the camera has.
    virtual Photograph photograph(double exposure_s) = 0;
    /// How 8-bit numbers become light from here on: "srgb" unless said, "linear", or a response
    /// file's path. RAW has no curve. Throws FileError.
    virtual void use_transfer(const std::string& transfer) = 0;
    /// What it sees now, for looking at: sRGB, 3 channels. Empty where it cannot.
    virtual Image8 live_view() = 0;
};

/// The camera as a port. What somebody can put right in place (cable, power, another program, a
/// full card) is told to `on_wait` and tried again until it works, then told once more, or until a
/// stop is asked for (Cancelled). Other faults are thrown. `camera` must outlive the port.
TakePhotograph patient(Camera& camera, const Progress& progress, TellWait on_wait);

/// Seconds of a shutter speed as cameras write it: "1/60", "0.1000s", "0.4", "2\"". Negative:
/// "bulb", "auto" and what else is no time.
double seconds_of_shutter_speed(const std::string& text);

/// Of the dial.
bool is_manual(const std::string& program);
/// Of its files: RAW, alone or beside a JPEG.
bool is_raw_format(const std::string& format);
/// How long the shutter is open where the camera says this; negative: no time. The series 1/30,
/// 1/60, 1/125 is of exact halves (1/32, 1/64, 1/128), with thirds or halves of a stop between,
/// said in round numbers that are up to 7% off (ISO 516).
double open_time_s(const CameraSetting& exposure, const std::string& said);
/// The offered time nearest to this, in ratio; empty: it offers none.
std::string nearest_time(const CameraSetting& exposure, double seconds);

}  // namespace livery
