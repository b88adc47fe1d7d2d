// Content hashes: ids of calibrations, cache keys.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace livery {

/// XXH3, 128 bits, of everything added, in order.
class Hasher {
  public:
    Hasher();
    ~Hasher();
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;

    void add(std::string_view text);
    template <typename T>
    void add(std::span<const T> values) {
        add_bytes(values.data(), values.size_bytes());
    }
    void add_bytes(const void* data, std::size_t size);
    /// 32 hexadecimal digits.
    std::string hex() const;

  private:
    void* state_;
};

}  // namespace livery
