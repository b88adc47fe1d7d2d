#include "core/worker.h"

#include <algorithm>
#include <deque>
#include <future>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace livery {
namespace {

struct Jobs {
    std::optional<int> newest;
    std::deque<int> queue;
    std::vector<int> done;
};

using Numbers = Worker<Jobs>;

/// Of the newest first, then of the queue; number 1 is held until `gate` opens.
Numbers::Turn take(Jobs& jobs, Numbers& worker, const std::shared_future<void>& gate) {
    std::optional<int> number = std::exchange(jobs.newest, std::nullopt);
    if (!number && !jobs.queue.empty()) {
        number = jobs.queue.front();
        jobs.queue.pop_front();
    }
    if (!number) return {};
    return {[&worker, gate, number = *number] {
        if (number == 1) gate.wait();
        worker.change([&](Jobs& after) { after.done.push_back(number); });
    }};
}

TEST(Worker, NewestReplacesWhatWaitsAndAQueueKeepsItsOrder) {
    std::promise<void> gate;
    const std::shared_future<void> opened = gate.get_future().share();
    Numbers worker;
    worker.start([&] { worker.serve([&](Jobs& jobs) { return take(jobs, worker, opened); }); });
    worker.change([](Jobs& jobs) { jobs.queue = {1}; });
    while (worker.use([](const Jobs& jobs) { return !jobs.queue.empty(); })) {
        std::this_thread::yield();  // until number 1 runs
    }
    worker.change([](Jobs& jobs) { jobs.queue = {4, 5}; });
    worker.change([](Jobs& jobs) { jobs.newest = 2; });
    worker.change([](Jobs& jobs) { jobs.newest = 3; });
    gate.set_value();
    worker.wait([](const Jobs& jobs) { return jobs.done.size() == 4; });
    EXPECT_EQ(worker.use([](const Jobs& jobs) { return jobs.done; }),
              (std::vector<int>{1, 3, 4, 5}));
}

TEST(Worker, AsksAgainAtTheTimeThatItsTurnNames) {
    Numbers worker;
    std::optional<Numbers::Clock::time_point> due;
    worker.start([&] {
        worker.serve([&](Jobs& jobs) -> Numbers::Turn {
            if (!jobs.done.empty()) return {};
            if (!due) due = Numbers::Clock::now() + std::chrono::milliseconds(20);
            if (Numbers::Clock::now() < *due) return {{}, due};
            return {[&] { worker.change([](Jobs& after) { after.done.push_back(7); }); }};
        });
    });
    worker.wait([](const Jobs& jobs) { return !jobs.done.empty(); });
    EXPECT_GE(Numbers::Clock::now(), *due);
}

TEST(Worker, WhatAJobThrowsReachesTheBodyOfItsThread) {
    std::string problem;
    Numbers worker;
    worker.start([&] {
        try {
            worker.serve([](Jobs&) -> Numbers::Turn {
                return {[] { throw std::runtime_error("no ink"); }};
            });
        } catch (const std::runtime_error& error) {
            problem = error.what();
        }
    });
    worker.join();
    EXPECT_EQ(problem, "no ink");
}

TEST(Worker, BeginsNothingOnceItIsStoppedAndTellsTheJobThatRuns) {
    Numbers worker;
    std::promise<void> began;
    worker.start([&] {
        worker.serve([&](Jobs& jobs) -> Numbers::Turn {
            if (!jobs.newest) return {};
            return {[&] {
                worker.use([](Jobs& after) { after.done.push_back(1); });
                began.set_value();
                while (!*worker.stopping()) std::this_thread::yield();
            }};
        });
    });
    worker.change([](Jobs& jobs) { jobs.newest = 1; });  // never taken: it would run again
    began.get_future().wait();
    worker.stop();
    worker.join();
    EXPECT_EQ(worker.use([](const Jobs& jobs) { return jobs.done.size(); }), 1U);
}

TEST(Worker, SeveralThreadsShareOneStateWithoutLosingAJob) {
    constexpr int kJobs = 2000;
    std::promise<void> gate;
    gate.set_value();
    const std::shared_future<void> opened = gate.get_future().share();
    Numbers worker;
    for (int k = 0; k < 3; ++k) {
        worker.start([&] { worker.serve([&](Jobs& jobs) { return take(jobs, worker, opened); }); });
    }
    for (int k = 0; k < kJobs; ++k) worker.change([&](Jobs& jobs) { jobs.queue.push_back(k); });
    worker.wait([](const Jobs& jobs) { return jobs.done.size() == kJobs; });
    auto done = worker.use([](const Jobs& jobs) { return jobs.done; });
    std::sort(done.begin(), done.end());
    for (int k = 0; k < kJobs; ++k) ASSERT_EQ(done[static_cast<std::size_t>(k)], k);
}

}  // namespace
}  // namespace livery
