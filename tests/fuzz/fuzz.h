// What every target promises: whatever the bytes are, the parser gives a value or throws a
// FileError whose message can be shown. Anything else that comes out is a defect.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "core/utf8.h"

namespace livery::fuzz {

/// Ends the run, and the bytes are kept: libFuzzer counts it as a crash.
inline void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "fuzz: does not hold: %s\n", what);
    std::abort();
}

template <typename Parse>
int run(const std::uint8_t* data, std::size_t size, const Parse& parse) {
    try {
        parse(std::string(reinterpret_cast<const char*>(data), size));
    } catch (const FileError& error) {
        const std::string message = error.what();
        require(message == printable(message), "a message is one line of UTF-8");
        require(message.size() < 8000, "a message is short");
    }
    return 0;
}

}  // namespace livery::fuzz

/// LIVERY_FUZZ(text) { parse_something(text, "a.json"); }
#define LIVERY_FUZZ(input)                                                             \
    static void parse_one(const std::string& input);                                   \
    extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size); \
    int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {           \
        return livery::fuzz::run(data, size, parse_one);                               \
    }                                                                                  \
    static void parse_one(const std::string& input)
