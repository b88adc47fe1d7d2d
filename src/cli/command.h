// A subcommand as data: its options, its help and what it does. Parsing lives in parse.cpp alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "core/error.h"
#include "core/json.h"
#include "core/progress.h"
#include "gl/context.h"
#include "mesh/length_unit.h"

namespace livery {

/// Options that every command takes.
struct CommonOptions {
    bool json = false;
    int seed = 1;
    bool seed_given = false;  ///< else what must not be guessed draws its own
    int threads = 0;          ///< 0: all
    std::string data;
    std::string gl = "auto";

    GlDevice gl_device() const;
};

/// One option, bound to the variable that it sets.
struct Option {
    std::string flag;   ///< "--out"; a name without dashes is positional
    std::string value;  ///< how help calls the value, "DIR"
    std::string help;   ///< one line, with the default
    std::variant<std::string*, int*, double*, bool*, std::vector<std::string>*> target;
    bool required = false;
    std::vector<std::string> choices = {};  ///< when not empty, only these
};

/// What a command found: figures for scripts, a text for people.
struct Outcome {
    Json figures = Json::object();
    std::string text;
    int exit_code = 0;  ///< 0: done; 1: ran, and the answer is "no"
};

/// The answer is no: exit code 1, `refused` beside the figures that there are, why and what helps
/// after the text.
void report_refusal(const Refused& refused, Outcome& outcome);

struct Command {
    std::string name;  ///< "demo" or, in a group, "calibrate color"
    std::string summary;
    std::string example;
    std::vector<Option> options;
    std::function<Outcome(const CommonOptions& common, const Progress& progress)> run;
};

// One file each. A command's options are bound to state that lives as long as the command.
Command albedo_command();
Command bench_command();
Command board_command();
Command brdf_command();
Command bssrdf_command();
Command calibrate_color_command();
Command calibrate_compare_command();
Command calibrate_drift_command();
Command calibrate_geometry_command();
Command calibrate_nudge_command();
Command calibrate_register_command();
Command calibrate_repose_command();
Command calibrate_scan_command();
Command capture_command();
Command check_command();
Command compensate_command();
Command demo_command();
Command desktop_command();
Command evaluate_serve_command();
Command fit_brdf_command();
Command fit_bssrdf_command();
Command measure_brdf_command();
Command measure_environment_command();
Command measure_profile_command();
Command paints_command();
Command patterns_command();
Command photograph_command();
Command plan_command();
Command render_command();
Command report_problem_command();
std::vector<Command> session_commands();

/// Numbers as cli options write them: "1280x800" and "10,20.5,-3". Throw std::invalid_argument that
/// names the option, what was found and what was expected.
glm::ivec2 parse_size(const std::string& option, const std::string& text);
/// The unit of a mesh file's numbers; nothing for an empty text.
std::optional<LengthUnit> parse_unit(const std::string& text);
Option unit_option(std::string& target);

/// What loading a product assumed or repaired: notes[] where there is anything, and a line each.
void tell_notes(const std::vector<std::string>& notes, Outcome& outcome);

std::vector<double> parse_numbers(const std::string& option,
                                  const std::string& text,
                                  std::size_t count);

/// For options that are a percentile. Throws std::invalid_argument outside 0 to 100.
void check_percentile(const std::string& option, double value);

}  // namespace livery
