// Asserts what a person reads when a file is bad.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "core/error.h"

namespace livery {

/// Whether `work` throws a FileError whose message is one line and holds every part. Use:
///     EXPECT_TRUE(fails_with([&] { read_json_file(file); }, {"a.json", "found nothing"}));
template <typename Work>
::testing::AssertionResult fails_with(Work&& work, std::initializer_list<std::string_view> parts) {
    try {
        work();
    } catch (const FileError& error) {
        const std::string message = error.what();
        if (message.find('\n') != std::string::npos) {
            return ::testing::AssertionFailure() << "more than one line: " << message;
        }
        for (const auto part : parts) {
            if (message.find(part) == std::string::npos) {
                return ::testing::AssertionFailure()
                       << "no \"" << part << "\" in \"" << message << "\"";
            }
        }
        return ::testing::AssertionSuccess() << message;
    } catch (const std::exception& error) {
        return ::testing::AssertionFailure() << "another exception: " << error.what();
    }
    return ::testing::AssertionFailure() << "nothing thrown";
}

}  // namespace livery
