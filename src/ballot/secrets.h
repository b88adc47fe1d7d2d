// Randomness that cannot be guessed, and hashes that cannot be turned back.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace livery {

/// 128 bits from the system, as 32 hexadecimal digits. Throws std::runtime_error without any.
std::string random_secret();

/// Eight characters to be read aloud and typed: digits and capitals without those that look or
/// sound alike, and without vowels, so that no word comes of them. Of 27^8 = 2.8e11 codes, each
/// good for eleven minutes, 10,000 guesses a second find one within two hours with a probability of
/// 3e-4, so wrong codes need not lock anybody out.
std::string random_join_code();

/// What somebody typed, as random_join_code() writes it: capitals, no spaces nor hyphens.
std::string tidy_join_code(std::string_view typed);

/// SHA-256, as 64 hexadecimal digits. What is kept of a phone's secret.
std::string hash_of_secret(std::string_view secret);

}  // namespace livery
