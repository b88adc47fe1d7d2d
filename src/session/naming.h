// Names that people gave or that we make: checked, and each only once.
#pragma once

#include <functional>
#include <string>

namespace livery {

/// Throws std::invalid_argument unless `text` is UTF-8 of 1 to 200 characters' bytes without
/// control characters; `what` begins the message.
void check_name(const std::string& text, const std::string& what);

/// The same for a path or another text that may be long or empty.
void check_text(const std::string& text, const std::string& what);

/// "solid red 2" -> "solid red"; a name without such a number comes back as it is.
std::string without_number(const std::string& name);

/// `name` when it is free, else with the first free number behind it: "solid red 2". What carries
/// such a number already goes on from its stem: "solid red 2" to "solid red 3".
std::string free_name(const std::string& name,
                      const std::function<bool(const std::string&)>& taken);

}  // namespace livery
