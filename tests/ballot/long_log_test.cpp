// A log as long as a room of phones that change their minds all day can make it.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "ballot/ballot_service.h"
#include "ballot/process_limits.h"
#include "evaluation/ballot_tables.h"
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
            store.vote(round, {"evaluator " + std::to_string(k), 0, 1});
        }
        // What a vote records, without what it checks: a minute less.
        Database database(file, Database::Mode::existing, kApplicationId, 4, ballots_schema());
        Transaction transaction(database);
        for (int k = 0; k < changes; ++k) {
            const int best = k / kSeats % 4;
            record(database,
                   {.what = LogEntry::What::vote,
                    .session = 1,
                    .round = round,
                    .seat = 1 + k % kSeats,
                    .at = "2026-01-01T00:00:00Z",
                    .best = best,
                    .second = (best + 1) % 4});
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
    const auto begin = std::chrono::steady_clock::now();
    const BallotStore store(file);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::printf("%d entries open in %.2f s\n", changes, took.count());
    int counted = 0;
    for (const int best : store.tally(1).best) counted += best;
    EXPECT_EQ(counted, kSeats);
}

}  // namespace
}  // namespace livery
