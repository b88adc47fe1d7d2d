// Large tables in huge pages, and freed memory that goes back to the system.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace livery {

inline constexpr std::size_t kHugePageBytes = std::size_t{1} << 21u;

/// A hint: where it is not taken, nothing but speed is lost.
void ask_for_huge_pages(void* memory, std::size_t bytes);

/// For containers. What is smaller than a page is allocated as usual.
template <typename T>
struct HugePageAllocator {
    using value_type = T;

    HugePageAllocator() = default;
    template <typename Other>
    explicit HugePageAllocator(const HugePageAllocator<Other>&) {}

    T* allocate(std::size_t count) {
        if (!is_large(count)) return static_cast<T*>(::operator new(count * sizeof(T), usual()));
        void* memory = ::operator new(count * sizeof(T), std::align_val_t(kHugePageBytes));
        ask_for_huge_pages(memory, count * sizeof(T));
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t count) {
        ::operator delete(memory, is_large(count) ? std::align_val_t(kHugePageBytes) : usual());
    }
    template <typename Other>
    bool operator==(const HugePageAllocator<Other>&) const {
        return true;
    }

  private:
    static constexpr std::align_val_t usual() { return std::align_val_t(alignof(T)); }
    static bool is_large(std::size_t count) { return count >= kHugePageBytes / sizeof(T); }
};

template <typename T>
using LargeTable = std::vector<T, HugePageAllocator<T>>;

/// After work that took hundreds of megabytes for a while. The C library keeps most of what is
/// freed for the thread that freed it, so a program that calibrates now and then would grow by one
/// calibration's photographs for each thread that ever held them. Takes milliseconds; any thread.
void return_freed_memory();

/// From here on blocks of a megabyte and more are the system's own pages, which go back when they
/// are freed. Otherwise the C library raises that size to 32 MB after the first large block, keeps
/// them among small ones, and a program that runs for hours holds twice what it uses. For programs
/// that stay open; what allocates large blocks in every frame should keep them.
void keep_large_blocks_apart();

}  // namespace livery
