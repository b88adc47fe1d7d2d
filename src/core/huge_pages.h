// Memory for large tables that are read here and there: in pages of two megabytes where the system
// has them, since looking up where a small page lies can take longer than reading from it.
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

}  // namespace livery
