// What a program sees that may not write everywhere.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

namespace livery {

/// The process has no rights of root for as long as this lives, whoever runs the test.
class WithoutRights {
  public:
    WithoutRights() { EXPECT_EQ(::seteuid(was_ == 0 ? 65534 : was_), 0); }
    ~WithoutRights() { EXPECT_EQ(::seteuid(was_), 0); }
    WithoutRights(const WithoutRights&) = delete;
    WithoutRights& operator=(const WithoutRights&) = delete;

  private:
    uid_t was_ = ::geteuid();
};

}  // namespace livery
