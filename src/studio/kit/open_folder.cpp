#include "studio/kit/open_folder.h"

#include <cerrno>
#include <string>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace livery {

bool open_folder(const std::filesystem::path& folder) {
    // The shell ends at once, so that the file manager is nobody's child to wait for.
    std::string script =
        R"(command -v xdg-open >/dev/null || exit 1; xdg-open "$1" </dev/null >/dev/null 2>&1 &)";
    std::string shell = "sh", option = "-c", name = "sh", argument = folder.string();
    char* words[] = {
        shell.data(), option.data(), script.data(), name.data(), argument.data(), nullptr};
    pid_t id = -1;
    if (::posix_spawnp(&id, "sh", nullptr, nullptr, words, ::environ) != 0) return false;
    int status = 0;
    while (::waitpid(id, &status, 0) < 0 && errno == EINTR) continue;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace livery
