// A vote of ten from the window's menu to the report, with phones in Chromium: what the operator
// has to do for it.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "desktop/two_monitors.h"
#include "evaluation/ballots.h"
#include "support/child_process.h"

namespace livery {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Looks are shown for as long as a test can wait: how long people look is not the operator's work.
constexpr const char* kSettings = R"({"format_version": 1, "settings": {
  "presenting-adapt-s": "1", "presenting-look-s": "0.5", "presenting-grey-s": "0.5",
  "presenting-passes": "1", "presenting-seed": "7", "phones-port": "0"
}})";

class VoteOfTen : public TwoMonitors {
  protected:
    void SetUp() override {
        start_at_home(kSettings);
        pick_projector();
    }

    /// As the operator does it: counted.
    void click(const std::string& item) {
        ++clicks;
        program->click(item);
    }

    /// Once more where what stands there has just moved, as a person would.
    bool click_until(const std::string& item, const std::function<bool()>& done) {
        for (int k = 0; k < 3; ++k) {
            click(item);
            if (wait_until(done, 30s)) return true;
        }
        return false;
    }

    int clicks = 0;
};

TEST_F(VoteOfTen, FromTheMenuToTheReport) {
    constexpr int kEvaluators = 10;
    const auto begin = Clock::now();
    click("menu:File");
    click("menu:ballot");
    ASSERT_TRUE(click_until("phones:start", [&] {
        return program->state("phones").get<std::string>().starts_with("http://");
    }));
    const BallotStore store(home / "ballots.sqlite");
    const auto session = store.session();
    ASSERT_TRUE(session);
    ASSERT_TRUE(wait_until([&] { return store.invitation(*session).has_value(); }, 60s));
    std::string url = program->state("phones").get<std::string>();
    if (!url.ends_with('/')) url += '/';
    url += "join/" + store.invitation(*session)->token;

    ChildOptions options;
    options.arguments = {
        LIVERY_SOURCE "/tests/ballot/ten_phones.py", url, std::to_string(kEvaluators), "1"};
    options.output = studio->folder / "phones";
    ChildProcess phones(options);
    const auto said = [&](const std::string& words) {
        return std::filesystem::exists(options.output) &&
               read_text_file(options.output).find(words) != std::string::npos;
    };
    const auto says = [&](const std::string& words) {
        wait_until([&] { return said(words) || !phones.running(); }, 300s);
        return said(words);
    };
    ASSERT_TRUE(says("joined 10")) << tail_of(options.output);
    EXPECT_EQ(store.seats(*session).size(), static_cast<std::size_t>(kEvaluators));
    click("ballot:present");
    const auto presented = Clock::now();
    // Nobody touches anything until the last look was shown
    ASSERT_TRUE(wait_until([&] { return program->state("vote_frame") == "rest"; }, 240s));
    const auto seen = Clock::now();
    click("vote:next");
    program->wait_for_state("vote", "voting");
    ASSERT_TRUE(says("voted 10")) << tail_of(options.output);
    EXPECT_EQ(phones.wait(60s), 0) << tail_of(options.output);
    const int round = store.open_round().value().id;
    EXPECT_EQ(store.voted(round).size(), static_cast<std::size_t>(kEvaluators));
    click("vote:lock");
    click("vote:confirm");
    program->wait_for_state("vote", "locked");
    program->item("ballot:verdict");  // once it is there nothing moves any more
    const auto written = [&]() -> std::filesystem::path {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(home)) {
            if (entry.path().filename() == "report.pdf") return entry.path();
        }
        return {};
    };
    ASSERT_TRUE(click_until("ballot:report", [&] { return !written().empty(); }));
    const auto end = Clock::now();

    EXPECT_EQ(store.ballots(round).size(), static_cast<std::size_t>(kEvaluators));
    EXPECT_TRUE(read_text_file(written()).starts_with("%PDF-"));
    const auto page = written().parent_path() / "report.html";
    const std::vector<int> codes = store.last_round(*session).value().codes;
    for (const int code : codes) {
        EXPECT_NE(read_text_file(page).find(std::to_string(code)), std::string::npos) << code;
    }
    const auto seconds = [](auto duration) {
        return std::chrono::duration<double>(duration).count();
    };
    std::printf(
        "    %d clicks of the operator; %.0f s from the menu to the report, %.0f s of them "
        "presenting\n",
        clicks,
        seconds(end - begin),
        seconds(seen - presented));
    EXPECT_LE(clicks, 10);
}

}  // namespace
}  // namespace livery
