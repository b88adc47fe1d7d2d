#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>
#include <malloc.h>

#include "core/memory.h"

namespace livery {
namespace {

using Block = std::unique_ptr<char, decltype(&std::free)>;

Block block_of(std::size_t bytes) { return {static_cast<char*>(std::malloc(bytes)), &std::free}; }

/// How many blocks are the system's own pages.
auto apart() { return ::mallinfo2().hblks; }

TEST(FreedMemory, LargeBlocksStayApartAfterOneWasFreed) {
#if defined(LIVERY_SANITIZED)
    GTEST_SKIP() << "the sanitizer allocates by itself";
#endif
    keep_large_blocks_apart();
    block_of(24u << 20u).reset();
    const auto before = apart();
    const Block large = block_of(8u << 20u);
    EXPECT_EQ(apart(), before + 1);
    const Block small = block_of(100'000);
    EXPECT_EQ(apart(), before + 1);
}

}  // namespace
}  // namespace livery
