// Prints how long an input takes to reach the projector's picture, as a table for
// docs/performance.md. Not a test: figures depend on the machine and what else it does.

#include <chrono>
#include <cstdio>
#include <functional>
#include <iostream>
#include <optional>

#include <fmt/format.h>

#include "desktop/prepared.h"
#include "desktop/studio_program.h"
#include "desktop/trace_latency.h"
#include "session/session.h"

namespace livery {
namespace {

constexpr int swaps = 60;
/// As somebody goes who looks at each paint, and as somebody who sweeps over them.
constexpr int looking_ms = 600, sweeping_ms = 150;

void print_row(const std::string& what, const std::vector<std::optional<double>>& answers) {
    std::vector<double> ms;
    for (const auto& answer : answers) {
        if (answer) ms.push_back(*answer);
    }
    if (ms.empty()) {
        std::cout << fmt::format("| {} | none of {} was shown | | | |\n", what, answers.size());
        return;
    }
    std::cout << fmt::format("| {} | {} of {} | {:.0f} | {:.0f} | {:.0f} |\n",
                             what,
                             ms.size(),
                             answers.size(),
                             percentile_of(ms, 0.5),
                             percentile_of(ms, 0.95),
                             percentile_of(ms, 1.0))
              << std::flush;
}

class Bench {
  public:
    Bench(Desktop& desktop, const std::filesystem::path& session) : desktop_(desktop) {
        start_s_ = trace_now_s();
        program_ =
            std::make_unique<StudioProgram>(desktop, StudioStart{session, {1280, 800}, 1.0, {}});
    }

    StudioProgram& program() { return *program_; }

    /// From the start of the program to its first picture on the projector.
    double first_picture_s() {
        std::optional<double> shown;
        const bool there = wait_until(
            [&] {
                for (const auto& line : program_->trace()) {
                    if (line.event == "shown" && line.number > 0 && !shown) shown = line.t_s;
                }
                return shown.has_value();
            },
            std::chrono::seconds(120));
        if (!there) throw std::runtime_error("no picture came to the projector");
        return *shown - start_s_;
    }

    /// The pointer goes from swatch to swatch; each shows its paint on the mock-up.
    std::vector<double> swap_paints(int count,
                                    int between_ms,
                                    const std::function<void(int)>& before_each = {}) {
        std::vector<glm::ivec2> swatches;
        for (int tries = 0; tries < 50 && swatches.size() < 2; ++tries) {
            sleep_ms(100);  // a tab was just opened
            for (const auto& name : program_->items_starting_with("paint:")) {
                const Rectangle place = program_->item(name);
                if (place.height > 20) swatches.push_back(middle(place));
            }
        }
        if (swatches.size() < 2) throw std::runtime_error("the paints are not in sight");
        std::vector<double> moments;
        for (int i = 0; i < count; ++i) {
            if (before_each) before_each(i);
            const auto& at = swatches[static_cast<std::size_t>(i) % swatches.size()];
            moments.push_back(trace_now_s());
            desktop_.move_pointer(at.x, at.y);
            sleep_ms(between_ms);
        }
        return moments;
    }

    std::vector<double> swap_looks(int count) {
        std::vector<double> moments;
        for (int i = 0; i < count; ++i) {
            const std::string key = std::to_string(1 + (i + 1) % 4);
            moments.push_back(trace_now_s());
            desktop_.hold_key(key);
            sleep_ms(looking_ms / 3);
            desktop_.release_key(key);
            sleep_ms(looking_ms - looking_ms / 3);
        }
        return moments;
    }

    void save_picture(const std::string& file) {
        desktop_.press_key("ctrl+s");
        program_->click("save-picture:what-1");
        program_->click("file-dialog:path");
        desktop_.press_key("ctrl+a");
        desktop_.type(file);
        program_->click("file-dialog:ok");
    }

    void report(const std::string& what, const std::vector<double>& moments) {
        // The last one's answer may still be on its way.
        sleep_ms(500);
        print_row(what, to_projector_ms(program_->trace(), moments));
    }

    /// Nothing is drawn, solved or prepared any more.
    void wait_until_idle() {
        std::size_t lines = 0;
        for (int quiet = 0; quiet < 20; ++quiet) {
            sleep_ms(100);
            const auto count = program_->trace().size();
            if (count != lines) quiet = 0;
            lines = count;
        }
    }

  private:
    Desktop& desktop_;
    std::unique_ptr<StudioProgram> program_;
    double start_s_ = 0.0;
};

void run() {
    const TemporaryFolder folder;
    const auto session = folder / "session.livery";
    prepare_session(session, Quality::normal, kFullProjector_px);
    Desktop desktop;
    {
        // A designer's second day: the projector is known, shaders are compiled.
        Bench first(desktop, session);
        first.program().click("projector-monitor");
        first.program().click("monitor:2");
        first.program().move_away();
        first.first_picture_s();
        first.wait_until_idle();
        first.program().quit();
    }
    Bench bench(desktop, session);
    std::cout << fmt::format("start to first picture on the projector: {:.1f} s\n\n",
                             bench.first_picture_s());
    std::cout << "| input to projector, ms | shown | median | 95% | longest |\n"
                 "| --- | --- | --- | --- | --- |\n";
    StudioProgram& program = bench.program();
    program.click("part:body");
    program.move_away();
    bench.wait_until_idle();

    bench.report("paint", bench.swap_paints(swaps, looking_ms));
    bench.report("paint, swept over", bench.swap_paints(swaps, sweeping_ms));
    program.move_away();
    bench.report("look", bench.swap_looks(swaps / 2));

    program.click("tab:Calibrate");
    program.click("calibrate");
    program.click("tab:Paints");
    bench.report("paint, bench calibrating", bench.swap_paints(swaps / 2, looking_ms));
    program.wait_for_state("calibrating", false);

    const auto pictures = folder / "picture";
    bench.report("paint, a picture saved every tenth",
                 bench.swap_paints(swaps / 2, looking_ms, [&](int i) {
                     if (i % 10 == 0)
                         bench.save_picture(pictures.string() + std::to_string(i) + ".exr");
                 }));

    program.click("tab:Light");
    program.click("environment");
    program.click("environment:overcast");
    program.click("tab:Paints");
    bench.report("paint, another environment being solved",
                 bench.swap_paints(swaps / 2, looking_ms));
    std::cout << "\nlight was still being solved at the end: " << program.state("solving") << "\n";
}

}  // namespace
}  // namespace livery

int main() {
    try {
        livery::run();
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
