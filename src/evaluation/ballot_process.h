// The phone page's server, started and watched: livery-ballots beside this program.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "evaluation/ballot_place.h"

namespace livery {

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
