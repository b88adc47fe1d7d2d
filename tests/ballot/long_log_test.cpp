// A log as long as a room of phones that change their minds all day can make it.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include <gtest/gtest.h>

#include "ballot/ballot_guard.h"
#include "ballot/ballot_service.h"
#include "support/temporary_folder.h"
#include "support/thorough.h"

namespace livery {
namespace {

constexpr int kSeats = 40;
constexpr std::int32_t kApplicationId = 0x4c765642;

TEST(LongLog, OpensInTheServersMemory) {
    // Where whole logs were read into memory, 65,000 were too many.
    const int changes = thorough() ? 200'000 : 70'000;
    const TemporaryFolder folder;
    const auto file = folder / "ballots.sqlite";
    {
        BallotStore store(file);
        RoundSetup setup;
        setup.designs = {"a", "b", "c", "d"};
        const int round = store.open_round(setup);
        for (int k = 0; k < kSeats; ++k) {
            store.vote(round, "evaluator " + std::to_string(k), {0, 1});
        }
        // What a vote records, without what it checks: a minute less.
        Database database(file, Database::Mode::existing, kApplicationId, 5, ballots_schema());
        LogSeal end = seal_of(database);
        Transaction transaction(database);
        for (int k = 0; k < changes; ++k) {
            const int best = k / kSeats % 4;
            LogEntry entry{1,
                           round,
                           "2026-01-01T00:00:00Z",
                           LogEntry::Vote{1 + k % kSeats, {best, (best + 1) % 4}}};
            append_to_log(database, end, entry);
        }
        transaction.commit();
        store.close_round(round);
    }
    // As livery-ballots does, within its 64 MiB.
    EXPECT_EXIT(
        {
            limit_this_process();
            BallotService service(file, {{false, {"127.0.0.1:8470"}}, kSeats});
            std::exit(service.store().rounds().at(0).ballots == kSeats ? 0 : 1);
        },
        ::testing::ExitedWithCode(0),
        "");
    const std::clock_t begin = std::clock();
    const BallotStore store(file);
    const double took_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    std::printf("%d entries open in %.2f s of the processor\n", changes, took_s);
    int counted = 0;
    for (const int best : store.tally(1).best) counted += best;
    EXPECT_EQ(counted, kSeats);
}

}  // namespace
}  // namespace livery
