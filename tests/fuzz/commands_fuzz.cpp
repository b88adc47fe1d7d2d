#include "fuzz/fuzz.h"
#include "session/commands.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const SessionCommand command = parse_session_command(text, "--command");
    const std::string written = text_of(command);
    fuzz::require(text_of(parse_session_command(written, "again")) == written,
                  "what is written is read");
}
