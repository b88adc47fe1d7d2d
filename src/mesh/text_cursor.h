// Walks through lines of words and numbers. Internal to mesh/.
#pragma once

#include <charconv>
#include <cstddef>
#include <limits>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace livery {

class TextCursor {
  public:
    explicit TextCursor(std::string_view text) : at_(text.data()), end_(at_ + text.size()) {}

    std::size_t line() const { return line_; }
    bool at_end() const { return at_ == end_; }
    /// What is left of the text.
    std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

    /// Skips blanks; whether nothing is left of the line but a comment. A backslash at its end
    /// joins it with the next where `joins_lines`.
    bool at_line_end() {
        skip_blanks();
        return at_ == end_ || *at_ == '\n' || *at_ == comments_begin_with;
    }
    void next_line() {
        while (!at_line_end()) ++at_;
        while (at_ != end_ && *at_ != '\n') ++at_;
        if (at_ == end_) return;
        ++at_;
        ++line_;
    }
    /// What stands up to the next blank; empty at the line's end.
    std::string_view word() {
        if (at_line_end()) return {};
        const char* const first = at_;
        while (at_ != end_ && !is_blank(*at_) && *at_ != '\n') ++at_;
        return {first, static_cast<std::size_t>(at_ - first)};
    }
    /// What stands up to the line's end, without the blanks around it.
    std::string_view rest_of_line() {
        skip_blanks();
        const char* const first = at_;
        const char* last = at_;
        for (; at_ != end_ && *at_ != '\n'; ++at_) {
            if (!is_blank(*at_)) last = at_ + 1;
        }
        return {first, static_cast<std::size_t>(last - first)};
    }

    bool joins_lines = false;
    char comments_begin_with = '\n';  ///< none

  private:
    static bool is_blank(char c) {
        return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
    }
    void skip_blanks() {
        for (; at_ != end_; ++at_) {
            if (is_blank(*at_)) continue;
            if (!joins_lines || *at_ != '\\') return;
            const char* next = at_ + 1;
            if (next != end_ && *next == '\r') ++next;
            if (next == end_ || *next != '\n') return;
            at_ = next;
            ++line_;
        }
    }

    const char* at_;
    const char* end_;
    std::size_t line_ = 1;
};

/// Whether the whole word is a number; NaN and infinity are. Independent of the locale.
template <typename Number>
bool read_number(std::string_view word, Number& number) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    const char* const end = word.data() + word.size();
    const auto [stopped, error] = std::from_chars(word.data(), end, number);
    if (stopped != end || word.empty()) return false;
    if constexpr (std::is_floating_point_v<Number>) {
        if (error == std::errc::result_out_of_range) {
            // Too small to be told from zero, or too large for anything.
            const bool small = word.find("e-") != std::string_view::npos ||
                               word.find("E-") != std::string_view::npos;
            number = small ? Number(0) : std::numeric_limits<Number>::infinity();
            return true;
        }
    }
    return error == std::errc();
}

}  // namespace livery
