// Names and word pairs that people type: what they may be, and when two are one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace livery {

/// Without the white space around it, and single spaces within. Throws std::invalid_argument:
/// empty, over 200 bytes, not UTF-8, control characters.
std::string tidy_name(std::string_view name);

/// Equal for names of one person: tidy, and lower case in the Latin, Greek and Cyrillic alphabets
/// ("ÅSA" and "åsa"). No locale is asked, so a file means the same everywhere.
std::string name_key(std::string_view name);

struct SemanticScale {
    std::string low, high;  ///< "cheap", "precious": the words at steps 1 and 7
    bool operator==(const SemanticScale&) const = default;
};

inline constexpr int kScaleSteps = 7;
/// Where one look lies on each scale: 1 (next to the low word) to 7; 0: left open.
using ScaleSteps = std::vector<int>;
/// One evaluator's answers, by design.
using ScaleAnswers = std::vector<ScaleSteps>;
inline constexpr std::size_t kMostScales = 5;
inline constexpr std::size_t kLongestScaleWord = 24;  ///< characters

/// "cheap,precious": two words with a comma, white space around them left out. Throws
/// std::invalid_argument (what, found, expected) as check_scale() does.
SemanticScale parse_scale(std::string_view text);
/// "cheap,precious": what parse_scale() reads.
std::string text_of(const SemanticScale& scale);
/// For people: "cheap – precious".
std::string in_words(const SemanticScale& scale);

/// Throws std::invalid_argument: a word that is empty, longer than 24 characters, with a comma, a
/// semicolon, a control character or broken UTF-8, white space at its ends, or both words alike.
void check_scale(const SemanticScale& scale);
/// The same for each, and for more than five or one twice.
void check_scales(const std::vector<SemanticScale>& scales);

/// What is offered to who has no words of his own: of the image words of product colour and form
/// studies (Tsai, Hsiao and Hung 2006 let evaluators place products between such pairs).
const std::vector<SemanticScale>& suggested_scales();

}  // namespace livery
