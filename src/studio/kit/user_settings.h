// What the program remembers for every session of this user: the projector, where files were looked
// for. Nothing that makes a picture: that belongs to the session.
#pragma once

#include <charconv>
#include <filesystem>
#include <map>
#include <string>

namespace livery {

/// Names are the studio's; values are text.
struct UserSettings {
    std::filesystem::path file;  ///< empty: nothing is kept
    std::map<std::string, std::string> values;
};

inline constexpr const char* kProjectorSetting = "projector-monitor";

/// `desktop.json` in the user's folder. A file that cannot be read is as if nothing had been
/// remembered, the log says why, and it is left as it is. Never throws over a file.
UserSettings read_user_settings();

/// The value; empty: none.
std::string setting(const UserSettings& settings, const std::string& name);
/// Keeps it, in the file as well; where that cannot be written the log says so and it is kept until
/// the program ends.
void keep_setting(UserSettings& settings, const std::string& name, const std::string& value);

/// A number that was kept as text; what cannot be read, or is not from `low` to `high`, is as if it
/// had not been kept.
template <typename Number>
void restore(const std::string& text, Number& value, Number low, Number high) {
    Number read{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (error == std::errc() && read >= low && read <= high) value = read;
}

}  // namespace livery
