// The phone page: the networks that it may be served on, where it is, how people get there, and its
// server, livery-ballots beside this program, started and watched.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace livery {

struct NetworkInterface {
    std::string name;     ///< "lo", "wlan0"
    std::string address;  ///< IPv4; the first
};

/// Those that have an IPv4 address, in the system's order. Throws std::runtime_error.
std::vector<NetworkInterface> network_interfaces();

struct QrCode {
    int size = 0;                 ///< modules a side, the quiet zone not among them
    std::vector<bool> dark;       ///< row by row
    bool at(int x, int y) const;  ///< false outside: the quiet zone
};

constexpr int kQrQuietZone = 4;  ///< light modules that must stand around it (ISO/IEC 18004)

/// Of level M: 15% of it may be hidden. Throws std::invalid_argument for a text that is empty or
/// too long.
QrCode qr_code(const std::string& text);

/// Two rows of modules a line, with the quiet zone, light on dark: for dark terminals and light
/// ones alike, since its light modules are set as such.
std::string qr_text(const QrCode& code);

constexpr int kBallotPort = 8470;

struct BallotServerPlace {
    std::string address;  ///< IPv4
    std::uint16_t port = 0;
    bool tls = false;
    std::string interface;                ///< "lo": this machine alone
    std::vector<std::string> hosts = {};  ///< further names; the first is the one that is shown
};

/// One line of JSON, and back. Throws FileError for anything else.
std::string text_of(const BallotServerPlace& place);
BallotServerPlace parse_ballot_place(const std::string& line);

/// "http://192.168.0.7:8470/", by the first further name where there is one.
std::string url_of(const BallotServerPlace& place);
/// What the QR code holds.
std::string join_url(const BallotServerPlace& place, const std::string& token);

/// Where it listens, and who can see votes on their way. Lines for people.
std::string words_for(const BallotServerPlace& place);

struct BallotProcessOptions {
    std::filesystem::path ballots;  ///< the votes' file
    std::string interface = "lo";
    int port = kBallotPort;
    std::vector<std::string> hosts = {};
    std::string certificate = {}, key = {};
    int seats = 40;
};

class BallotProcess {
  public:
    /// Starts it, and returns before it listens. Throws FileError when the program cannot be run.
    /// It ends with the thread that started it: the main one, say.
    explicit BallotProcess(const BallotProcessOptions& options);
    /// Ends it.
    ~BallotProcess();
    BallotProcess(const BallotProcess&) = delete;
    BallotProcess& operator=(const BallotProcess&) = delete;

    /// Waits at most that long until it listens, and says whether it does: a busy machine takes its
    /// time. Throws std::runtime_error with what it said when it ended instead.
    bool listens_within(std::chrono::milliseconds patience);
    /// Nothing before listens_within() has said so.
    const std::optional<BallotServerPlace>& place() const { return place_; }
    pid_t id() const { return id_; }
    /// False once it has ended, by itself or killed; votes that it confirmed are in the file.
    bool running();

  private:
    void stop();
    void close_words();
    pid_t id_ = -1;
    int words_ = -1;  ///< both of its outputs, until it has said where it listens
    std::string said_;
    std::optional<BallotServerPlace> place_;
};

}  // namespace livery
