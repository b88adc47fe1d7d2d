// What is typed, line by line, without waiting for ever.
#pragma once

#include <optional>
#include <string>

namespace livery {

/// Lines of the standard input.
class TypedLines {
  public:
    /// The next line, without its end; nothing when none came within half a second. After the end
    /// of the input what was left without a line break is a line too, then there are none.
    std::optional<std::string> next();
    /// Nothing is left, and nothing will come.
    bool at_end() const { return at_end_ && waiting_.empty(); }

  private:
    std::string waiting_;
    bool at_end_ = false;
};

}  // namespace livery
