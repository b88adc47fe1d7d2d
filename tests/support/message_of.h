// What an exception says.
#pragma once

#include <exception>
#include <string>

namespace livery {

/// "nothing thrown" where nothing is.
template <typename Call>
std::string message_of(Call&& call) {
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "nothing thrown";
}

}  // namespace livery
