#include "core/system/start_program.h"

#include <cstring>

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include "core/error.h"
#include "core/paths.h"

namespace livery {

pid_t start_program(const std::string& name,
                    std::vector<std::string> arguments,
                    const std::vector<std::pair<int, int>>& files,
                    const char* called) {
    const std::filesystem::path program = executable_folder() / name;
    arguments.insert(arguments.begin(), program.string());
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    for (const auto& [ours, its] : files) ::posix_spawn_file_actions_adddup2(&actions, ours, its);
    pid_t id = -1;
    const int failure =
        ::posix_spawn(&id, program.c_str(), &actions, nullptr, words.data(), ::environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) throw FileError(program, "", std::strerror(failure), called);
    return id;
}

}  // namespace livery
