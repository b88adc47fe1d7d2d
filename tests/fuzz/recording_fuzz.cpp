#include "capture/recording_list_io.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const RecordingList list = parse_recording_list(text, "recording.json");
    const std::string written = text_of(list);
    fuzz::require(text_of(parse_recording_list(written, "again")) == written,
                  "what is written is read");
    fuzz::require(next_file_number(list.showings) >= 0, "photographs are numbered from 0");
}
