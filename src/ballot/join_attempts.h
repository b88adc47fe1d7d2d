// How often wrong join codes may be tried.
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace livery {

/// Token buckets: each client may be wrong five times at once and then once in twelve seconds, all
/// together sixty times and then once a second. Of 4e8 codes, each good for ten minutes, two hours
/// of that find one with a chance of 2e-5. Clients are forgotten after a minute.
class JoinAttempts {
  public:
    bool allowed(const std::string& client, double now_s);
    void failed(const std::string& client, double now_s);
    std::size_t clients() const { return clients_.size(); }

  private:
    struct Bucket {
        double left = 0.0, at_s = 0.0;
    };
    Bucket refilled(const std::string& client, double now_s) const;
    std::map<std::string, Bucket> clients_;
    Bucket all_{60.0, 0.0};
};

}  // namespace livery
