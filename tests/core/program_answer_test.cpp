// Programs that answer, fail, crash, hang and never stop talking.
#include <gtest/gtest.h>

#include "core/system/programs.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

/// A shell in place of a program of ours: an absolute path stands for itself.
ProgramAnswer answer_of(const std::string& script, std::chrono::milliseconds limit = 60s) {
    return AskedProgram("/bin/sh", {"-c", script}).answer(limit);
}

TEST(ProgramAnswer, HasWhatWasPrintedOnBothStreams) {
    const ProgramAnswer answer = answer_of("echo one; echo two >&2");
    EXPECT_EQ(answer.text, "one\ntwo\n");
    EXPECT_EQ(answer.problem, "");
}

TEST(ProgramAnswer, SaysHowItFailed) {
    EXPECT_EQ(answer_of("exit 3").problem, "it ended with 3");
    EXPECT_NE(answer_of("kill -SEGV $$").problem.find("Segmentation fault"), std::string::npos);
    const ProgramAnswer absent = AskedProgram("no-such-program", {}).answer(60s);
    EXPECT_NE(absent.problem.find("no-such-program"), std::string::npos) << absent.problem;
}

TEST(ProgramAnswer, OneThatHangsIsKilledAndKeepsWhatItSaid) {
    const ProgramAnswer answer = answer_of("echo begun; exec sleep 600", 300ms);
    EXPECT_EQ(answer.text, "begun\n");
    EXPECT_EQ(answer.problem, "it gave no answer in 0.3 s");
    EXPECT_EQ(answer_of("yes").problem, "it went on for more than a megabyte");
}

TEST(ProgramAnswer, StopsWhenItIsToldTo) {
    const std::atomic<bool> stop{true};
    Progress progress;
    progress.stop = &stop;
    AskedProgram asked("/bin/sh", {"-c", "exec sleep 600"});
    EXPECT_THROW(asked.answer(600s, progress), Cancelled);
}

TEST(ProgramAnswer, SeveralAreAskedAtOnce) {
    // The second answers only once the first has made the file that it waits for.
    const std::string file = "/tmp/livery-answer-" + std::to_string(::getpid());
    AskedProgram second("/bin/sh", {"-c", "until [ -e " + file + " ]; do sleep .01; done; echo 2"});
    AskedProgram first("/bin/sh", {"-c", "touch " + file + "; echo 1"});
    EXPECT_EQ(second.answer(60s).text, "2\n");
    EXPECT_EQ(first.answer(60s).text, "1\n");
    ::unlink(file.c_str());
}

}  // namespace
}  // namespace livery
