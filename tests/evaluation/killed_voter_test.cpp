// A program killed in the middle of voting, at moments that nobody chose.

#include <array>
#include <csignal>
#include <cstdio>
#include <set>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/random.h"
#include "evaluation/ballots.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// Votes without end, and writes the number of each ballot to `confirmed` once it is cast.
[[noreturn]] void vote_for_ever(const std::filesystem::path& file,
                                int round,
                                int first,
                                int confirmed) {
    try {
        BallotStore store(file);
        for (int number = first;; ++number) {
            store.vote(round, "voter " + std::to_string(number), {number % 4, (number + 1) % 4});
            if (::write(confirmed, &number, sizeof number) != sizeof number) ::_exit(3);
        }
    } catch (...) {
        ::_exit(4);
    }
}

TEST(KilledVoter, NoConfirmedVoteIsLost) {
    const TemporaryFolder folder;
    const auto file = folder / "votes";
    const int round = BallotStore(file).open_round({"a", "b", "c", "d"}, "");
    Random random(20261121);
    std::set<int> confirmed;
    int first = 0;
    for (int kill = 0; kill < 25; ++kill) {
        std::array<int, 2> pipe{};
        ASSERT_EQ(::pipe(pipe.data()), 0);
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            ::close(pipe[0]);
            vote_for_ever(file, round, first, pipe[1]);
        }
        ::close(pipe[1]);
        // Any number of votes, then a moment within the next one; sometimes while still opening.
        const auto votes = static_cast<int>(random.uniform() * 8.0);
        int number = 0;
        for (int k = 0; k < votes; ++k) {
            ASSERT_EQ(::read(pipe[0], &number, sizeof number), ssize_t{sizeof number});
            confirmed.insert(number);
        }
        std::this_thread::sleep_for(
            std::chrono::microseconds(static_cast<int>(random.uniform() * 4000.0)));
        ASSERT_EQ(::kill(child, SIGKILL), 0);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status)) << "it stopped by itself: " << WEXITSTATUS(status);
        while (::read(pipe[0], &number, sizeof number) == ssize_t{sizeof number}) {
            confirmed.insert(number);
        }
        ::close(pipe[0]);

        const BallotStore store(file);  // checks the log
        std::set<int> found;
        const auto seats = store.seats(1);
        for (const int seat : store.voted(round)) {
            found.insert(std::stoi(seats.at(static_cast<std::size_t>(seat) - 1).name.substr(6)));
        }
        for (const int voter : confirmed) EXPECT_TRUE(found.contains(voter)) << voter;
        // At most the one that was on its way.
        EXPECT_LE(found.size(), confirmed.size() + 1) << "kill " << kill;
        confirmed = found;
        first = found.empty() ? 0 : *found.rbegin() + 1;
    }
    EXPECT_GT(confirmed.size(), 25u);
    BallotStore store(file);
    EXPECT_EQ(store.open_round().value().ballots, static_cast<int>(confirmed.size()));
}

}  // namespace
}  // namespace livery
