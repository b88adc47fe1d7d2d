#include "studio/report/redaction.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include <pwd.h>
#include <unistd.h>

#include "core/paths.h"

namespace livery {

namespace {

using Replacements = std::vector<std::pair<std::string, std::string>>;

constexpr std::array<std::string_view, 7> kNobody = {
    "root", "livery", "user", "localhost", "debian", "ubuntu", "linux"};

bool is_word_byte(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
           (byte >= 'a' && byte <= 'z') || byte == '_' || byte >= 0x80;
}

void add(Replacements& list, const std::string& text, const char* instead) {
    const auto same = [&](const auto& known) { return known.first == text; };
    if (text.empty() || std::any_of(list.begin(), list.end(), same)) return;
    list.emplace_back(text, instead);
}

void add_word(Replacements& list, const std::string& text, const char* instead) {
    if (std::find(kNobody.begin(), kNobody.end(), text) == kNobody.end()) add(list, text, instead);
}

/// Also where links lead. "/" would stand for every path.
void add_home(PrivateWords& words, const std::string& folder) {
    std::filesystem::path home = std::filesystem::path(folder).lexically_normal();
    if (!home.has_filename()) home = home.parent_path();
    if (!home.is_absolute() || home == home.root_path()) return;
    std::error_code error;
    const auto real = std::filesystem::canonical(home, error);
    add(words.folders, home.string(), "~");
    if (!error && real != real.root_path()) add(words.folders, real.string(), "~");
}

/// What JSON puts before quotes and backslashes.
std::string as_in_json(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '"' || c == '\\') escaped += '\\';
        escaped += c;
    }
    return escaped;
}

void replace_all(std::string& text, const std::string& from, const std::string& to, bool folder) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
        const std::size_t end = at + from.size();
        // "/home/max" is no part of "/home/maximilian" or "/home/max-2".
        const bool begins = folder || at == 0 || !is_word_byte(text[at - 1]);
        const bool ends =
            end == text.size() ||
            !(is_word_byte(text[end]) || (folder && (text[end] == '-' || text[end] == '.')));
        if (begins && ends) text.replace(at, from.size(), to);
        at += begins && ends ? to.size() : 1;
    }
}

}  // namespace

PrivateWords private_words() {
    PrivateWords words;
    const auto variable = [](const char* name) {
        const char* text = std::getenv(name);
        return std::string(text ? text : "");
    };
    const auto add_account = [&](const passwd* account) {
        if (!account) return;
        add_home(words, account->pw_dir);
        add_word(words.words, account->pw_name, "USER");
        // The owner's name, then perhaps a room and telephone numbers.
        const std::string owner = account->pw_gecos ? account->pw_gecos : "";
        add_word(words.words, owner.substr(0, owner.find(',')), "USER");
    };
    add_home(words, variable("HOME"));
    for (const char* name : {"USER", "LOGNAME", "SUDO_USER"}) {
        if (const std::string user = variable(name); !user.empty()) {
            add_account(::getpwnam(user.c_str()));
            add_word(words.words, user, "USER");
        }
    }
    add_account(::getpwuid(::getuid()));
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) == 0)
        add_word(words.words, host.data(), "HOST");
    const auto longer = [](const auto& a, const auto& b) {
        return a.first.size() > b.first.size();
    };
    std::stable_sort(words.folders.begin(), words.folders.end(), longer);
    std::stable_sort(words.words.begin(), words.words.end(), longer);
    return words;
}

std::string redacted(const std::string& text, const PrivateWords& words) {
    std::string result = text;
    for (const bool folder : {true, false}) {
        for (const auto& [from, to] : folder ? words.folders : words.words) {
            replace_all(result, from, to, folder);
            if (const std::string escaped = as_in_json(from); escaped != from) {
                replace_all(result, escaped, to, folder);
            }
        }
    }
    return result;
}

namespace {

using Path = std::filesystem::path;

/// Of a line that tells of the session, what is left: "command: {"set-paint": …" becomes
/// "command: set-paint". Other lines stay.
std::string without_session(const std::string& line) {
    // "2026-11-28T22:30:00.123Z info command: {"
    constexpr std::size_t before_level = 25;
    const std::size_t text = line.find(' ', std::min(before_level, line.size()));
    if (text == std::string::npos) return line;
    const std::string_view said = std::string_view(line).substr(text + 1);
    for (const char* kind : {"undo:", "redo:"}) {
        if (said.starts_with(kind)) return line.substr(0, text + 1) + kind;
    }
    constexpr std::string_view command = "command: ";
    if (!said.starts_with(command)) return line;
    const std::size_t begin = line.find('"', text), end = line.find('"', begin + 1);
    const bool named = begin != std::string::npos && end != std::string::npos;
    return line.substr(0, text + 1) + std::string(command) +
           (named ? line.substr(begin + 1, end - begin - 1) : "");
}

}  // namespace

std::string log_part(const Path& user_folder, bool with_session, std::size_t most_bytes) {
    const Path newest = user_folder / "log" / "livery.log";
    std::string text = read_text_file(newest);
    for (int number = 1; text.size() < most_bytes; ++number) {
        Path older = newest;
        older += "." + std::to_string(number);
        std::error_code error;
        if (!std::filesystem::exists(older, error)) break;
        text.insert(0, read_text_file(older));
    }
    if (text.size() > most_bytes) {
        const std::size_t line_end = text.find('\n', text.size() - most_bytes - 1);
        text.erase(0, line_end == std::string::npos ? text.size() : line_end + 1);
    }
    if (with_session) return text;
    std::istringstream lines(text);
    std::string kept;
    for (std::string line; std::getline(lines, line);) kept += without_session(line) + '\n';
    return kept;
}

}  // namespace livery
