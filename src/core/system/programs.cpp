#include "core/system/programs.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/paths.h"

namespace livery {

pid_t start_program(const std::string& name,
                    std::vector<std::string> arguments,
                    const std::vector<std::pair<int, int>>& files,
                    const char* called) {
    const std::filesystem::path program = executable_folder() / name;
    arguments.insert(arguments.begin(), program.string());
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    for (const auto& [ours, its] : files) ::posix_spawn_file_actions_adddup2(&actions, ours, its);
    pid_t id = -1;
    const int failure =
        ::posix_spawn(&id, program.c_str(), &actions, nullptr, words.data(), ::environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) throw FileError(program, "", std::strerror(failure), called);
    return id;
}

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t kLongestAnswer_bytes = 1u << 20u;
constexpr milliseconds kAfterItsLastWord{1000}, kBetweenLooks{50};

/// Its status; nothing where it has not ended by then: a driver may hold it in the kernel.
std::optional<int> status_of(pid_t id, Clock::time_point until) {
    int status = 0;
    while (true) {
        const pid_t ended = ::waitpid(id, &status, WNOHANG);
        if (ended == id) return status;
        if ((ended < 0 && errno != EINTR) || Clock::now() >= until) return std::nullopt;
        std::this_thread::sleep_for(milliseconds(5));
    }
}

std::string problem_of(int status) {
    if (WIFSIGNALED(status)) return fmt::format("it ended by {}", ::strsignal(WTERMSIG(status)));
    if (WEXITSTATUS(status) != 0) return fmt::format("it ended with {}", WEXITSTATUS(status));
    return "";
}

}  // namespace

AskedProgram::AskedProgram(const std::string& name, const std::vector<std::string>& arguments)
    : started_(Clock::now()) {
    std::array<int, 2> ends{-1, -1};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        not_started_ = std::string("cannot make a pipe: ") + std::strerror(errno);
        return;
    }
    output_ = ends[0];
    try {
        id_ = start_program(
            name, arguments, {{ends[1], STDOUT_FILENO}, {ends[1], STDERR_FILENO}}, "a program");
    } catch (const std::exception& error) {
        not_started_ = error.what();
    }
    ::close(ends[1]);
}

AskedProgram::~AskedProgram() {
    if (output_ >= 0) ::close(output_);
    if (id_ < 0) return;
    ::kill(id_, SIGKILL);
    status_of(id_, Clock::now() + kAfterItsLastWord);
}

ProgramAnswer AskedProgram::answer(milliseconds limit, const Progress& progress) {
    ProgramAnswer answer;
    if (id_ < 0) {
        answer.problem = not_started_;
        return answer;
    }
    const auto until = started_ + limit;
    bool ended = false, late = false;
    std::array<char, 4096> block{};
    while (!ended && !late && answer.text.size() <= kLongestAnswer_bytes) {
        progress.check_stop();
        pollfd waiting{output_, POLLIN, 0};
        const int ready = ::poll(&waiting, 1, static_cast<int>(kBetweenLooks.count()));
        late = ready == 0 && Clock::now() >= until;
        if (ready <= 0) continue;
        const auto count = ::read(output_, block.data(), block.size());
        if (count > 0) answer.text.append(block.data(), static_cast<std::size_t>(count));
        ended = count == 0 || (count < 0 && errno != EINTR);
    }
    if (!ended) ::kill(id_, SIGKILL);
    const auto status = status_of(id_, Clock::now() + kAfterItsLastWord);
    if (late) {
        answer.problem = fmt::format("it gave no answer in {:g} s",
                                     std::chrono::duration<double>(limit).count());
    } else if (!ended) {
        answer.problem = "it went on for more than a megabyte";
    } else {
        answer.problem = status ? problem_of(*status) : "it closed its answer and hangs";
    }
    if (status) id_ = -1;
    return answer;
}

}  // namespace livery
