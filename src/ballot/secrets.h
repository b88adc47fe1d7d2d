// Randomness that cannot be guessed, and hashes that cannot be turned back.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace livery {

/// 128 bits from the system, as 32 hexadecimal digits. Throws std::runtime_error without any.
std::string random_secret();

/// Six characters to be read aloud and typed: digits and capitals without those that look or sound
/// alike, and without vowels, so that no word comes of them (27^6, 4e8).
std::string random_join_code();

/// What somebody typed, as random_join_code() writes it: capitals, no spaces nor hyphens.
std::string tidy_join_code(std::string_view typed);

/// SHA-256, as 64 hexadecimal digits. What is kept of a phone's secret.
std::string hash_of_secret(std::string_view secret);

}  // namespace livery
