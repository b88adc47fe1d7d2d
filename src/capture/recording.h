// What a bench showed and what was photographed, kept as it happens: a run that was cut off goes on
// where it stopped, one picture can be taken again, and all of it can be gone through later.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/bench_ports.h"

namespace livery {

struct RecordedPhotograph {
    std::string file;      ///< in the recording's folder
    std::string of;        ///< what it was to show, in the words of the calibration
    double asked_s = 0.0;  ///< exposure asked for; 0: the camera's last
    double exposure_s = 0.0, black_level = 0.0;
    double saturates_at = 0.0;  ///< infinity: nowhere
};

/// One picture as long as it was shown.
struct RecordedShowing {
    std::string picture;  ///< hash of the device values; empty: what was there before the first
    std::vector<RecordedPhotograph> photographs;
    std::vector<std::pair<glm::dvec2, glm::dvec3>> measured;  ///< places and XYZ of a colorimeter
};

/// A folder with `recording.json` and the photographs: each file as the camera gave it, or an EXR
/// of its numbers. A photograph is on the disk before the one after the next is taken, so a program
/// that is killed loses one at most. showings() may be called from any thread, everything else by
/// one.
class Recording {
  public:
    /// Goes on with the one in the folder, or begins one. `bench`: what all of it must be of, in
    /// words (projector, camera). Throws FileError, and Refused where the folder's is of another.
    Recording(std::filesystem::path folder, std::string bench);
    ~Recording();
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    /// `bench`'s ports, answered from the recording as far as it reaches: a run that asks the same
    /// again comes to where the last one stopped without a photograph. Pictures that are shown
    /// anew in the middle are waited for as long as the slowest projector needs. With an empty
    /// `bench.photograph` it is a replay: what is not there is a FileError. A bench with `turn_to`
    /// needs no recording: std::invalid_argument.
    BenchPorts ports(const BenchPorts& bench);

    /// Told of each photograph of a run as it comes, from the camera or from the folder, with the
    /// place of its showing in showings(); on the run's thread.
    void tell(std::function<void(std::size_t showing, const Photograph&)> on_photograph) {
        on_photograph_ = std::move(on_photograph);
    }
    const std::string& announced() const { return announced_; }  ///< what the run asked for last

    /// Writes manifest.json beside the photographs: those of `kept` (role and file of each) become
    /// a captures folder that anybody's program can read (docs/files.md). Throws FileError.
    void write_manifest(int projector_width,
                        int projector_height,
                        const std::vector<std::pair<std::string, std::string>>& kept);
    /// The next run photographs this one anew. Throws std::invalid_argument.
    void take_again(std::size_t showing);
    /// Forgets the photographs of so many pictures of the run, from the one that is shown back:
    /// nobody knows what they are of. Throws FileError.
    void drop_newest(int pictures);
    /// Forgets the photograph that was taken last by this object's run, if any: what it showed is
    /// taken again. Throws FileError.
    void drop_last();
    std::vector<RecordedShowing> showings() const;
    /// Photographs that were taken by this object, and that were answered from the folder.
    int taken() const { return taken_; }
    int answered() const { return answered_; }
    const std::filesystem::path& folder() const { return folder_; }
    /// Waits until everything is on the disk. Throws FileError.
    void flush();

  private:
    void show(const Image8& drive);
    void turn_to(const std::string& picture);
    Photograph photograph(double asked_s);
    glm::dvec3 measure(glm::dvec2 pixel);
    Photograph take(double asked_s);
    void bring_up(double asked_s);
    void keep(Photograph& photograph, double asked_s);
    void read(const std::filesystem::path& file);
    void write(std::function<void()> first);

    std::filesystem::path folder_;
    std::string bench_words_, announced_;
    std::function<void(std::size_t, const Photograph&)> on_photograph_;
    BenchPorts bench_;
    mutable std::mutex mutex_;  ///< held to change showings_
    std::vector<RecordedShowing> showings_;
    std::vector<std::size_t> places_;   ///< of the run's showings so far, ascending
    std::optional<std::size_t> place_;  ///< of the showing now; none: nothing is shown yet
    Image8 drive_;                      ///< what the run takes to be shown
    std::string shown_;                 ///< what really is: a hash; empty: nothing is known
    std::size_t next_ = 0;              ///< of the showing's photographs
    std::size_t measured_ = 0;          ///< of its measurements
    std::string last_taken_;            ///< file of this run's newest photograph
    int taken_ = 0, answered_ = 0, files_ = 0;
    std::future<void> writing_;
};

}  // namespace livery
