// livery evaluate, as scripts and people call it.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/ballots.h"
#include "support/run_program.h"

namespace livery {
namespace {

using Json = nlohmann::ordered_json;

ProgramRun evaluate(std::vector<std::string> words) {
    words.insert(words.begin(), "evaluate");
    return run_program(LIVERY_PROGRAM, words);
}

Json figures(std::vector<std::string> words) {
    words.emplace_back("--json");
    const ProgramRun run = evaluate(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const Json json = Json::parse(run.out, nullptr, false);
    EXPECT_FALSE(json.is_discarded()) << run.out;
    return json;
}

TEST(Evaluate, TalliesThePublishedTable) {
    const Json found = figures({"tally", "--best", "1,6,1,2", "--second", "0,3,2,5"});
    EXPECT_EQ(found["best"], Json({1, 6, 1, 2}));
    EXPECT_EQ(found["second"], Json({0, 3, 2, 5}));
    EXPECT_NEAR(found["best_chi_square"], 6.8, 1e-9);
    EXPECT_NEAR(found["best_exact_p"], 0.109, 5e-4);
    EXPECT_NEAR(found["friedman_q"], 11.53, 5e-3);
    EXPECT_NEAR(found["friedman_exact_p"], 0.0059, 5e-5);
    EXPECT_EQ(found["friedman_method"], "exact");
    EXPECT_NEAR(found["kendall_w"], 0.384, 5e-4);
    EXPECT_EQ(found["rank_sums"], Json({32.5, 15.5, 29.5, 22.5}));
    EXPECT_EQ(found["borda"], Json({2, 15, 4, 9}));
    EXPECT_NEAR(found["plackett_luce"][1], 0.607, 5e-4);
    ASSERT_EQ(found["pairs"].size(), 6u);
    const Json& pair = found["pairs"][4];
    EXPECT_EQ(pair["a"], 1);
    EXPECT_EQ(pair["b"], 3);
    EXPECT_EQ(pair["name_b"], "(d)");
    EXPECT_NEAR(pair["odds"], 2.37, 5e-3);
    EXPECT_NEAR(pair["high"], 8.69, 5e-3);
    EXPECT_NEAR(pair["p"], 0.149, 5e-4);
    EXPECT_NEAR(found["p_first"][1], 0.926, 5e-4);
    EXPECT_NEAR(found["p_top_two"], 0.910, 5e-4);
    EXPECT_EQ(found["verdict"].get<std::string>().find("(b) leads, not separated from (d)"), 0u);
    EXPECT_EQ(found["verdict_details"]["kind"], "leading");
}

TEST(Evaluate, TellsPeopleTheSame) {
    const ProgramRun run = evaluate(
        {"tally", "--best", "1,6,1,2", "--second", "0,3,2,5", "--names", "red,silver,sand,blue"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    for (const char* part :
         {"2.37   0.74 to 8.69   0.149",
          "chi-square 6.80          0.109",
          "verdict: silver leads, not separated from blue, and may be no better"}) {
        EXPECT_NE(run.out.find(part), std::string::npos) << part << "\n" << run.out;
    }
    EXPECT_TRUE(run.err.empty()) << run.err;
}

TEST(Evaluate, TakesALeastAndEdgesOfWhatCanBe) {
    const Json least =
        figures({"tally", "--best", "1,6,1,2", "--second", "0,3,2,5", "--least", "6,0,3,1"});
    EXPECT_EQ(least["least"], Json({6, 0, 3, 1}));
    EXPECT_EQ(least["rank_sums"], Json({34.0, 15.0, 29.0, 22.0}));
    EXPECT_EQ(least["plackett_luce_pairs"], "expected");
    const Json nobody = figures({"tally", "--best", "0,0", "--second", "0,0"});
    EXPECT_EQ(nobody["verdict"], "nobody has voted");
    EXPECT_TRUE(nobody["kendall_w"].is_null());
    EXPECT_TRUE(nobody["pairs"].empty());
    EXPECT_EQ(nobody["friedman_exact_p"], 1.0);
    const Json one = figures({"tally", "--best", "0,1,0", "--second", "1,0,0"});
    EXPECT_EQ(one["verdict_details"]["kind"], "one evaluator");
    EXPECT_TRUE(one["plackett_luce_ghost"]);
}

TEST(Evaluate, RefusesCountsThatCannotBe) {
    const auto refused = [](const std::vector<std::string>& words, const std::string& part) {
        std::vector<std::string> all = {"tally"};
        all.insert(all.end(), words.begin(), words.end());
        const ProgramRun run = evaluate(all);
        EXPECT_EQ(run.exit_code, 2) << part;
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
        EXPECT_TRUE(run.out.empty()) << run.out;
        EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    };
    refused({"--best", "1,6,1,2", "--second", "0,3,2,4"}, "--second: found 9 votes, expected 10");
    refused({"--best", "1,6,1,2", "--second", "0,3,7"}, "--second: found 3 counts, expected 4");
    refused({"--best", "6,4", "--second", "6,4"}, "design 1: found 12 votes, expected at most 10");
    refused({"--best=-1,2", "--second", "1,0"}, "--best: found -1, expected counts of 0 or more");
    refused({"--best", "3", "--second", "3"}, "--best: found 1 design, expected 2 to 26");
    refused({"--best", "1.5,2", "--second", "1,2"}, "--best: found \"1.5,2\", expected whole");
    refused({"--best", "", "--second", "1,2"}, "--best: found no counts");
    refused({"--best", "1,2,", "--second", "1,2,0"}, "--best: found \"1,2,\", expected whole");
    refused({"--best", "1,x", "--second", "1,2"}, "--best: found \"1,x\", expected whole");
    refused({"--best", "99999999999,1", "--second", "1,2"}, "--best: found \"99999999999,1\"");
    refused({"--best", "2147483647,2147483647", "--second", "1,2"},
            "--best: found 4294967294 evaluators, expected at most 1000");
    refused({"--best", "1,0", "--second", "0,1", "--least", "0,1"}, "--least: found 2 designs");
    refused({"--best", "1,0,0", "--second", "0,1,0", "--least", "0,1,0"},
            "design 2: found 2 votes");
    refused({"--best", "1,0", "--second", "0,1", "--names", "a"}, "--names: found 1 names");
    refused({"--best", "1,0", "--second", "0,1", "--names", "a,a"}, "--names: found \"a,a\"");
    refused({"--best", "1,0", "--second", "0,1", "--names", "a,"}, "--names: found \"a,\"");
    refused({"--best", "1,0"}, "--second: found no counts");
    refused({}, "--best: found no counts, expected them, or a file");
    refused({"--best", "1,0", "--second", "0,1", "--round", "2"}, "--round: found it without");
    refused({"--best", "1,0", "--ballots", "a"}, "--ballots: found it with counts");
    refused({"--ballots", "/nowhere/votes"}, "/nowhere/votes: found no such file");
}

TEST(Evaluate, OrdersByASeed) {
    const Json order = figures({"order", "--designs", "4", "--seed", "7"});
    EXPECT_EQ(order["rows"], Json::parse("[[0,1,3,2],[1,2,0,3],[2,3,1,0],[3,0,2,1]]"));
    EXPECT_EQ(order["codes"].size(), 4u);
    EXPECT_EQ(order["waves"].size(), 4u);
    EXPECT_TRUE(order["balanced"]);
    EXPECT_EQ(order, figures({"order", "--designs", "4", "--seed", "7", "--threads", "1"}));
    EXPECT_NE(order, figures({"order", "--designs", "4", "--seed", "8"}));
    const Json waves = figures({"order", "--designs", "5", "--evaluators", "10"});
    EXPECT_EQ(waves["rows"].size(), 10u);
    EXPECT_EQ(waves["waves"].size(), 4u);
    EXPECT_FALSE(waves["balanced"]);
    const ProgramRun text = evaluate({"order", "--designs", "3", "--names", "red,silver,sand"});
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_NE(text.out.find("sand"), std::string::npos) << text.out;
    for (const char* designs : {"1", "27", "-4", "x"}) {
        EXPECT_EQ(evaluate({"order", std::string("--designs=") + designs}).exit_code, 2) << designs;
    }
    EXPECT_EQ(evaluate({"order"}).exit_code, 2);
    EXPECT_EQ(evaluate({"order", "--designs", "4", "--wave", "0"}).exit_code, 2);
}

TEST(Evaluate, TellsAndHandsOnARoundOfAFile) {
    const TemporaryFolder folder;
    const auto file = (folder / "votes.livery-ballots").string();
    {
        BallotStore store(file);
        const int round = store.open_round({"a", "b", "c", "d"}, "1234abcd");
        const std::pair<int, int> votes[] = {
            {0, 1}, {1, 3}, {1, 3}, {1, 3}, {1, 3}, {1, 3}, {1, 2}, {2, 1}, {3, 1}, {3, 2}};
        int number = 0;
        for (const auto& [best, second] : votes) {
            store.vote(round, "evaluator " + std::to_string(++number), {best, second});
        }
        EXPECT_EQ(evaluate({"tally", "--ballots", file}).exit_code, 1) << "it is open";
        store.close_round(round);
    }
    const Json found = figures({"tally", "--ballots", file});
    EXPECT_EQ(found["best"], Json({1, 6, 1, 2}));
    EXPECT_EQ(found["round"], 1);
    EXPECT_EQ(found["calibration_id"], "1234abcd");
    EXPECT_EQ(found["verdict_details"]["p_win_from"], "single ballots");
    EXPECT_EQ(found["resampled"]["cases"], 10000);

    const auto json = (folder / "round.json").string(), csv = (folder / "round.csv").string();
    EXPECT_EQ(figures({"export", "--ballots", file, "--out", json, "--seed", "5"})["ballots"], 10);
    const Json written = Json::parse(std::ifstream(json));
    EXPECT_EQ(written["seed"], 5);
    EXPECT_EQ(written["ballots"].size(), 10u);
    EXPECT_EQ(written.dump().find("evaluator"), std::string::npos);
    figures({"export", "--ballots", file, "--round", "1", "--out", csv});
    std::stringstream text;
    text << std::ifstream(csv).rdbuf();
    EXPECT_NE(text.str().find("best,second\r\n"), std::string::npos) << text.str();
    EXPECT_EQ(evaluate({"export", "--ballots", file, "--out", "a.txt"}).exit_code, 2);
    EXPECT_EQ(evaluate({"export", "--ballots", file, "--round", "7", "--out", csv}).exit_code, 2);
}

std::string bytes_of(const std::filesystem::path& file) {
    std::stringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

TEST(Evaluate, ReportsARoundAsAPageAndAsPdf) {
    const TemporaryFolder folder;
    const auto out = folder / "report";
    const Json found = figures({"report",
                                "--best",
                                "1,6,1,2",
                                "--second",
                                "0,3,2,5",
                                "--names",
                                "a<b,silver,サンド,blue",
                                "--out",
                                out.string()});
    EXPECT_NEAR(found["friedman_exact_p"], 0.0059, 5e-5);
    EXPECT_EQ(found["files"], Json({(out / "vote.html").string(), (out / "vote.pdf").string()}));
    const std::string html = bytes_of(out / "vote.html");
    EXPECT_NE(html.find("Silver leads, not separated from blue"), std::string::npos);
    EXPECT_NE(html.find("a&lt;b"), std::string::npos);
    EXPECT_TRUE(bytes_of(out / "vote.pdf").starts_with("%PDF-"));
    EXPECT_GT(found["pdf_pages"], 2);
    const ProgramRun run = evaluate({"report",
                                     "--best",
                                     "1,0",
                                     "--second",
                                     "0,1",
                                     "--title",
                                     "Spring",
                                     "--out",
                                     (folder / "a.html").string()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(bytes_of(folder / "a.html").find("<h1>Spring</h1>"), std::string::npos);
    const auto refused = [&](std::vector<std::string> words, const std::string& part) {
        words.insert(words.begin(), {"report", "--best", "1,0", "--second", "0,1"});
        const ProgramRun bad = evaluate(words);
        EXPECT_EQ(bad.exit_code, 2) << part;
        EXPECT_NE(bad.err.find(part), std::string::npos) << bad.err;
    };
    refused({}, "--out");
    refused({"--out", (folder / "a.doc").string()}, "--out: found");
    refused({"--out", (folder / "none/a.pdf").string()}, "--out");
    refused({"--out", (folder / "a.html").string() + "/b"}, "--out");
    refused({"--out", (folder / "b.html").string(), "--details", "x"}, "--details: found it with");
    EXPECT_FALSE(std::filesystem::exists(folder / "b.html"));
}

TEST(Evaluate, ShowsTheSampleAndSaysThatItIsOne) {
    const TemporaryFolder folder;
    const auto file = folder / "sample.html";
    const Json found = figures({"report", "--sample", "--out", file.string()});
    EXPECT_EQ(found["evaluators"], 24);
    EXPECT_EQ(found["sample"], true);
    const std::string html = bytes_of(file);
    EXPECT_NE(html.find("made-up sample"), std::string::npos);
    EXPECT_NE(html.find("data:image/png"), std::string::npos);
    EXPECT_NE(html.find("Who saw which order, and when"), std::string::npos);
    EXPECT_TRUE(std::regex_search(html, std::regex("[0-9a-f]{32}, of entry [0-9]+, which locked")));
    EXPECT_EQ(figures({"tally", "--sample"})["best"], found["best"]);
    EXPECT_EQ(evaluate({"tally", "--sample", "--best", "1,0", "--second", "0,1"}).exit_code, 2);
}

TEST(Evaluate, TakesBallotsOnPaperAllOrNone) {
    const TemporaryFolder folder;
    const std::string file = (folder / "votes.sqlite").string();
    const auto good = folder.write("good.csv", "paper,best,second\n1,481,376\n2,912,481\n");
    const auto bad = folder.write("bad.csv", "481,376\n481,481\n");
    EXPECT_EQ(evaluate({"vote", "--ballots", file, "--in", good.string()}).exit_code, 2)
        << "there is no such file";
    // A file that is no good opens no round.
    EXPECT_EQ(evaluate({"vote",
                        "--ballots",
                        file,
                        "--designs",
                        "red,silver,sand",
                        "--codes",
                        "481,376,912",
                        "--in",
                        bad.string()})
                  .exit_code,
              2);
    const Json opened = figures({"vote",
                                 "--ballots",
                                 file,
                                 "--designs",
                                 "red,silver,sand",
                                 "--codes",
                                 "481,376,912",
                                 "--in",
                                 good.string()});
    EXPECT_EQ(opened["added"], 2);
    EXPECT_EQ(opened["papers"][1]["paper"], 2);
    EXPECT_EQ(opened["papers"][1]["receipt"].get<std::string>().size(), 8u);
    const ProgramRun wrong = evaluate({"vote", "--ballots", file, "--in", bad.string()});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_NE(wrong.err.find("bad.csv: line 2: found one look twice"), std::string::npos)
        << wrong.err;
    // The same papers once more are the same ballots; then from a pipe.
    const Json again = figures({"vote", "--ballots", file, "--in", good.string()});
    EXPECT_EQ(again["replaced"], 2);
    EXPECT_EQ(again["ballots_in_round"], 2);
    const ProgramRun piped =
        run_program("sh",
                    {"-c",
                     "printf '376 481\\n376 912' | " + std::string(LIVERY_PROGRAM) +
                         " evaluate vote --lock --ballots '" + file + "'"});
    EXPECT_EQ(piped.exit_code, 0) << piped.err;
    EXPECT_NE(piped.out.find("2 added, 0 replaced; round 1 holds 4 ballots and is locked"),
              std::string::npos)
        << piped.out;
    EXPECT_EQ(figures({"tally", "--ballots", file})["best"], Json({1, 2, 1}));
    const ProgramRun late = evaluate({"vote", "--ballots", file, "--in", good.string()});
    EXPECT_EQ(late.exit_code, 1) << "no round is open";
    EXPECT_EQ(
        evaluate({"vote", "--ballots", file, "--round", "1", "--in", good.string()}).exit_code, 1);
    EXPECT_EQ(
        evaluate({"vote", "--ballots", file, "--round", "7", "--in", good.string()}).exit_code, 2);
    EXPECT_EQ(evaluate({"vote", "--ballots", file, "--codes", "100,200", "--in", good.string()})
                  .exit_code,
              2);
}

}  // namespace
}  // namespace livery
