// Sockets of servers that the tests talk to, on 127.0.0.1 alone.
#pragma once

#include <string>

namespace livery::testing {

/// A socket that listens on a port of the system's choice. Throws std::runtime_error.
int listen_on_loopback(int& port);
/// False when the other side is gone.
bool send_all(int connection, const std::string& bytes);

}  // namespace livery::testing
