#include "ballot/process_limits.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace livery {

namespace {

constexpr rlim_t kData_bytes = 64u << 20u;
constexpr rlim_t kFile_bytes = 256u << 20u;
constexpr rlim_t kFiles = 640;  ///< 576 connections, the database's, and some

#if defined(LIVERY_SANITIZED)
constexpr bool kSanitized = true;  // whose shadow is larger than any limit
#else
constexpr bool kSanitized = false;
#endif

void set_limit(int resource, rlim_t most, const char* what) {
    rlimit limit{};
    ::getrlimit(static_cast<__rlimit_resource>(resource), &limit);
    if (limit.rlim_max != RLIM_INFINITY && limit.rlim_max < most) most = limit.rlim_max;
    limit = {most, most};
    if (::setrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) {
        throw std::runtime_error(std::string("cannot limit ") + what + " (" + std::strerror(errno) +
                                 ")");
    }
}

}  // namespace

void limit_this_process() {
    // A file that may grow no further is an error, not the end.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    if (!kSanitized) set_limit(RLIMIT_DATA, kData_bytes, "memory");
    set_limit(RLIMIT_FSIZE, kFile_bytes, "files");
    set_limit(RLIMIT_NOFILE, kFiles, "open files");
    set_limit(RLIMIT_CORE, 0, "core files");
    set_limit(RLIMIT_NPROC, 0, "processes");
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
        throw std::runtime_error("cannot give up new rights");
    }
}

void end_with_parent() {
    const pid_t parent = ::getppid();
    if (::prctl(PR_SET_PDEATHSIG, SIGTERM) != 0) {
        throw std::runtime_error("cannot watch the parent process");
    }
    if (::getppid() != parent) ::raise(SIGTERM);
}

}  // namespace livery
