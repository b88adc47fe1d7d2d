#include "capture/camera_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/log.h"
#include "core/system/start_program.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kGoodbye = std::chrono::milliseconds(1000);

void close_file(int& file) {
    if (file >= 0) ::close(std::exchange(file, -1));
}

/// A pipe's two ends; those that were not handed on are closed.
struct Pipe {
    std::array<int, 2> ends{-1, -1};
    Pipe() {
        if (::pipe2(ends.data(), O_CLOEXEC) == 0) return;
        throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    }
    ~Pipe() {
        for (int& end : ends) close_file(end);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
};

/// Writing to a process that has ended is an answer, not this program's end.
class NoBrokenPipe {
  public:
    NoBrokenPipe() {
        ::sigemptyset(&broken_);
        ::sigaddset(&broken_, SIGPIPE);
        ::pthread_sigmask(SIG_BLOCK, &broken_, &before_);
    }
    ~NoBrokenPipe() {
        const timespec now{};
        while (::sigtimedwait(&broken_, nullptr, &now) == SIGPIPE) continue;
        ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    NoBrokenPipe(const NoBrokenPipe&) = delete;
    NoBrokenPipe& operator=(const NoBrokenPipe&) = delete;

  private:
    sigset_t broken_{}, before_{};
};

}  // namespace

void CameraProcess::start() {
    Pipe requests, answers;
    id_ = start_program("livery-camera",
                        {},
                        {{requests.ends[0], STDIN_FILENO}, {answers.ends[1], STDOUT_FILENO}},
                        "the program that talks to cameras");
    requests_ = std::exchange(requests.ends[1], -1);
    answers_ = std::exchange(answers.ends[0], -1);
}

CameraFault CameraProcess::broken_off(const std::string& camera, const std::string& said) {
    const std::string how = said.empty() ? ended() : said;
    end();
    log_line(LogLevel::warning, "livery-camera ended: " + how);
    return {CameraTrouble::gone,
            fmt::format("{}: what it said has ended the camera's library ({})", camera, how),
            "it is started again; if that goes on, switch the camera off and on, and let it name "
            "its files otherwise"};
}

std::string CameraProcess::ended() {
    int status = 0;
    ::kill(id_, SIGKILL);  // It may have closed its answers and hang.
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) continue;
    id_ = -1;
    end();
    return WIFSIGNALED(status) ? fmt::format("by {}", ::strsignal(WTERMSIG(status)))
                               : fmt::format("with {}", WEXITSTATUS(status));
}

CameraAnswer CameraProcess::ask(const CameraRequest& request, std::chrono::milliseconds deadline) {
    if (id_ < 0) start();
    const auto until = Clock::now() + deadline;
    std::optional<CameraMessage> answer;
    {
        const NoBrokenPipe not_broken;
        if (send_message(requests_, message_of(request))) answer = receive_message(answers_, until);
    }
    if (!answer && Clock::now() >= until) {
        end();
        throw CameraFault(
            CameraTrouble::silent,
            fmt::format("{} has not answered for {:.1f} s",
                        request.camera,
                        std::chrono::duration<double>(deadline).count()),
            "wake it, switch its automatic power-off off, take its lens cap off and focus by hand; "
            "if it hangs, switch it off and on");
    }
    if (!answer) throw broken_off(request.camera, "");
    CameraAnswer result;
    try {
        result = answer_in(*answer);
    } catch (const FileError& error) {
        // It has overwritten its own memory.
        throw broken_off(request.camera, error.what());
    }
    if (!result.fault) return result;
    const CameraTrouble trouble = result.fault->trouble();
    const bool anew = trouble == CameraTrouble::gone || trouble == CameraTrouble::held ||
                      trouble == CameraTrouble::silent;
    if (anew) end();
    throw CameraFault(*result.fault);
}

void CameraProcess::end() {
    close_file(requests_);
    close_file(answers_);
    if (id_ < 0) return;
    const auto give_up = Clock::now() + kGoodbye;
    while (::waitpid(id_, nullptr, WNOHANG) == 0) {
        if (Clock::now() >= give_up) {
            ::kill(id_, SIGKILL);
            ::waitpid(id_, nullptr, 0);
            break;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    id_ = -1;
}

}  // namespace livery
