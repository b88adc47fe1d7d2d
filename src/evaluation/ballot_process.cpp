#include "evaluation/ballot_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/system/programs.h"
#include "core/utf8.h"

namespace livery {

namespace {

constexpr std::size_t kLongestLine = 4096;

}  // namespace

BallotProcess::BallotProcess(const BallotProcessOptions& options) {
    std::vector<std::string> words = {"--json",
                                      "--with-parent",
                                      "--ballots",
                                      options.ballots.string(),
                                      "--interface",
                                      options.interface,
                                      "--port",
                                      std::to_string(options.port),
                                      "--seats",
                                      std::to_string(options.seats)};
    for (const std::string& host : options.hosts) words.insert(words.end(), {"--host", host});
    if (!options.certificate.empty()) {
        words.insert(words.end(), {"--certificate", options.certificate});
    }
    if (!options.key.empty()) words.insert(words.end(), {"--key", options.key});
    // Both of its outputs come here: where it listens, or why it does not.
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
        throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    }
    try {
        id_ = start_program("livery-ballots",
                            std::move(words),
                            {{pipe[1], STDOUT_FILENO}, {pipe[1], STDERR_FILENO}},
                            "the program that serves ballots");
    } catch (const FileError&) {
        ::close(pipe[0]);
        ::close(pipe[1]);
        throw;
    }
    ::close(pipe[1]);
    words_ = pipe[0];
}

BallotProcess::~BallotProcess() { stop(); }

bool BallotProcess::listens_within(std::chrono::milliseconds patience) {
    const auto give_up = std::chrono::steady_clock::now() + patience;
    while (!place_) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
            give_up - std::chrono::steady_clock::now());
        pollfd ready{words_, POLLIN, 0};
        const int said = ::poll(
            &ready, 1, static_cast<int>(std::max(left, std::chrono::milliseconds(0)).count()));
        if (said < 0 && errno == EINTR) continue;
        if (said <= 0) return false;
        char c = 0;
        const ssize_t got = ::read(words_, &c, 1);
        if (got < 0 && errno == EINTR) continue;
        const bool whole = got <= 0 || c == '\n' || said_.size() >= kLongestLine;
        if (!whole) {
            said_ += c;
            continue;
        }
        if (!said_.starts_with("{")) {
            stop();
            throw std::runtime_error(said_.empty() ? "livery-ballots: ended without a word"
                                                   : printable(said_, 1000));
        }
        place_ = parse_ballot_place(said_);
        close_words();
    }
    return true;
}

void BallotProcess::close_words() {
    if (words_ >= 0) ::close(std::exchange(words_, -1));
}

bool BallotProcess::running() {
    if (id_ > 0 && ::waitpid(id_, nullptr, WNOHANG) == id_) id_ = -1;
    return id_ > 0;
}

void BallotProcess::stop() {
    close_words();
    if (!running()) return;
    ::kill(id_, SIGTERM);
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    while (running() && std::chrono::steady_clock::now() < give_up) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (!running()) return;
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
    id_ = -1;
}

}  // namespace livery
