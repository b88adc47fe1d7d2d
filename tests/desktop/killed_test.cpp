// Kills the program at random moments while changes are made in its window: nothing that it had
// done is lost.

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "desktop/two_monitors.h"
#include "session/session.h"

namespace livery {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr int longest_life_ms = 1500;
constexpr int fewest_asked = 3;  ///< changes in a life, also where everything is slow
constexpr unsigned seed = 17;

/// In a usual run; LIVERY_KILLS asks for more.
int kills() {
    const char* asked = std::getenv("LIVERY_KILLS");
    return asked ? std::stoi(asked) : 8;
}

std::string state_of(const Session& session) {
    return text_of(session.document()) + "\n undo: " + session.undo_label() +
           "\n redo: " + session.redo_label();
}

/// The changes that the program's log tells of, in order, as functions of a session.
std::vector<std::function<void(Session&)>> changes_in_log(const fs::path& log) {
    std::vector<std::function<void(Session&)>> changes;
    std::ifstream stream(log);
    for (std::string line; std::getline(stream, line);) {
        const auto after = [&](const std::string& mark) -> std::optional<std::string> {
            const auto at = line.find(mark);
            if (at == std::string::npos) return std::nullopt;
            return line.substr(at + mark.size());
        };
        if (const auto command = after(" command: ")) {
            changes.push_back([command = parse_session_command(*command, "log")](Session& session) {
                session.execute(command);
            });
        } else if (after(" undo: ")) {
            changes.push_back([](Session& session) { session.undo(); });
        } else if (after(" redo: ")) {
            changes.push_back([](Session& session) { session.redo(); });
        }
    }
    return changes;
}

class Killed : public TwoMonitors {
  protected:
    /// Something that a designer does, and does quickly.
    void change_something(std::mt19937& random);
};

void Killed::change_something(std::mt19937& random) {
    const auto one_of = [&](const std::vector<std::string>& choices) {
        return choices[std::uniform_int_distribution<std::size_t>(0, choices.size() - 1)(random)];
    };
    const auto paints = program->items_starting_with("paint:");
    switch (std::uniform_int_distribution<int>(0, 5)(random)) {
        case 0:
            desktop->press_key("ctrl+z");
            break;
        case 1:
            desktop->press_key("ctrl+y");
            break;
        case 2:
            desktop->press_key(one_of({"ctrl+d", "Delete", "1", "2", "3"}));
            break;
        default:
            if (paints.empty()) return;
            // Not waiting for what comes of it: it may be killed in the midst of that.
            const glm::ivec2 at = middle(program->item(one_of(paints)));
            desktop->click(at.x, at.y);
    }
}

TEST_F(Killed, AtRandomMomentsItLosesNothing) {
    std::cout << "seed " << seed << std::endl;
    std::mt19937 random(seed);
    start();
    studio->program.reset();
    const fs::path file = studio->session_file(), copy = studio->folder / "copy.livery";
    // Its log is read: nobody else's lines may be in it.
    ::setenv("LIVERY_HOME", (studio->folder / "home").c_str(), 1);
    const fs::path log = user_folder() / "log" / "livery.log";
    std::size_t done = 0;
    const int rounds = kills();
    for (int i = 0; i < rounds; ++i) {
        fs::copy_file(file, copy, fs::copy_options::overwrite_existing);
        fs::remove(log);
        start_program();
        const auto before = program->state("revision").get<std::uint64_t>();
        program->click("part:body");
        const auto end = std::chrono::steady_clock::now() +
                         std::chrono::milliseconds(
                             std::uniform_int_distribution<int>(0, longest_life_ms)(random));
        for (int asked = 0; asked < fewest_asked || std::chrono::steady_clock::now() < end;
             ++asked) {
            change_something(random);
        }
        program->process().send(SIGKILL);
        ASSERT_EQ(program->process().wait(10s), 128 + SIGKILL) << program->words();

        // What it reported as done is there. It may have died between doing and reporting.
        std::uint64_t revision = before;
        for (const TraceLine& line : program->trace()) {
            if (line.event == "commit") revision = line.number;
        }
        const auto reported = static_cast<std::size_t>(revision - before);
        const auto changes = changes_in_log(log);
        ASSERT_GE(changes.size(), reported);
        // Never less than what it reported, and nothing but what was asked of it.
        const std::string found = state_of(Session::open(file));
        Session reference = Session::open(copy);
        for (std::size_t j = 0; j < reported; ++j) changes[j](reference);
        std::size_t more = reported;
        while (state_of(reference) != found && more < changes.size()) changes[more++](reference);
        if (state_of(reference) != found) {
            // Killed between saving a change and saying so: one more is there.
            Session after = Session::open(file);
            after.undo();
            ASSERT_EQ(text_of(after.document()), text_of(reference.document()))
                << "kill " << i << ": " << reported << " of " << changes.size() << " reported";
        }
        done += reported;
    }
    EXPECT_GT(done, static_cast<std::size_t>(rounds)) << "too little happened for a test";
    std::cout << done << " changes" << std::endl;

    // And the window is as it was: what it shows is what the file says. Where undo went back to
    // before the first calibration, there is nothing to correct with.
    {
        Session session = Session::open(file);
        if (session.document().calibration.empty()) {
            session.execute(SetCalibration{studio->document.calibration});
        }
        document = session.document();
    }
    start_program();
    pick_projector();
    const int look = program->state("shown_look").get<int>();
    EXPECT_TRUE(projector_shows(expected_drive(document, look)));
    EXPECT_EQ(program->state("looks"), document.looks.size());
}

}  // namespace
}  // namespace livery
