#include "studio/kit/user_settings.h"

#include <exception>

#include "core/json.h"
#include "core/log.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr int kFormatVersion = 1;

}  // namespace

UserSettings read_user_settings() {
    UserSettings settings;
    try {
        settings.file = user_folder() / "desktop.json";
        std::error_code error;
        if (!std::filesystem::exists(settings.file, error)) return settings;
        const Json json = read_json_file(settings.file);
        const JsonReader root(settings.file.string(), json);
        root.allow_only({"format_version", "settings"});
        root.require_format_version(kFormatVersion);
        const JsonReader values = root["settings"];
        for (const std::string& name : values.keys()) settings.values[name] = values[name].text();
    } catch (const std::exception& failure) {
        log_line(LogLevel::warning, std::string("settings: ") + failure.what());
        // Not written over: it may be a newer Livery's.
        return {};
    }
    return settings;
}

std::string setting(const UserSettings& settings, const std::string& name) {
    const auto found = settings.values.find(name);
    return found == settings.values.end() ? std::string() : found->second;
}

void keep_setting(UserSettings& settings, const std::string& name, const std::string& value) {
    if (setting(settings, name) == value) return;
    settings.values[name] = value;
    if (settings.file.empty()) return;
    try {
        make_output_folder(settings.file.parent_path());
        const Json json = {{"format_version", kFormatVersion}, {"settings", settings.values}};
        write_text_file(settings.file, json.dump(2) + "\n");
    } catch (const std::exception& failure) {
        log_line(LogLevel::warning, std::string("settings: ") + failure.what());
    }
}

}  // namespace livery
