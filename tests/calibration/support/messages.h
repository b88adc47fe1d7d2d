// The text of an expected exception.
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace livery {

/// What an exception of this kind says; another one, or none, is a failure.
template <typename Error, typename Call>
std::string message_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    } catch (const std::exception& other) {
        ADD_FAILURE() << "another kind was thrown: " << other.what();
        return "";
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

}  // namespace livery

#define EXPECT_HAS(text, part)                                                       \
    do {                                                                             \
        const std::string text_of_message = (text);                                  \
        EXPECT_NE(text_of_message.find(part), std::string::npos) << text_of_message; \
    } while (false)
