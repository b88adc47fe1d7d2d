// Killed at any moment: what execute() returned from is there, and the file is whole.

#include <csignal>
#include <cstdio>
#include <iostream>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "session/session_file.h"
#include "session/session_script.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::state_of;
using testing::take_step;

constexpr std::uint64_t kKillSeed = 20;

/// Runs the writer from step `first` on, and kills it `delay_us` after it told of `least` steps (or
/// that it is open). Returns the steps that it told of, -1: it was not open yet.
int killed_after(const std::filesystem::path& file,
                 std::uint64_t first,
                 int least,
                 useconds_t delay_us) {
    int pipe_ends[2];
    if (::pipe(pipe_ends) != 0) throw std::runtime_error("no pipe");
    const std::string seed = std::to_string(kKillSeed), step = std::to_string(first);
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(pipe_ends[1], STDOUT_FILENO);
        ::close(pipe_ends[0]);
        ::close(pipe_ends[1]);
        ::execl(LIVERY_SESSION_WRITER,
                LIVERY_SESSION_WRITER,
                file.c_str(),
                seed.c_str(),
                step.c_str(),
                nullptr);
        ::_exit(127);
    }
    ::close(pipe_ends[1]);
    int told = 0;
    char byte = 0;
    while (told <= least && ::read(pipe_ends[0], &byte, 1) == 1) ++told;
    ::usleep(delay_us);
    ::kill(child, SIGKILL);
    while (::read(pipe_ends[0], &byte, 1) == 1) ++told;
    ::close(pipe_ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << "it ended by itself";
    return told - 1;
}

TEST(KilledSession, LosesNoCommandThatWasDone) {
    const TemporaryFolder folder;
    const auto file = folder / "Sitzung.livery";
    // The same steps on a session that is never killed.
    Session model = Session::unsaved(testing::car(), "a model");
    Random random(kKillSeed);
    std::uint64_t next = 0;
    int between = 0;
    for (int kill = 0; kill < 20; ++kill) {
        const int least = static_cast<int>(random.below(15));
        const int told = killed_after(file, next, least, random.below(8000));
        ASSERT_GE(told, least);
        for (int k = 0; k < told; ++k) take_step(model, kKillSeed, next++);
        ASSERT_NO_THROW(SessionFile(file, SessionFile::Access::read).check_all());
        const Session session = Session::open(file);
        if (state_of(session) != state_of(model)) {
            // On disk, and killed before it could tell.
            take_step(model, kKillSeed, next++);
            ++between;
        }
        ASSERT_EQ(state_of(session), state_of(model)) << "after kill " << kill;
    }
    Session session = Session::open(file);
    while (model.can_undo()) {
        ASSERT_TRUE(session.can_undo());
        session.undo();
        model.undo();
        ASSERT_EQ(state_of(session), state_of(model));
    }
    EXPECT_FALSE(session.can_undo());
    std::cout << "    seed " << kKillSeed << ": " << next << " steps, 20 kills, " << between
              << " between disk and telling\n";
}

TEST(KilledSession, IsWholeOrNotThereWhenKilledWhileItIsMade) {
    for (int kill = 0; kill < 12; ++kill) {
        const TemporaryFolder folder;
        const auto file = folder / "new.livery";
        killed_after(file, 0, -1, static_cast<useconds_t>(kill) * 6000);
        const Session session = Session::open(file);
        EXPECT_EQ(session.document().looks.empty(), false);
    }
}

}  // namespace
}  // namespace livery
