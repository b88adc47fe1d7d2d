// Photographs of any camera, copied into a folder: "shoot these 50, copy them here".
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "calibration/captures/identify.h"
#include "calibration/correspondence/patterns.h"
#include "capture/captures_folder.h"
#include "core/bench_ports.h"
#include "core/pictures/exposure_settings.h"
#include "core/progress.h"

namespace livery {

/// What has come so far, for people.
struct WatchedState {
    std::size_t wanted = 0, found = 0;
    std::size_t files = 0;             ///< photographs that could be read
    std::vector<std::string> missing;  ///< roles without a photograph; while few have come: empty
    struct Odd {
        std::string file, why;
        bool operator==(const Odd&) const = default;
    };
    std::vector<Odd> odd;  ///< files without a role, and files that cannot be read, with the reason
    /// Files that were exposed otherwise than most, by as many stops more: they are not used, for
    /// their camera changes between the pictures what is to be compared.
    struct OtherExposure {
        std::string file;
        double stops = 0.0;
        bool operator==(const OtherExposure&) const = default;
    };
    std::vector<OtherExposure> exposed_otherwise;
    /// Files that show a picture whose turn it was not: they are used.
    struct OutOfOrder {
        std::string file, role;
        bool operator==(const OutOfOrder&) const = default;
    };
    std::vector<OutOfOrder> out_of_order;
    ExposureSettings usual_exposure;  ///< of most files; nothing where none says how
    bool complete = false;
    bool operator==(const WatchedState&) const = default;
};
/// "48 of 50 photographs; missing: gray-row-3-inverse; IMG_0031.NEF shows the same as ...", and
/// what to do where the camera's automatic was on.
std::string text_of(const WatchedState& state);

class WatchedCaptures {
  public:
    /// `roles` in the order in which the pictures are shown. Throws FileError for no folder.
    WatchedCaptures(std::filesystem::path folder, std::vector<std::string> roles);

    /// Reads what has come since the last look: a file is read once it has not grown for one look,
    /// again when it is replaced, and forgotten when it is removed. True when the state changed.
    bool look();
    const WatchedState& state() const { return state_; }
    struct FoundBefore {
        std::vector<Pattern> still_to_shoot;
        std::string words;  ///< for people; empty where the folder was
    };
    /// Which of the roles' pictures are still to be photographed. Photographs that are there are
    /// used where most of the pictures are among them, else they are passed over from now on.
    FoundBefore look_at_what_is_there(std::vector<Pattern> patterns);

    /// A camera that knows nothing of pictures but their roles (`turn_to`), which waits for all of
    /// them: `on_state` is called after every look that changed anything. Throws Cancelled.
    BenchPorts ports(const Progress& progress, std::function<void(const WatchedState&)> on_state);
    /// The photographs as a captures folder, exposed as they say or, where one does not, for one
    /// second each. Call it when the state is complete.
    CapturesFolder captures(int projector_width, int projector_height) const;

  private:
    struct File {
        std::uintmax_t size = 0;
        std::filesystem::file_time_type time{};
        bool read = false;
        std::string bytes_hash, problem;
        ExposureSettings settings;
        Glimpse glimpse;
    };
    using NamedFile = std::pair<const std::string, File>;
    void read(const std::filesystem::path& path, File& file);
    /// In the order of their names; `state` gets what is wrong with the others.
    std::vector<const NamedFile*> comparable_files(WatchedState& state) const;
    void identify_all();

    std::filesystem::path folder_;
    std::vector<std::string> roles_;
    std::map<std::string, File> files_;      ///< by name
    std::vector<std::string> file_of_role_;  ///< empty: none
    std::set<std::string> from_before_;      ///< names of files that are passed over
    WatchedState state_;
};

}  // namespace livery
