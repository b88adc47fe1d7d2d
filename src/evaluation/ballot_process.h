// The phone page's server, started and watched: livery-ballots beside this program.
#pragma once

#include <filesystem>
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
    /// Waits until it listens, at most ten seconds. Throws std::runtime_error with what it said
    /// when it does not start. It ends with the thread that started it: the main one, say.
    explicit BallotProcess(const BallotProcessOptions& options);
    /// Ends it.
    ~BallotProcess();
    BallotProcess(const BallotProcess&) = delete;
    BallotProcess& operator=(const BallotProcess&) = delete;

    const BallotServerPlace& place() const { return place_; }
    pid_t id() const { return id_; }
    /// False once it has ended, by itself or killed; votes that it confirmed are in the file.
    bool running();

  private:
    void stop();
    pid_t id_ = -1;
    BallotServerPlace place_;
};

}  // namespace livery
