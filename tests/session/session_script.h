// A session's life as a script: the same seed gives the same steps, on any session.
#pragma once

#include <cstdint>

#include "session/session.h"
#include "session/some_commands.h"

namespace livery::testing {

/// The `number`th step on a session: mostly a command, now and then undo and redo. A command that
/// is refused changes nothing.
inline void take_step(Session& session, std::uint64_t seed, std::uint64_t number) {
    Random random(seed, number);
    const std::uint32_t kind = random.below(10);
    if (kind == 0) {
        session.undo();
    } else if (kind == 1) {
        session.redo();
    } else {
        try {
            session.execute(random_command(random, session.document()));
        } catch (const std::invalid_argument&) {
        }
    }
}

/// Everything that can be told apart about two sessions.
inline std::string state_of(const Session& session) {
    return text_of(session.document()) + "\nundo " + session.undo_label() + "\nredo " +
           session.redo_label();
}

}  // namespace livery::testing
