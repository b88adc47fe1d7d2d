#include "studio/kit/running_window.h"

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <thread>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "core/hash.h"
#include "core/log.h"

namespace livery {

namespace {

constexpr int kPatience_ms = 2000;

/// Closed with the object.
class Descriptor {
  public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return number_; }
    bool is_open() const { return number_ >= 0; }

  private:
    int number_;
};

/// In Linux's abstract names, which are gone with the program however it ends. By the session's
/// whole path, which may be longer than a socket's name.
socklen_t name_of(const std::filesystem::path& session, sockaddr_un& address) {
    std::error_code unknown;
    auto whole = std::filesystem::weakly_canonical(session, unknown);
    if (unknown) whole = std::filesystem::absolute(session);
    Hasher hasher;
    hasher.add(whole.string());
    const std::string name = "livery-" + std::to_string(::getuid()) + "-" + hasher.hex();
    address = {};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path + 1, name.data(), name.size());
    return static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
}

bool is_of_this_user(int connection) {
    ucred peer{};
    socklen_t size = sizeof peer;
    return ::getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
           peer.uid == ::getuid();
}

bool comes_in(int descriptor, int patience_ms) {
    pollfd waiting{descriptor, POLLIN, 0};
    return ::poll(&waiting, 1, patience_ms) == 1;
}

}  // namespace

struct RunningWindow::State {
    Descriptor listening{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    Descriptor ending{::eventfd(0, EFD_CLOEXEC)};
    std::function<void()> on_asked;
    std::thread thread;

    void run() {
        while (true) {
            pollfd waiting[2] = {{listening.get(), POLLIN, 0}, {ending.get(), POLLIN, 0}};
            if (::poll(waiting, 2, -1) < 0 && errno != EINTR) return;
            if (waiting[1].revents != 0) return;
            if (waiting[0].revents == 0) continue;
            const Descriptor connection(::accept4(listening.get(), nullptr, nullptr, SOCK_CLOEXEC));
            if (!connection.is_open() || !is_of_this_user(connection.get())) continue;
            on_asked();
            [[maybe_unused]] const ssize_t told =
                ::send(connection.get(), "k", 1, MSG_NOSIGNAL | MSG_DONTWAIT);
        }
    }
};

RunningWindow::RunningWindow(const std::filesystem::path& session, std::function<void()> on_asked)
    : state_(std::make_unique<State>()) {
    state_->on_asked = std::move(on_asked);
    sockaddr_un address{};
    const socklen_t size = name_of(session, address);
    const int listening = state_->listening.get();
    const bool heard = state_->ending.is_open() && listening >= 0 &&
                       ::bind(listening, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                       ::listen(listening, 4) == 0;
    if (!heard) {
        log_line(LogLevel::warning,
                 std::string("a second start will not find this window: ") + std::strerror(errno));
        return;
    }
    state_->thread = std::thread([state = state_.get()] { state->run(); });
}

RunningWindow::~RunningWindow() {
    if (!state_->thread.joinable()) return;
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t told = ::write(state_->ending.get(), &one, sizeof one);
    state_->thread.join();
}

bool ask_running_window(const std::filesystem::path& session) {
    sockaddr_un address{};
    const socklen_t size = name_of(session, address);
    const Descriptor connection(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (!connection.is_open() ||
        ::connect(connection.get(), reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        !is_of_this_user(connection.get())) {
        return false;
    }
    char answer = 0;
    return comes_in(connection.get(), kPatience_ms) &&
           ::recv(connection.get(), &answer, 1, 0) == 1 && answer == 'k';
}

}  // namespace livery
