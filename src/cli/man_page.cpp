#include "cli/man_page.h"

#include <sstream>

#include "cli/parse.h"
#include "core/system/version.h"

namespace livery {

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
