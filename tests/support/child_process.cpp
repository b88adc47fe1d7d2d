#include "support/child_process.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace livery {
namespace {

/// Environment of the test with the child's entries in it, as execvpe wants it.
std::vector<std::string> environment_of(const ChildOptions& options) {
    std::vector<std::string> entries;
    for (char** entry = environ; *entry; ++entry) {
        const std::string text = *entry;
        if (!options.environment.contains(text.substr(0, text.find('=')))) entries.push_back(text);
    }
    for (const auto& [name, value] : options.environment) entries.push_back(name + "=" + value);
    return entries;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (auto& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

}  // namespace

ChildProcess::ChildProcess(const ChildOptions& options) {
    // Everything that allocates happens before fork: the test has threads.
    auto arguments = options.arguments;
    auto environment = environment_of(options);
    const auto argv = pointers_to(arguments);
    const auto envp = pointers_to(environment);
    const std::string output = options.output.string();
    const pid_t parent = ::getpid();

    id_ = ::fork();
    if (id_ < 0) throw std::runtime_error(std::string("cannot fork: ") + std::strerror(errno));
    if (id_ > 0) return;

    // Dies with the test, also when that crashes.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    const int null = ::open("/dev/null", O_RDONLY);
    ::dup2(null, STDIN_FILENO);
    if (!output.empty()) {
        const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
        ::dup2(file, STDOUT_FILENO);
        ::dup2(file, STDERR_FILENO);
    }
    for (int descriptor = 3; descriptor < 1024; ++descriptor) {
        if (descriptor != options.kept_descriptor) ::close(descriptor);
    }
    ::execvpe(argv[0], argv.data(), envp.data());
    ::dprintf(STDERR_FILENO, "cannot start %s: %s\n", argv[0], std::strerror(errno));
    ::_exit(127);
}

ChildProcess::~ChildProcess() {
    if (!running()) return;
    ::kill(id_, SIGKILL);
    int status = 0;
    ::waitpid(id_, &status, 0);
}

bool ChildProcess::running() {
    if (exit_code_) return false;
    int status = 0;
    if (::waitpid(id_, &status, WNOHANG) != id_) return true;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return false;
}

void ChildProcess::send(int signal) {
    if (running()) ::kill(id_, signal);
}

std::optional<int> ChildProcess::wait(std::chrono::milliseconds timeout) {
    wait_until([this] { return !running(); }, timeout);
    return exit_code_;
}

std::string tail_of(const std::filesystem::path& file, std::size_t lines) {
    std::ifstream stream(file);
    if (!stream) return "(no " + file.string() + ")";
    std::deque<std::string> last;
    for (std::string line; std::getline(stream, line);) {
        last.push_back(line);
        if (last.size() > lines) last.pop_front();
    }
    std::string text;
    for (const auto& line : last) text += line + "\n";
    return text;
}

void sleep_ms(int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

}  // namespace livery
