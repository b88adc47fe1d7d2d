// Files as this program writes them, which tests of later programs open (tests/data/old):
//     desktop_old_files FOLDER
// A session with steps to undo and redo, a calibration of a small bench, and votes: a presented
// round with phones, its duel, and a round on paper. By the command line, and in the window on two
// monitors. FOLDER is named in the session.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/json.h"
#include "core/paths.h"
#include "desktop/studio_program.h"
#include "evaluation/ballots.h"
#include "scene/view.h"
#include "support/ballot_phone.h"
#include "support/desktop.h"
#include "support/run_program.h"
#include "support/small_bench_file.h"
#include "twin/description.h"

namespace livery {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::BallotPhone;

/// Looks are shown as shortly as can be.
constexpr const char* kSettings = R"({"format_version": 1, "settings": {
  "presenting-adapt-s": "0.5", "presenting-look-s": "0.5", "presenting-grey-s": "0.5",
  "presenting-passes": "2", "presenting-seed": "7", "presenting-least": "yes",
  "presenting-asks-scales": "yes", "presenting-scales": ";cheap,precious;calm,lively;",
  "phones-port": "0"
}})";

void run(const std::vector<std::string>& arguments) {
    const ProgramRun run = run_program(LIVERY_PROGRAM, arguments);
    if (run.exit_code == 0) return;
    throw std::runtime_error(fmt::format("livery {}: {}", fmt::join(arguments, " "), run.err));
}

/// High enough for the whole ballot panel.
constexpr glm::ivec2 kWindow{1280, 1200};

/// Pixels of the projector: hardly more than a calibration takes.
constexpr int kWidth = 64, kHeight = 40;

/// A calibration by a capture on a bench with few pixels; its folder.
fs::path calibrated(const fs::path& folder) {
    const fs::path bench = testing::small_bench_file(folder, 0.05, 0.09);
    const fs::path pose = folder / "projector.json", calibration = folder / "calibration";
    const View projector = read_bench_file(bench).projector.view;
    if (projector.width != kWidth || projector.height != kHeight) {
        throw std::runtime_error("the small bench has another projector");
    }
    write_camera_file(pose, projector);
    run({"capture",
         "--camera",
         "bench:" + bench.string(),
         "--no-preflight",
         "--product",
         "car",
         "--pose",
         pose.string(),
         "--effort",
         "quick",
         "--out",
         (folder / "captures").string(),
         "--calibration",
         calibration.string()});
    return calibration;
}

/// The last two of the steps are undone.
void make_session(const fs::path& folder, const fs::path& calibration) {
    const auto file = folder / "session.livery";
    run({"session", "new", file.string()});
    std::vector<std::string> all = {"session", "apply", file.string()};
    const auto add = [&](const std::string& command) {
        all.insert(all.end(), {"--command", command});
    };
    add(Json{{"set-calibration", {{"folder", calibration.string()}}}}.dump());
    std::ifstream commands(fs::path(LIVERY_TEST_DATA) / "old/commands.jsonl");
    for (std::string command; std::getline(commands, command);) add(command);
    run(all);
    run({"session", "undo", file.string(), "--steps", "2"});
}

/// Votes in the window.
class Vote {
  public:
    explicit Vote(const fs::path& folder)
        : desktop_({kWindow, {kWidth, kHeight}, false}),
          program_(desktop_, {folder / "session.livery", kWindow}),
          store_(folder / "ballots.sqlite") {
        program_.click("projector-monitor");
        program_.click("monitor:2");
        program_.move_away();
        program_.click("menu:File");
        program_.click("menu:ballot");
        program_.click("phones:start");
        std::string url;
        const auto invited = [&] {
            url = program_.state("phones");
            return !url.empty() && store_.session() && store_.invitation(*store_.session());
        };
        if (!wait_until(invited, 60s)) throw std::runtime_error("no phones are let in");
        url += "join/" + store_.invitation(store_.session().value())->token;
        for (int phone = 0; phone < 3; ++phone) phones_.emplace_back(url);
    }

    /// Three phones, of which one changes its ballot and one its answers on scales, and one name.
    void first_round() {
        program_.click("ballot:present");
        const Round round = presented();
        const auto code = [&](std::size_t design) { return round.codes.at(design); };
        check(phones_[0].vote(round.id, code(0), code(1)));
        check(phones_[1].vote(round.id, code(2), code(1)));
        check(phones_[1].vote(round.id, code(0), code(2)));
        check(phones_[2].vote(round.id, code(1), code(0)));
        check(phones_[0].rate(round.id, code(0), {6, 2}));
        check(phones_[0].rate(round.id, code(0), {7, std::nullopt}));
        check(phones_[2].rate(round.id, code(1), {1, 4}));
        type_in("Bo", 1, 0, 2);
        lock();
    }

    /// One repeat of the first two, which all but one like alike.
    void repeat(bool first) {
        program_.click(first ? "duel:begin" : "duel:next");
        const Round round = presented();
        for (std::size_t phone = 0; phone < phones_.size(); ++phone) {
            const std::size_t best = phone == 2 ? 1 : 0;
            check(phones_[phone].vote(round.id, round.codes.at(best), round.codes.at(1 - best)));
        }
        lock();
    }

    void leave() {
        program_.click("ballot:report");
        program_.click("vote:done");
        program_.click("ballot:close-panel");
        program_.press_key("3");
        if (program_.quit() != 0) throw std::runtime_error("the window ended badly");
    }

  private:
    static void check(int status) {
        if (status != 200) throw std::runtime_error(fmt::format("a phone got {}", status));
    }
    void come_to(const char* state, const char* value) {
        if (!wait_until([&] { return program_.state(state) == value; }, 300s)) {
            throw std::runtime_error(fmt::format("{} does not become {}", state, value));
        }
    }
    /// When all looks were shown and people may vote.
    Round presented() {
        come_to("vote_frame", "rest");
        program_.click("vote:next");
        come_to("vote", "voting");
        return store_.open_round().value();
    }
    void type_in(const std::string& name, int best, int second, int least) {
        program_.click("ballot:type-in");
        program_.click("ballot:name");
        desktop_.type(name);
        program_.click(fmt::format("ballot:best:{}", best));
        program_.click(fmt::format("ballot:second:{}", second));
        program_.click(fmt::format("ballot:least:{}", least));
        program_.click("ballot:confirm");
        program_.click("ballot:overview");
    }
    void lock() {
        program_.click("vote:lock");
        program_.click("vote:confirm");
        come_to("vote", "locked");
    }

    Desktop desktop_;
    StudioProgram program_;
    BallotStore store_;
    std::vector<BallotPhone> phones_;
};

void make_all(const fs::path& folder) {
    make_output_folder(folder);
    write_text_file(folder / "desktop.json", kSettings);
    ::setenv("LIVERY_HOME", folder.c_str(), 1);
    make_session(folder, calibrated(folder));
    {
        Vote vote(folder);
        vote.first_round();
        for (int k = 0; k < 3; ++k) vote.repeat(k == 0);
        vote.leave();
    }
    const std::string ballots = (folder / "ballots.sqlite").string();
    const auto papers = [&](const char* text) {
        write_text_file(folder / "papers.csv", text);
        return (folder / "papers.csv").string();
    };
    run({"evaluate",
         "vote",
         "--ballots",
         ballots,
         "--designs",
         "red,silver,ivory",
         "--codes",
         "481,376,912",
         "--least",
         "--in",
         papers("paper,best,second,least\n1,481,376,\n2,376,912,481\n")});
    run({"evaluate",
         "vote",
         "--ballots",
         ballots,
         "--in",
         papers("paper,best,second\n1,912,376\n"),
         "--lock"});
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("desktop_old_files FOLDER\n", stderr);
        return 2;
    }
    try {
        livery::make_all(std::filesystem::absolute(argv[1]));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
