// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "core/require.hpp"

#include <gtest/gtest.h>

namespace opponens {
namespace {

TEST(Require, ThrowsTheMessageOnlyWhenBroken) {
  EXPECT_NO_THROW(require(true, "unused"));
  try {
    require(false, "alpha = 2, expected a fraction");
    FAIL() << "did not throw";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "alpha = 2, expected a fraction");
  }
}

TEST(Require, ComposesACostlyMessageOnlyWhenBroken) {
  int composed = 0;
  const auto message = [&] {
    ++composed;
    return std::string("late");
  };
  require(true, message);
  EXPECT_EQ(composed, 0);
  EXPECT_THROW(require(false, message), std::invalid_argument);
  EXPECT_EQ(composed, 1);
}

}  // namespace
}  // namespace opponens
