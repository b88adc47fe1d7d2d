// recording.json: what a recording's photographs are of. For the sources of this folder alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/recording.h"

namespace livery {

struct RecordingList {
    std::string bench;  ///< what all of it was taken with, in words
    std::vector<RecordedShowing> showings;
};

/// Throws FileError.
RecordingList parse_recording_list(const std::string& text, const std::filesystem::path& file);

/// Without showings that hold nothing; reading it back gives the same text.
std::string text_of(const RecordingList& list);

/// The number of the next photograph's file: above all that the files' names begin with.
int next_file_number(const std::vector<RecordedShowing>& showings);

}  // namespace livery
