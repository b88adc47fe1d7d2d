#include "evaluation/ballot_process.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/paths.h"
#include "core/utf8.h"

namespace livery {

namespace {

constexpr std::chrono::seconds kPatience{10};
constexpr std::size_t kLongestLine = 4096;

/// One line from a pipe: the whole of what is said when it ends before.
std::string first_line(int descriptor) {
    const auto give_up = std::chrono::steady_clock::now() + kPatience;
    std::string line;
    while (line.size() < kLongestLine) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
            give_up - std::chrono::steady_clock::now());
        pollfd ready{descriptor, POLLIN, 0};
        if (left.count() <= 0 || ::poll(&ready, 1, static_cast<int>(left.count())) == 0) break;
        char c = 0;
        const ssize_t got = ::read(descriptor, &c, 1);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0 || c == '\n') break;
        line += c;
    }
    return line;
}

}  // namespace

BallotProcess::BallotProcess(const BallotProcessOptions& options) {
    const std::filesystem::path program = executable_folder() / "livery-ballots";
    std::vector<std::string> words = {program.string(),
                                      "--json",
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
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    // Both of its outputs come here: where it listens, or why it does not.
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
        throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    }
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
    const int failure =
        ::posix_spawn(&id_, program.c_str(), &actions, nullptr, arguments.data(), ::environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(pipe[1]);
    if (failure != 0) {
        ::close(pipe[0]);
        id_ = -1;
        throw FileError(program, "", std::strerror(failure), "the program that serves ballots");
    }
    const std::string line = first_line(pipe[0]);
    ::close(pipe[0]);
    if (!line.starts_with("{")) {
        stop();
        throw std::runtime_error(line.empty() ? "livery-ballots: found no answer within 10 s"
                                              : printable(line, 1000));
    }
    place_ = parse_ballot_place(line);
}

BallotProcess::~BallotProcess() { stop(); }

bool BallotProcess::running() {
    if (id_ > 0 && ::waitpid(id_, nullptr, WNOHANG) == id_) id_ = -1;
    return id_ > 0;
}

void BallotProcess::stop() {
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
