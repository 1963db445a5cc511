// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/text.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "core/rng.hpp"

namespace opponens::report {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Text, FixedRoundsAndNeverWritesMinusZero) {
  EXPECT_EQ(fixed(1.25, 1), "1.2");  // exactly half: to even, as IEEE 754 does
  EXPECT_EQ(fixed(2.0 / 3.0, 3), "0.667");
  EXPECT_EQ(fixed(-0.04, 1), "0.0");
  EXPECT_EQ(fixed(-0.0, 0), "0");
  EXPECT_EQ(fixed(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed(1e300, 0).size(), 301U);
}

TEST(Text, NotFiniteNumbersAreWords) {
  for (const double value : {kInfinity, -kInfinity, std::nan("")}) {
    EXPECT_EQ(fixed(value, 2), "n/a");
    EXPECT_EQ(compact(value), "n/a");
    EXPECT_EQ(significant(value), "n/a");
    EXPECT_EQ(percent(value), "n/a");
  }
}

TEST(Text, CompactDropsTrailingZeros) {
  EXPECT_EQ(compact(3.0), "3");
  EXPECT_EQ(compact(3.14), "3.1");
  EXPECT_EQ(compact(-0.01), "0");
  EXPECT_EQ(compact(100.0, 0), "100");
}

TEST(Text, SignificantDigits) {
  EXPECT_EQ(significant(0.0), "0");
  EXPECT_EQ(significant(0.9996), "1.00");
  EXPECT_EQ(significant(123456.0), "123456");
  EXPECT_EQ(significant(0.00012345), "0.000123");
  EXPECT_EQ(significant(1.2345e-9), "1.23e-9");
  EXPECT_EQ(significant(-1.2345e12), "-1.23e12");
}

TEST(Text, SignificantReadsBackWithinHalfADigit) {
  Rng rng = stream(7, "significant");
  for (int i = 0; i < 2000; ++i) {
    const double value = rng.normal() * std::pow(10.0, rng.uniform(-12.0, 12.0));
    const double read = std::strtod(significant(value, 4).c_str(), nullptr);
    EXPECT_NEAR(read, value, 0.5001e-3 * std::abs(value)) << value;
  }
}

TEST(Text, ThousandsAreGrouped) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(-1000), "-1\u202F000");
  EXPECT_EQ(grouped(1234567), "1\u202F234\u202F567");
}

TEST(Text, EscapeLeavesNoMarkup) {
  EXPECT_EQ(escape("<script>alert('x')&\"</script>"), "&lt;script&gt;alert(&#39;x&#39;)&amp;&quot;&lt;/script&gt;");
  EXPECT_EQ(escape("a\nb\tc\x01"), "a\nb\tc ");
  EXPECT_EQ(escape("caf\u00E9 \U0001F590"), "caf\u00E9 \U0001F590");
}

TEST(Text, EscapeReplacesBytesThatAreNotUtf8) {
  EXPECT_EQ(escape("a\xFFz"), "a\uFFFDz");
  EXPECT_EQ(escape("\xC3"), "\uFFFD");                      // cut short
  EXPECT_EQ(escape("\xC0\xBC"), "\uFFFD\uFFFD");            // an overlong '<'
  EXPECT_EQ(escape("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");  // half of a surrogate pair
}

}  // namespace
}  // namespace opponens::report
