// Works on a session until it is killed, and tells of each step when it is on disk:
//     session_writer FILE SEED FIRST_STEP
// One byte a step on standard output; the first when the session is open.

#include <cstdlib>

#include <unistd.h>

#include "session/session_script.h"

int main(int argc, char** argv) {
    using namespace livery;
    if (argc != 4) return 2;
    Session session = Session::open(argv[1]);
    const std::uint64_t seed = std::strtoull(argv[2], nullptr, 10);
    for (std::uint64_t step = std::strtoull(argv[3], nullptr, 10);; ++step) {
        if (::write(STDOUT_FILENO, ".", 1) != 1) return 1;
        testing::take_step(session, seed, step);
        if (session.save_problem()) return 3;
    }
}
