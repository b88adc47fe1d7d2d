// `livery session` as the tests call it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/run_program.h"

namespace livery {

using Json = nlohmann::ordered_json;

/// `livery session NAME FILE ... --json`.
inline ProgramRun session_run(const std::string& name,
                              const std::filesystem::path& file,
                              std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"session", name, file.string(), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(LIVERY_PROGRAM, words);
}

/// What it printed; it has succeeded.
inline Json answer(const ProgramRun& run) {
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const Json json = Json::parse(run.out, nullptr, false);
    EXPECT_FALSE(json.is_discarded()) << run.out << run.err;
    return json;
}

}  // namespace livery
