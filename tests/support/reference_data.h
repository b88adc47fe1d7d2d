// Reference data that the project does not ship: found through LIVERY_REFERENCE_DATA.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace livery {

/// The folder, or nothing when the variable is not set (tests then GTEST_SKIP by name).
inline std::optional<std::filesystem::path> reference_data() {
    const char* folder = std::getenv("LIVERY_REFERENCE_DATA");
    if (!folder || !*folder) return std::nullopt;
    return std::filesystem::path(folder);
}

}  // namespace livery

/// First line of a test that needs reference data.
#define LIVERY_NEEDS_REFERENCE_DATA(folder)                                    \
    const auto folder##_or_none = ::livery::reference_data();                  \
    if (!folder##_or_none) GTEST_SKIP() << "LIVERY_REFERENCE_DATA is not set"; \
    const std::filesystem::path folder = *folder##_or_none
