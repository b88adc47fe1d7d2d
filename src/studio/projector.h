// The projector's side of the window: what the threads leave for the main one with the straight way
// of a finished frame to the projector, which monitor it is, what is shown on it instead of frames,
// and what the bar says of it: never that it shows what it does not.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "live/frame_thread.h"
#include "live/preview_thread.h"
#include "projection/projector_screen.h"
#include "studio/trace.h"

struct ImVec4;

namespace livery {

struct Studio;

/// Must outlive the threads that deliver; the projector must outlive the frame thread.
struct Results {
    explicit Results(std::shared_ptr<Trace> where_to) : trace_(std::move(where_to)) {}

    // On the threads that finished something.
    void take(std::shared_ptr<const FinishedFrame> finished);
    void take(std::shared_ptr<const PreviewPicture> finished);
    void shown(const ShownPicture& picture) const;

    // Main thread.
    void use(ProjectorScreen* screen);  ///< null: none
    /// Shown instead of the frames; none: the frames again.
    void show_instead(std::shared_ptr<const ProjectorPicture> picture);
    /// The newest frame could be on the projector, and is not yet.
    bool awaits_projector() const;
    std::shared_ptr<const FinishedFrame> newest_frame() const;  ///< with its problem, if it has one
    std::shared_ptr<const FinishedFrame> newest_drawn() const;  ///< the last that could be drawn
    std::shared_ptr<const PreviewPicture> newest_preview() const;
    void clear();  ///< with a context of the share group current

  private:
    void present_locked();

    std::shared_ptr<Trace> trace_;
    mutable std::mutex mutex_;
    ProjectorScreen* projector_ = nullptr;
    std::shared_ptr<const ProjectorPicture> instead_;
    std::shared_ptr<const FinishedFrame> frame_, drawn_;
    std::shared_ptr<const PreviewPicture> preview_;
};

// --- words ---

struct ProjectorWords {
    enum class Mood { quiet, good, warning, error };
    std::string text;
    Mood mood = Mood::quiet;
    std::string help = {};  ///< may be empty
};

/// What the projector shows in place of the frames.
struct ShownInstead {
    std::shared_ptr<const ProjectorPicture> picture;  ///< none: the frames
    std::string caption;   ///< the stage shows it too, with these words; empty: it does not
    ProjectorWords words;  ///< of the bar; empty: as of frames
};

struct ProjectorFacts {
    ProjectorScreen::State state = ProjectorScreen::State::off;
    std::string why_waiting;
    bool only_screen = false;  ///< the chosen one, which therefore stays dark
    bool black = false, frozen = false;
    bool monitor_numbers = false;  ///< shown instead
    ProjectorWords instead;        ///< what else is shown in place of frames; empty: nothing
    std::uint64_t wanted = 0;      ///< the newest frame that was asked for
    std::uint64_t shown = 0;       ///< the frame on the projector
    double waited_s = 0.0;         ///< since the wanted one was asked for
    std::string not_drawn;         ///< why there is no such frame
    std::string other_product;     ///< why its correction is wrong; empty: it is not
};

/// A frame may be on its way for so long before the bar speaks of it.
inline constexpr double kUnspokenWait_s = 0.25;

const ImVec4& colour_of(SignalWarning::Severity severity);
/// Of warnings and errors; notes are none.
long count_of_warnings(const std::vector<SignalWarning>& list);

ProjectorWords projector_words(const ProjectorFacts& facts);

// --- the monitor, and what goes to it ---

inline constexpr const char* kMonitorKey = "projector-monitor";  ///< in a session's workspace

/// An empty id: none. Remembered; throws nothing, says in a notice what is in the way.
void use_projector_monitor(Studio& studio, const std::string& id);
/// The monitors that there are, and which of them is the remembered projector.
void read_monitors(Studio& studio);
/// To be called when monitors came or went, and once at the start.
void monitors_changed(Studio& studio);
void check_projector_signal(Studio& studio);
void show_monitor_numbers(Studio& studio);
/// In place of the frames, until it is called again with nothing.
void show_instead(Studio& studio, ShownInstead instead);
/// The picture by which people see a limited-range signal, on the projector instead of the frames.
void show_signal_test(Studio& studio, bool shown);

void set_black(Studio& studio, bool black);
void set_frozen(Studio& studio, bool frozen);

ProjectorFacts projector_facts(const Studio& studio);

}  // namespace livery
