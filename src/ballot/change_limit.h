// How often a seat may change its ballot and its ratings.
#pragma once

#include <map>

namespace livery {

/// A token bucket for each seat: sixty changes at once, then thirty a minute. Each change is an
/// entry in the ballots' log for good; a person makes fewer.
class ChangeLimit {
  public:
    bool allowed(int seat, double now_s) const;
    void changed(int seat, double now_s);

  private:
    struct Bucket {
        double left = 0.0, at_s = 0.0;
    };
    Bucket bucket_of(int seat, double now_s) const;
    std::map<int, Bucket> buckets_;
};

}  // namespace livery
