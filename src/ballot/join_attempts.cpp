#include "ballot/join_attempts.h"

#include <algorithm>

namespace livery {

namespace {

constexpr double kMost = 5.0, kMostOfAll = 60.0;
constexpr double kRefill_per_s = kMost / 60.0, kRefillOfAll_per_s = 1.0;
constexpr std::size_t kMostClients = 256;

double refill(double left, double since_s, double most, double rate_per_s) {
    return std::min(most, left + std::max(0.0, since_s) * rate_per_s);
}

}  // namespace

JoinAttempts::Bucket JoinAttempts::refilled(const std::string& client, double now_s) const {
    const auto found = clients_.find(client);
    if (found == clients_.end()) return {kMost, now_s};
    const Bucket& bucket = found->second;
    return {refill(bucket.left, now_s - bucket.at_s, kMost, kRefill_per_s),
            std::max(bucket.at_s, now_s)};
}

bool JoinAttempts::allowed(const std::string& client, double now_s) {
    // A clock that goes back and forth gives nothing.
    all_ = {refill(all_.left, now_s - all_.at_s, kMostOfAll, kRefillOfAll_per_s),
            std::max(all_.at_s, now_s)};
    return all_.left >= 1.0 && refilled(client, now_s).left >= 1.0;
}

void JoinAttempts::failed(const std::string& client, double now_s) {
    Bucket bucket = refilled(client, now_s);
    bucket.left -= 1.0;
    all_.left -= 1.0;
    // Whose bucket is full again needs none.
    std::erase_if(clients_,
                  [&](const auto& other) { return refilled(other.first, now_s).left >= kMost; });
    if (clients_.size() >= kMostClients && !clients_.contains(client)) {
        clients_.erase(std::min_element(
            clients_.begin(), clients_.end(), [](const auto& one, const auto& other) {
                return one.second.at_s < other.second.at_s;
            }));
    }
    clients_[client] = bucket;
}

}  // namespace livery
