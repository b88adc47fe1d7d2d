// Uses the desktop program for as long as one asks for: swaps paints, looks and environments,
// calibrates, pulls the projector's plug and puts it back, saves pictures. Prints what the program
// holds after each round, and judges at the end whether memory, handles and frame times stayed as
// they were. Not a test: figures depend on the machine and what else it does.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/image_io.h"
#include "desktop/prepared.h"
#include "desktop/studio_program.h"
#include "desktop/trace_latency.h"
#include "session/session.h"

namespace livery {
namespace {

constexpr int kBetweenPaints_ms = 600;
constexpr int kPaintsARound = 24;
constexpr int kRoundsToACalibration = 5, kRoundsToAnEnvironment = 3, kRoundsToAPicture = 4;

// What may change between the first and the last third of the run, chosen before the first run:
// memory by what allocators and caches breathe (the document itself grows by kilobytes), frame
// times by what other programs on the machine cost.
constexpr double kMemoryGrowth = 0.05, kFrameGrowth = 0.35;
constexpr int kHandleGrowth = 0;

/// What a process holds.
struct Holdings {
    double resident_mib = 0.0, swapped_mib = 0.0;
    int descriptors = 0, threads = 0, mapped_files = 0;
};

Holdings holdings_of(pid_t process) {
    const std::string folder = fmt::format("/proc/{}", process);
    Holdings holdings;
    std::ifstream status(folder + "/status");
    for (std::string line; std::getline(status, line);) {
        const auto value = [&] { return std::atof(line.c_str() + line.find(':') + 1); };
        if (line.starts_with("VmRSS:")) holdings.resident_mib = value() / 1024.0;
        if (line.starts_with("VmSwap:")) holdings.swapped_mib = value() / 1024.0;
        if (line.starts_with("Threads:")) holdings.threads = static_cast<int>(value());
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder + "/fd")) {
        (void)entry;
        ++holdings.descriptors;
    }
    std::ifstream maps(folder + "/maps");
    for (std::string line; std::getline(maps, line);) ++holdings.mapped_files;
    return holdings;
}

struct Round {
    double minutes = 0.0;
    Holdings program;
    double server_mib = 0.0;  ///< the X server, which holds pixmaps on the program's behalf
    double median_ms = 0.0, p95_ms = 0.0;
    std::size_t shown = 0, asked = 0;
};

class Soak {
  public:
    Soak(Desktop& desktop, const std::filesystem::path& folder)
        : desktop_(desktop),
          folder_(folder),
          program_(desktop, StudioStart{folder / "session.livery", {1280, 800}, 1.0, {}}) {
        program_.click("projector-monitor");
        program_.click("monitor:2");
        program_.click("part:body");
        settle();
    }

    Round round(int number) {
        std::vector<double> moments;
        step("sweeping over paints", [&] { moments = sweep_paints(); });
        step("committing and undoing", [&] { commit_and_undo(); });
        step("swapping looks", [&] { swap_looks(); });
        step("going black", [&] { black_and_back(); });
        step("pulling the plug", [&] { pull_plug(number); });
        if (number % kRoundsToAnEnvironment == 1)
            step("swapping environments", [&] { swap_environment(); });
        if (number % kRoundsToACalibration == 2) step("calibrating", [&] { calibrate(); });
        if (number % kRoundsToAPicture == 3) step("saving a picture", [&] { save_picture(); });
        step("coming to rest", [&] { settle(); });

        Round round;
        round.minutes = (trace_now_s() - start_s_) / 60.0;
        std::vector<double> ms;
        for (const auto& answer : to_projector_ms(program_.trace(), moments)) {
            if (answer) ms.push_back(*answer);
        }
        round.asked = moments.size();
        round.shown = ms.size();
        if (ms.empty()) throw std::runtime_error("no paint of the round reached the projector");
        round.median_ms = percentile_of(ms, 0.5);
        round.p95_ms = percentile_of(ms, 0.95);
        round.program = holdings_of(program_.process().id());
        round.server_mib = holdings_of(desktop_.server()).resident_mib;
        return round;
    }

    int quit() { return program_.quit(); }

    /// For a failure's message.
    std::string words() const {
        return fmt::format(
            "{}\nThe operator's monitor then: {}", program_.words(), picture_of_screen());
    }

  private:
    /// Runs it, and sees that the projector is there to be shown something afterwards.
    template <typename Work>
    void step(const char* what, Work work) {
        work();
        for (const char* name : {"frozen", "black"}) {
            const bool shows =
                wait_until([&] { return program_.state(name) == false; }, std::chrono::seconds(20));
            if (!shows) {
                throw std::runtime_error(fmt::format("the projector is {} after {}", name, what));
            }
        }
    }

    std::string picture_of_screen() const {
        const auto file = std::filesystem::temp_directory_path() / "livery-soak.png";
        write_png(file, desktop_.read(desktop_.operator_area()));
        return file.string();
    }

    void open_tab(const std::string& tab, const std::vector<std::string>& shows) {
        program_.click(tab);
        const bool open = wait_until([&] {
            return std::ranges::any_of(shows, [&](const std::string& prefix) {
                return !program_.items_starting_with(prefix).empty();
            });
        });
        if (!open) throw std::runtime_error(tab + " does not open");
    }

    std::vector<double> sweep_paints() {
        open_tab("tab:Paints", {"paint-search"});
        std::vector<glm::ivec2> swatches;
        const bool there = wait_until([&] {
            swatches.clear();
            for (const auto& name : program_.items_starting_with("paint:")) {
                const Rectangle place = program_.item(name);
                if (place.height > 20) swatches.push_back(middle(place));
            }
            return swatches.size() >= 2;
        });
        if (!there) throw std::runtime_error("the paints are not in sight");
        std::vector<double> moments;
        for (int i = 0; i < kPaintsARound; ++i) {
            const auto& at = swatches[static_cast<std::size_t>(i) % swatches.size()];
            moments.push_back(trace_now_s());
            desktop_.move_pointer(at.x, at.y);
            sleep_ms(kBetweenPaints_ms);
        }
        program_.move_away();
        return moments;
    }

    void commit_and_undo() {
        program_.click("paint:solid blue");
        program_.move_away();
        sleep_ms(300);
        desktop_.press_key("ctrl+z");
        sleep_ms(300);
    }

    void swap_looks() {
        for (const char* key : {"2", "3", "4", "1"}) {
            desktop_.press_key(key);
            sleep_ms(kBetweenPaints_ms);
        }
        program_.click("part:body");
    }

    void black_and_back() {
        for (const bool black : {true, false}) {
            desktop_.press_key("b");
            program_.wait_for_state("black", black);
        }
    }

    void pull_plug(int number) {
        constexpr Desktop::Side sides[] = {
            Desktop::Side::right, Desktop::Side::below, Desktop::Side::left, Desktop::Side::right};
        desktop_.unplug_projector();
        sleep_ms(700);
        desktop_.plug_projector(sides[number % 4]);
        sleep_ms(700);
        desktop_.plug_projector(Desktop::Side::right);
        program_.wait_for_state("projector", "showing");
        sleep_ms(700);
    }

    void swap_environment() {
        open_tab("tab:Light", {"light:", "environment"});
        // To the end of the panel, which keeps where it was scrolled to.
        const glm::ivec2 tab = middle(program_.item("tab:Light"));
        program_.scroll({tab.x, tab.y + 200}, -40);
        for (const char* name : {"environment:overcast", "environment:studio"}) {
            program_.click("environment");
            program_.click(name);
            sleep_ms(2000);
        }
        program_.move_away();
    }

    void calibrate() {
        open_tab("tab:Calibrate", {"calibrate", "calibration"});
        program_.click("calibrate");
        program_.wait_for_state("calibrating", true);
        const bool done = wait_until([&] { return program_.state("calibrating") == false; },
                                     std::chrono::minutes(5));
        if (!done) throw std::runtime_error("the bench calibrates for five minutes");
    }

    void save_picture() {
        desktop_.press_key("ctrl+s");
        program_.click("save-picture:what-1");
        program_.click("file-dialog:path");
        desktop_.press_key("ctrl+a");
        desktop_.type((folder_ / fmt::format("picture{}.exr", pictures_++)).string());
        program_.click("file-dialog:ok");
        sleep_ms(1000);
    }

    /// Nothing is solved, saved or drawn any more.
    void settle() {
        const bool quiet = wait_until(
            [&] {
                if (program_.state("solving") == true || program_.state("busy") == true)
                    return false;
                const auto lines = program_.trace().size();
                sleep_ms(1500);
                return program_.trace().size() == lines;
            },
            std::chrono::minutes(3));
        if (!quiet) throw std::runtime_error("the program does not come to rest");
    }

    Desktop& desktop_;
    std::filesystem::path folder_;
    StudioProgram program_;
    double start_s_ = trace_now_s();
    int pictures_ = 0;
};

void print(const Round& round, int number) {
    std::cout << fmt::format(
                     "| {} | {:.1f} | {:.1f} | {:.1f} | {} | {} | {} | {:.1f} | {:.0f} | "
                     "{:.0f} | {} of {} |\n",
                     number,
                     round.minutes,
                     round.program.resident_mib,
                     round.program.swapped_mib,
                     round.program.descriptors,
                     round.program.threads,
                     round.program.mapped_files,
                     round.server_mib,
                     round.median_ms,
                     round.p95_ms,
                     round.shown,
                     round.asked)
              << std::flush;
}

/// A figure of rounds [from, to): what half of them are below of what varies, the least of what is
/// counted, since what is left behind stays in every round.
template <typename Figure>
double figure_of(const std::vector<Round>& rounds,
                 std::size_t from,
                 std::size_t to,
                 double fraction,
                 Figure figure) {
    std::vector<double> values;
    for (std::size_t i = from; i < to; ++i) {
        values.push_back(static_cast<double>(figure(rounds[i])));
    }
    return percentile_of(values, fraction);
}

/// False when something grew; prints each comparison.
bool judge(const std::vector<Round>& rounds) {
    // Until each kind of work was done once, caches fill.
    constexpr std::size_t kWarmUp = kRoundsToACalibration;
    if (rounds.size() < kWarmUp + 6) {
        std::cout << "\nToo short to judge: the first rounds fill caches.\n";
        return true;
    }
    const std::size_t third = (rounds.size() - kWarmUp) / 3, end = rounds.size();
    bool steady = true;
    const auto compare = [&](const std::string& what, double allowed, double part, auto figure) {
        const double early = figure_of(rounds, kWarmUp, kWarmUp + third, part, figure);
        const double late = figure_of(rounds, end - third, end, part, figure);
        const bool good = late <= early + allowed * early + 1e-9;
        steady = steady && good;
        std::cout << fmt::format("| {} | {:.1f} | {:.1f} | {:+.1f}% | {} |\n",
                                 what,
                                 early,
                                 late,
                                 100.0 * (late / early - 1.0),
                                 good ? "steady" : "GREW");
    };
    std::cout << "\n| | first third | last third | change | |\n"
                 "| --- | --- | --- | --- | --- |\n";
    compare("memory, MiB, median", kMemoryGrowth, 0.5, [](const Round& r) {
        return r.program.resident_mib + r.program.swapped_mib;
    });
    compare("X server's memory, MiB, median", kMemoryGrowth, 0.5, [](const Round& r) {
        return r.server_mib;
    });
    compare("file descriptors, fewest", kHandleGrowth, 0.0, [](const Round& r) {
        return r.program.descriptors;
    });
    compare(
        "threads, fewest", kHandleGrowth, 0.0, [](const Round& r) { return r.program.threads; });
    compare("paint to projector, ms, median", kFrameGrowth, 0.5, [](const Round& r) {
        return r.median_ms;
    });
    return steady;
}

/// Exit code.
int run(double minutes) {
    const TemporaryFolder folder;
    prepare_session(folder / "session.livery", Quality::normal, kFullProjector_px);
    Desktop desktop;
    Soak soak(desktop, folder.path());
    std::cout << "| round | minutes | MiB | swapped MiB | descriptors | threads | mappings | X "
                 "server MiB | paint median ms | 95% | shown |\n"
                 "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    std::vector<Round> rounds;
    try {
        while (rounds.empty() || rounds.back().minutes < minutes) {
            rounds.push_back(soak.round(static_cast<int>(rounds.size())));
            print(rounds.back(), static_cast<int>(rounds.size()));
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n%s\n", error.what(), soak.words().c_str());
        return 1;
    }
    const bool steady = judge(rounds);
    const int code = soak.quit();
    std::cout << fmt::format("\nThe program quit with {}.\n", code);
    return steady && code == 0 ? 0 : 1;
}

}  // namespace
}  // namespace livery

int main(int count, char** values) {
    char* end = nullptr;
    const double minutes = count == 2 ? std::strtod(values[1], &end) : 0.0;
    if (count != 2 || *end != '\0' || !(minutes > 0.0)) {
        std::fprintf(stderr, "usage: desktop_soak MINUTES\n");
        return 2;
    }
    try {
        return livery::run(minutes);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
