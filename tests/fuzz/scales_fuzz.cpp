// Word pairs as they are typed: two words that can be shown, or a message that can.
#include <stdexcept>

#include "evaluation/typed_words.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    SemanticScale scale;
    try {
        scale = parse_scale(text);
    } catch (const std::invalid_argument& error) {
        const std::string message = error.what();
        fuzz::require(message == printable(message), "a message is one line of UTF-8");
        fuzz::require(message.size() < 500, "a message is short");
        return;
    }
    for (const std::string& word : {scale.low, scale.high}) {
        fuzz::require(word == printable(word), "a word is one line of UTF-8");
        fuzz::require(!word.empty() && word.size() <= 4 * kLongestScaleWord, "a word is short");
    }
    fuzz::require(parse_scale(text_of(scale)) == scale, "a pair comes back");
}
