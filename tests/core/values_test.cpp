// Hashes, random numbers, parallel loops, order statistics and the worst of errors.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/hash.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {
namespace {

TEST(WorstError, IsWhatIsNoNumber) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(worse_of(0.25, 0.5), 0.5);
    EXPECT_EQ(worse_of(0.5, 0.25), 0.5);
    EXPECT_EQ(worse_of(0.5, kNan), kInf);
    EXPECT_EQ(worse_of(kNan, 0.5), kInf);
    EXPECT_EQ(worse_of({0.1, kNan, 0.2}), kInf);
    EXPECT_EQ(worse_of({-3.0, -2.0}), -2.0);
    EXPECT_EQ(worst_if_nan(-1.5f), -1.5f);
    EXPECT_EQ(worst_if_nan(std::numeric_limits<float>::quiet_NaN()),
              std::numeric_limits<float>::infinity());
}

TEST(Quantile, CountsWhatIsNoNumberAsTheLargest) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t at = 0; at < 5; ++at) {
        std::vector<double> values{4.0, 1.0, 3.0, 2.0, 5.0};
        EXPECT_EQ(median(values), 3.0);
        values.insert(values.begin() + static_cast<std::ptrdiff_t>(at), kNan);
        values.insert(values.begin() + static_cast<std::ptrdiff_t>(at), kNan);
        EXPECT_EQ(median(values), 4.0);
        EXPECT_EQ(quantile(values, 0.0), 1.0);
        EXPECT_EQ(quantile(values, 4.0 / 6.0), 5.0);
        EXPECT_TRUE(std::isnan(quantile(values, 5.0 / 6.0)));
        EXPECT_TRUE(std::isnan(quantile(values, 1.0)));
    }
    EXPECT_TRUE(std::isnan(median(std::vector<double>{kNan})));
    EXPECT_EQ(median(std::vector<int>{3, 1, 2}), 2);
}

TEST(Hash, IsXxh3WithNothingAdded) {
    // The published XXH3_128bits of no input, seed 0.
    EXPECT_EQ(Hasher().hex(), "99aa06d3014798d86001c324468d497f");
}

TEST(Hash, KeepsPiecesApart) {
    const auto of = [](std::initializer_list<std::string_view> texts) {
        Hasher hasher;
        for (const auto text : texts) hasher.add(text);
        return hasher.hex();
    };
    EXPECT_EQ(of({"ab", "c"}), of({"ab", "c"}));
    EXPECT_NE(of({"ab", "c"}), of({"a", "bc"}));
    EXPECT_NE(of({"ab", "c"}), of({"c", "ab"}));
    EXPECT_NE(of({"ab"}), of({"ab", ""}));
    EXPECT_EQ(of({"ab"}).size(), 32u);

    Hasher floats, bytes;
    const float values[] = {1.0f, -0.0f};
    floats.add(std::span<const float>(values));
    bytes.add_bytes(values, sizeof values);
    EXPECT_EQ(floats.hex(), bytes.hex());
    const std::string once = floats.hex();
    EXPECT_EQ(floats.hex(), once) << "asking changes nothing";
}

TEST(Random, MatchesTheAuthorsStream) {
    // O'Neill's pcg32-demo, seed 42, stream 54: the first six outputs.
    Random random(42, 54);
    for (const std::uint32_t value :
         {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu}) {
        EXPECT_EQ(random.next(), value);
    }
}

TEST(Random, UniformHasItsMoments) {
    // A million draws: the mean's standard error is 2.9e-4, the variance's 7.5e-5; 5 of each.
    Random random(11);
    const int count = 1'000'000;
    double sum = 0.0, squares = 0.0, lowest = 1.0, highest = 0.0;
    for (int k = 0; k < count; ++k) {
        const double value = random.uniform();
        sum += value;
        squares += value * value;
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
    }
    const double mean = sum / count;
    EXPECT_NEAR(mean, 0.5, 5 * 2.9e-4);
    EXPECT_NEAR(squares / count - mean * mean, 1.0 / 12.0, 5 * 7.5e-5);
    EXPECT_GE(lowest, 0.0);
    EXPECT_LT(highest, 1.0);
    for (int k = 0; k < count; ++k) ASSERT_LT(random.uniform_float(), 1.0f);
}

TEST(Random, NormalHasItsMoments) {
    // Standard errors at a million draws: mean .001, variance .0014, fourth moment .0098.
    Random random(12);
    const int count = 1'000'000;
    double m1 = 0.0, m2 = 0.0, m4 = 0.0;
    for (int k = 0; k < count; ++k) {
        const double v = random.normal();
        m1 += v;
        m2 += v * v;
        m4 += v * v * v * v;
    }
    EXPECT_NEAR(m1 / count, 0.0, 5 * 0.001);
    EXPECT_NEAR(m2 / count, 1.0, 5 * 0.0014);
    EXPECT_NEAR(m4 / count, 3.0, 5 * 0.0098);
}

/// Chi-square of counts against equal shares, over its degrees of freedom.
double reduced_chi_square(const std::vector<int>& counts) {
    double total = 0.0;
    for (const int count : counts) total += count;
    const double share = total / static_cast<double>(counts.size());
    double sum = 0.0;
    for (const int count : counts) sum += (count - share) * (count - share) / share;
    return sum / static_cast<double>(counts.size() - 1);
}

TEST(Random, FillsEveryBinEvenly) {
    // 999 degrees of freedom: one standard deviation is sqrt(2/999) = .045; 5 of them. Too even a
    // spread fails as well.
    Random random(13);
    std::vector<int> uniform(1000), below(1000), pairs(1024), places(1000);
    double last = 0.0;
    for (int k = 0; k < 500'000; ++k) {
        const double u = random.uniform();
        ++uniform[static_cast<std::size_t>(u * 1000.0)];
        ++below[random.below(1000)];
        if (k % 2 == 1) {
            ++pairs[static_cast<std::size_t>(last * 32.0) * 32 +
                    static_cast<std::size_t>(u * 32.0)];
        }
        last = u;
        const auto unsigned_k = static_cast<std::uint32_t>(k);
        const std::uint64_t hash = hash_3d(unsigned_k % 1000, unsigned_k / 1000, 5);
        ++places[static_cast<std::size_t>(hash * 1000 >> 32u)];
    }
    for (const auto& counts : {uniform, below, pairs, places}) {
        EXPECT_NEAR(reduced_chi_square(counts), 1.0, 5 * 0.045);
    }
}

TEST(Random, StreamsAreIndependent) {
    // The correlation of 100,000 independent pairs has a standard deviation of .0032.
    Random a(1, 0), b(1, 1);
    double sum = 0.0;
    for (int k = 0; k < 100'000; ++k) sum += 12.0 * (a.uniform() - 0.5) * (b.uniform() - 0.5);
    EXPECT_NEAR(sum / 100'000, 0.0, 5 * 0.0032);
}

TEST(Parallel, CoversEverythingOnce) {
    for (const std::size_t count : {0u, 1u, 7u, 100'003u}) {
        for (const std::size_t grain : {0u, 1u, 64u, 1'000'000u}) {
            std::vector<std::atomic<int>> visits(count);
            parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
                ASSERT_LE(begin, end);
                for (std::size_t k = begin; k < end; ++k) ++visits[k];
            });
            for (const auto& visit : visits) ASSERT_EQ(visit.load(), 1);
        }
    }
}

TEST(Parallel, ExceptionsReachTheCaller) {
    EXPECT_THROW(parallel_for(1000,
                              1,
                              [](std::size_t begin, std::size_t) {
                                  if (begin == 500) throw std::runtime_error("in a worker");
                              }),
                 std::runtime_error);
}

TEST(Parallel, KeepsToItsThreads) {
    EXPECT_THROW(set_thread_count(-1), std::invalid_argument);
    set_thread_count(1);
    EXPECT_EQ(thread_count(), 1);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    parallel_for(1000, 1, [&](std::size_t, std::size_t) {
        const std::scoped_lock lock(mutex);
        threads.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(threads.size(), 1u);
    set_thread_count(3);
    EXPECT_EQ(thread_count(), 3);
    set_thread_count(0);
    EXPECT_GE(thread_count(), 1);
    EXPECT_LE(thread_count(), static_cast<int>(std::thread::hardware_concurrency()));
}

TEST(Progress, ReportsAndStops) {
    Progress().update(0.5, "silent");
    double last = 0.0;
    std::atomic<bool> stop = false;
    Progress progress;
    progress.report = [&](double fraction, std::string_view) { last = fraction; };
    progress.stop = &stop;
    progress.update(0.25, "a stage");
    EXPECT_EQ(last, 0.25);
    stop = true;
    EXPECT_THROW(progress.update(0.5, "a stage"), Cancelled);
    EXPECT_EQ(last, 0.25);
}

}  // namespace
}  // namespace livery
