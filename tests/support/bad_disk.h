// Disks that refuse: full ones, and places of other people.
#pragma once

#include <csignal>
#include <cstdlib>

#include <sys/resource.h>
#include <unistd.h>

namespace livery {

/// For its life this process cannot write past `bytes` of any file: a disk that is full.
class FullDisk {
  public:
    explicit FullDisk(rlim_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &before_);
        rlimit limit = before_;
        limit.rlim_cur = bytes;
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, SIG_DFL);
    }

  private:
    rlimit before_{};
};

/// For its life an ordinary user: root may write everywhere.
class OrdinaryUser {
  public:
    OrdinaryUser() {
        if (::geteuid() == 0) changed_ = ::seteuid(65534) == 0;
    }
    ~OrdinaryUser() {
        if (changed_ && ::seteuid(0) != 0) std::abort();
    }

  private:
    bool changed_ = false;
};

}  // namespace livery
