#include "cli/parse.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/system/version.h"
#include "core/utf8.h"

namespace livery {

namespace {

const std::vector<std::string> kGlNames = {"software", "hardware", "auto"};

std::string found_expected(const std::string& found, const std::string& expected) {
    return "found \"" + printable(found, 200) + "\", expected " + expected;
}

/// Ours, so that a wrong value is answered as everywhere: what was found, what was expected.
template <typename Number>
CLI::Validator number_check(const std::string& expected) {
    return {[expected](const std::string& text) {
                Number value{};
                const char* end = text.data() + text.size();
                const auto [stop, error] = std::from_chars(text.data(), end, value);
                const bool finite = std::isfinite(static_cast<double>(value));
                return error == std::errc() && stop == end && finite
                           ? std::string()
                           : found_expected(text, expected);
            },
            ""};
}

CLI::Validator choice_check(const std::vector<std::string>& choices) {
    return {[choices](const std::string& text) {
                const bool known = std::find(choices.begin(), choices.end(), text) != choices.end();
                return known ? std::string()
                             : found_expected(text, fmt::format("{}", fmt::join(choices, ", ")));
            },
            ""};
}

CLI::Option* bind(CLI::App& app, const Option& option) {
    return std::visit(
        [&](auto* target) -> CLI::Option* {
            using Value = std::remove_pointer_t<decltype(target)>;
            if constexpr (std::is_same_v<Value, bool>) {
                return app.add_flag(option.flag, *target, option.help);
            } else {
                auto* bound = app.add_option(option.flag, *target, option.help);
                if (option.required) bound->required();
                if constexpr (std::is_same_v<Value, int>) {
                    bound->check(number_check<int>("a whole number"));
                } else if constexpr (std::is_same_v<Value, double>) {
                    bound->check(number_check<double>("a finite number"));
                }
                if (!option.choices.empty()) bound->check(choice_check(option.choices));
                return bound;
            }
        },
        option.target);
}

std::string option_lines(const std::vector<Option>& options) {
    std::string text;
    for (const Option& option : options) {
        const std::string left = option.flag + (option.value.empty() ? "" : " " + option.value);
        text +=
            fmt::format("  {:<26} {}{}\n", left, option.help, option.required ? " (required)" : "");
    }
    return text;
}

constexpr const char* kOpened[] = {".livery", ".glb", ".gltf", ".ply", ".obj"};

std::string unknown_command(const std::string& name) {
    const bool opens = std::any_of(std::begin(kOpened), std::end(kOpened), [&](const char* end) {
        return name.ends_with(end);
    });
    return "livery: " + found_expected(name, "a command that livery help lists") +
           (opens ? "; livery desktop opens a session or a mesh" : "");
}

/// Whether the words start with a command, or with a group's name and a command of it.
bool names_command(const std::vector<std::string>& words, const std::vector<Command>& commands) {
    return std::any_of(commands.begin(), commands.end(), [&](const Command& command) {
        return command.name == words[0] ||
               (words.size() > 1 && command.name == words[0] + " " + words[1]);
    });
}

}  // namespace

std::vector<Option> common_options(CommonOptions& common) {
    return {
        {"--json", "", "print one JSON document on stdout, text on stderr", &common.json},
        {"--seed", "N", "fixes every random choice (default 1)", &common.seed},
        {"--threads", "N", "how many threads to use (default: all cores)", &common.threads},
        {"--data", "DIR", "where the shipped data lie", &common.data},
        {"--gl", "KIND", "software, hardware or auto (default auto)", &common.gl, false, kGlNames},
    };
}

std::string help_text(const std::vector<Command>& commands, const std::string& name) {
    CommonOptions common;
    if (name.empty()) {
        std::string text =
            "Usage: livery [COMMAND [OPTIONS]]\n\n"
            "Judges product paint by projection onto a grey mock-up.\n\nCommands:\n";
        for (const Command& command : commands) {
            text += fmt::format("  {:<16} {}\n", command.name, command.summary);
        }
        text += "  help             this text, or the help of one command\n\nEverywhere:\n";
        text += option_lines(common_options(common));
        text += "\nExamples:\n";
        for (const Command& command : commands) text += "  " + command.example + "\n";
        text +=
            "\nExit status: 0 done; 1 ran, and the answer is \"no\"; 2 could not run; 130 "
            "stopped.\n";
        return text;
    }
    std::string text;
    for (const Command& command : commands) {
        const bool in_group = command.name.starts_with(name + " ");
        if (command.name != name && !in_group) continue;
        text += fmt::format("livery {}: {}\n\nOptions:\n{}\nExample:\n  {}\n\n",
                            command.name,
                            command.summary,
                            option_lines(command.options),
                            command.example);
    }
    if (!text.empty()) text += "Everywhere:\n" + option_lines(common_options(common));
    return text;
}

namespace {

/// The options that every command takes may stand before its name too: moved behind it.
std::vector<std::string> command_first(const std::vector<std::string>& words,
                                       const std::vector<Command>& commands) {
    CommonOptions common;
    const std::vector<Option> options = common_options(common);
    std::size_t at = 0;
    while (at < words.size()) {
        const std::string flag = words[at].substr(0, words[at].find('='));
        const auto option = std::find_if(
            options.begin(), options.end(), [&](const Option& one) { return one.flag == flag; });
        if (option == options.end()) break;
        const bool value_follows = !option->value.empty() && flag == words[at];
        at += value_follows ? 2 : 1;
    }
    if (at == 0 || at >= words.size()) return words;
    const auto first = words.begin() + static_cast<std::ptrdiff_t>(at);
    std::vector<std::string> ordered(first, words.end());
    const bool group = std::none_of(commands.begin(), commands.end(), [&](const Command& command) {
        return command.name == ordered[0];
    });
    const std::ptrdiff_t name_words = group && ordered.size() > 1 ? 2 : 1;
    ordered.insert(ordered.begin() + name_words, words.begin(), first);
    return ordered;
}

}  // namespace

ParsedCommandLine parse_command_line(const std::vector<std::string>& words,
                                     std::vector<Command>& commands) {
    const std::vector<std::string> arguments = command_first(words, commands);
    if (arguments.empty()) return parse_command_line({"desktop"}, commands);
    ParsedCommandLine parsed;

    // For the build alone: users find the page with man.
    if (arguments == std::vector<std::string>{"help", "--man"}) {
        parsed.text = man_page(commands);
        return parsed;
    }
    // `help` and `--help` anywhere are ours: CLI11's pages do not carry the examples.
    const auto wants_help = std::find_if(arguments.begin(), arguments.end(), [](const auto& word) {
        return word == "--help" || word == "-h" || word == "help";
    });
    if (wants_help != arguments.end()) {
        std::string name;
        for (const auto& word : arguments) {
            if (word == "help" || word.starts_with("-")) continue;
            name += (name.empty() ? "" : " ") + word;
        }
        parsed.text = help_text(commands, name);
        if (parsed.text.empty()) parsed.text = help_text(commands, name.substr(0, name.find(' ')));
        if (parsed.text.empty()) {
            parsed.text = unknown_command(name);
            parsed.exit_code = 2;
        }
        return parsed;
    }
    if (arguments.size() == 1 && arguments[0] == "--version") {
        parsed.text = version_text();
        return parsed;
    }

    // CLI11 takes a list apart bracket by bracket, with gigabytes for a hundred kilobytes of them.
    constexpr std::size_t longest_list = 4096;
    for (const std::string& word : arguments) {
        if (word.size() <= longest_list || word.front() != '[') continue;
        parsed.text = "livery: " + found_expected(word, "no list of more than 4096 characters");
        parsed.exit_code = 2;
        return parsed;
    }
    if (!names_command(arguments, commands)) {
        const bool group = std::any_of(commands.begin(), commands.end(), [&](const Command& c) {
            return c.name.starts_with(arguments[0] + " ");
        });
        const bool two_words = group && arguments.size() > 1 && !arguments[1].starts_with("-");
        parsed.text = unknown_command(arguments[0] + (two_words ? " " + arguments[1] : ""));
        parsed.exit_code = 2;
        return parsed;
    }

    CLI::App app("livery");
    app.set_help_flag();
    app.require_subcommand(1);
    std::map<std::string, CLI::App*> groups;
    std::vector<std::pair<CLI::App*, Command*>> bound;
    for (Command& command : commands) {
        CLI::App* parent = &app;
        std::string leaf = command.name;
        if (const auto space = command.name.find(' '); space != std::string::npos) {
            const std::string group = command.name.substr(0, space);
            leaf = command.name.substr(space + 1);
            if (!groups.contains(group)) {
                groups[group] = app.add_subcommand(group);
                groups[group]->require_subcommand(1);
                groups[group]->set_help_flag();
            }
            parent = groups[group];
        }
        CLI::App* sub = parent->add_subcommand(leaf, command.summary);
        sub->set_help_flag();
        for (const Option& option : command.options) bind(*sub, option);
        for (const Option& option : common_options(parsed.common)) bind(*sub, option);
        bound.emplace_back(sub, &command);
    }
    try {
        // CLI11 takes the words in reverse.
        std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
        app.parse(reversed);
    } catch (const CLI::ParseError& error) {
        parsed.exit_code = 2;
        const bool of_group = groups.contains(arguments[0]) && arguments.size() > 1;
        parsed.text = "livery: " + std::string(error.what()) + " (see livery help " + arguments[0] +
                      (of_group ? " " + arguments[1] : "") + ")";
        return parsed;
    }
    for (const auto& [sub, command] : bound) {
        if (!sub->parsed()) continue;
        parsed.command = command;
        parsed.common.seed_given = sub->get_option("--seed")->count() > 0;
    }
    if (parsed.common.threads < 0 || parsed.common.seed < 0) {
        parsed.command = nullptr;
        parsed.exit_code = 2;
        parsed.text = parsed.common.threads < 0
                          ? "livery: --threads: found a negative number, expected 0 (all) or more"
                          : "livery: --seed: found a negative number, expected 0 or more";
    }
    return parsed;
}

namespace {

/// Text that roff takes literally: hyphens that can be searched for and copied, no control lines.
std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '\\') {
            safe += "\\e";
        } else if (c == '-') {
            safe += "\\-";
        } else if ((c == '.' || c == '\'') && (safe.empty() || safe.back() == '\n')) {
            safe += std::string("\\&") + c;
        } else {
            safe += c;
        }
    }
    return safe;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }

std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

/// In lines that an editor shows whole, for roff fills them anyway.
std::string filled(const std::string& text) {
    constexpr std::size_t longest = 79;
    std::string lines, line;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!line.empty() && line.size() + 1 + word.size() > longest) {
            lines += line + '\n';
            line.clear();
        }
        // A dot or a quote would make the line a request.
        if (line.empty() && (word[0] == '.' || word[0] == '\'')) word.insert(0, "\\&");
        line += (line.empty() ? "" : " ") + word;
    }
    return lines + line + '\n';
}

std::string as_sentence(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
        text[0] = static_cast<char>(text[0] - 'a' + 'A');
    }
    return text + (text.ends_with('.') ? "" : ".");
}

std::string entry(const std::string& term, const std::string& text) {
    return ".TP\n" + term + "\n" + filled(text);
}

std::string option_entries(const std::vector<Option>& options) {
    std::string text;
    for (const Option& option : options) {
        const bool positional = !option.flag.starts_with('-');
        std::string term = positional ? "" : bold(option.flag);
        if (!option.value.empty()) term += (positional ? "" : " ") + italic(option.value);
        text += entry(term, escaped(option.help + (option.required ? " (required)" : "")));
    }
    return text;
}

/// A line of a shell, as it is typed.
std::string example(const std::string& line) {
    return ".PP\n.RS 4\n.nf\n" + escaped(line) + "\n.fi\n.RE\n";
}

std::string synopsis() {
    return ".SH SYNOPSIS\n" + bold("livery") + "\n.br\n" + bold("livery") + ' ' +
           italic("COMMAND") + " [" + italic("OPTIONS") + "]\n.br\n" + bold("livery help") + " [" +
           italic("COMMAND") + "]\n.br\n" + bold("livery --version") + '\n';
}

std::string description() {
    return ".SH DESCRIPTION\n" +
           filled(
               "Livery throws paint that does not exist yet onto a grey model of a product, so "
               "that people can judge it before anyone mixes a can. A projector lights a grey "
               "mock\\-up; Livery renders the product with the chosen paint from the "
               "projector's view, shaded for the audience's eyes, and corrects every pixel for "
               "projector, surface and room. A simulation of the whole bench comes with it.") +
           ".PP\n" +
           filled(
               "Without a command it opens the desktop program. No other command needs a "
               "display; OpenGL then comes from EGL, in software where there is no graphics "
               "card.");
}

std::string environment() {
    return ".SH ENVIRONMENT\n" +
           entry(bold("LIVERY_HOME"), "The user's folder, in place of those under FILES.") +
           entry(bold("LIVERY_DATA"),
                 "Where the shipped data lie, unless \\fB\\-\\-data\\fR says so.") +
           entry(bold("XDG_DATA_HOME"),
                 "Holds the user's folder where \\fBLIVERY_HOME\\fR is not set.") +
           entry(bold("DISPLAY"), "The X display of the desktop program.");
}

std::string files() {
    return ".SH FILES\n" +
           entry(italic("$LIVERY_HOME") + ", " + italic("$XDG_DATA_HOME/livery") + ", " +
                     italic("~/.local/share/livery"),
                 "The user's folder, the first of these that is set: sessions, votes, own paints, "
                 "calibrations, the log, and what passes take on this machine.") +
           entry(italic("PREFIX/share/livery"),
                 "Shipped data, beside the program's own folder: paints, looks, the car, simulated "
                 "benches, shaders.");
}

std::string exit_status() {
    return ".SH \"EXIT STATUS\"\n" + entry(bold("0"), "Done.") +
           entry(bold("1"),
                 "Ran, and the answer is \"no\": a calibration refused, a file with problems.") +
           entry(bold("2"),
                 "Could not run; one line on standard error names the file, the field, what was "
                 "found and what was expected.") +
           entry(bold("130"), "Stopped by Ctrl\\-C.");
}

}  // namespace

std::string man_page(const std::vector<Command>& commands) {
    CommonOptions common;
    std::string text =
        ".TH LIVERY 1 \"" + version_date() + "\" \"livery " + version_number() +
        "\" \"User Commands\"\n"
        ".SH NAME\nlivery \\- judge product paint by projection onto a grey mock\\-up\n";
    text += synopsis() + description();
    text += ".SH COMMANDS\n";
    for (const Command& command : commands) {
        text += ".SS \"livery " + escaped(command.name) + "\"\n";
        text += filled(escaped(as_sentence(command.summary)));
        text += option_entries(command.options);
        text += example(command.example);
    }
    text += ".SS \"livery help\"\nThe commands, or the options of one.\n";
    text += ".SH \"OPTIONS OF EVERY COMMAND\"\n" + option_entries(common_options(common));
    text += exit_status() + environment() + files();
    text += ".SH \"SEE ALSO\"\nThe documentation in \\fIPREFIX/share/doc/livery\\fR.\n";
    return text;
}

}  // namespace livery
