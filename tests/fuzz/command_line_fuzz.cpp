#include "cli/command.h"
#include "fuzz/fuzz.h"

// What options write: sizes, numbers, units. They say what is wrong with std::invalid_argument.
LIVERY_FUZZ(text) {
    using namespace livery;
    const auto parse = [](const auto& one) {
        try {
            one();
        } catch (const std::invalid_argument&) {
        }
    };
    parse([&] { parse_size("--size", text); });
    parse([&] { parse_unit(text); });
    for (const std::size_t count : {1u, 3u}) {
        parse([&] {
            const auto values = parse_numbers("--eye", text, count);
            fuzz::require(values.size() == count, "as many numbers as asked for");
        });
    }
}
