#include "evaluation/phone_page.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <ifaddrs.h>
#include <poll.h>
#include <qrencode.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/json.h"
#include "core/system/programs.h"
#include "core/utf8.h"

namespace livery {

std::vector<NetworkInterface> network_interfaces() {
    ifaddrs* first = nullptr;
    if (::getifaddrs(&first) != 0) throw std::runtime_error("cannot list network interfaces");
    const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(first, &::freeifaddrs);
    std::vector<NetworkInterface> found;
    for (const ifaddrs* entry = first; entry; entry = entry->ifa_next) {
        if (!entry->ifa_addr || entry->ifa_addr->sa_family != AF_INET) continue;
        const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
        char text[INET_ADDRSTRLEN] = {};
        if (!::inet_ntop(AF_INET, &address->sin_addr, text, sizeof text)) continue;
        const bool known = std::any_of(found.begin(), found.end(), [&](const auto& other) {
            return other.name == entry->ifa_name;
        });
        if (!known) found.push_back({entry->ifa_name, text});
    }
    return found;
}

bool QrCode::at(int x, int y) const {
    return x >= 0 && y >= 0 && x < size && y < size &&
           dark[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
                static_cast<std::size_t>(x)];
}

QrCode qr_code(const std::string& text) {
    const std::unique_ptr<QRcode, void (*)(QRcode*)> made(
        QRcode_encodeString(text.c_str(), 0, QR_ECLEVEL_M, QR_MODE_8, 1), &QRcode_free);
    check_argument(
        made != nullptr,
        "qr_code: found " + std::to_string(text.size()) + " bytes, expected 1 to about 2300");
    QrCode code;
    code.size = made->width;
    const std::size_t modules =
        static_cast<std::size_t>(code.size) * static_cast<std::size_t>(code.size);
    for (std::size_t k = 0; k < modules; ++k) code.dark.push_back((made->data[k] & 1u) != 0);
    return code;
}

std::string qr_text(const QrCode& code) {
    std::string text;
    for (int y = -kQrQuietZone; y < code.size + kQrQuietZone; y += 2) {
        // Black on white, whatever the terminal's colours.
        text += "\x1b[30;107m";
        for (int x = -kQrQuietZone; x < code.size + kQrQuietZone; ++x) {
            const bool upper = code.at(x, y), lower = code.at(x, y + 1);
            text += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
        }
        text += "\x1b[0m\n";
    }
    return text;
}

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

// --- where it is ---

std::string text_of(const BallotServerPlace& place) {
    const Json json = {{"address", place.address},
                       {"port", place.port},
                       {"tls", place.tls},
                       {"interface", place.interface},
                       {"hosts", place.hosts},
                       {"url", url_of(place)}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

BallotServerPlace parse_ballot_place(const std::string& line) {
    const Json json = parse_json(line, "livery-ballots");
    const JsonReader reader("livery-ballots", json);
    BallotServerPlace place;
    place.address = reader["address"].text();
    place.port = static_cast<std::uint16_t>(reader["port"].integer(1, 65535));
    place.tls = reader["tls"].boolean();
    place.interface = reader["interface"].text();
    const JsonReader hosts = reader["hosts"];
    for (std::size_t k = 0; k < hosts.size(); ++k) place.hosts.push_back(hosts.at(k).text());
    return place;
}

std::string url_of(const BallotServerPlace& place) {
    const std::string host = place.hosts.empty() ? place.address : place.hosts.front();
    const bool usual = place.port == (place.tls ? 443 : 80);
    return (place.tls ? "https://" : "http://") + host +
           (usual ? std::string() : ":" + std::to_string(place.port)) + "/";
}

std::string join_url(const BallotServerPlace& place, const std::string& token) {
    return url_of(place) + "join/" + token;
}

std::string words_for(const BallotServerPlace& place) {
    std::string words = "The ballots are at " + url_of(place) + "\n";
    if (place.address.starts_with("127.")) {
        return words +
               "Only this machine reaches them; --interface NAME opens a network to them.\n";
    }
    words += "Whoever is on the network of " + place.interface + " reaches them.\n";
    if (!place.tls) {
        words +=
            "This is plain HTTP: whoever can listen to that network can see votes and take "
            "seats; --certificate and --key encrypt them.\n";
    }
    return words;
}

}  // namespace livery
