// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace opponens {
namespace {

TEST(Rng, EqualsAnIndependentImplementation) {
  // xoshiro256++ seeded by splitmix64(42), from a Python implementation with big integers.
  Rng rng(42);
  for (const std::uint64_t expected :
       {0xd0764d4f4476689fULL, 0x519e4174576f3791ULL, 0xfbe07cfb0c24ed8cULL, 0xb37d9f600cd835b8ULL}) {
    EXPECT_EQ(rng(), expected);
  }
}

TEST(Rng, StreamsDifferByNameAndSeedAndRepeat) {
  EXPECT_EQ(stream(1, "grasp")(), stream(1, "grasp")());
  EXPECT_NE(stream(1, "grasp")(), stream(1, "plan")());
  EXPECT_NE(stream(1, "grasp")(), stream(2, "grasp")());
}

/// Pearson's chi-square of counts against equal cells.
template <std::size_t N>
double chi_square(const std::array<int, N>& counts, int draws) {
  const double expected = static_cast<double>(draws) / N;
  double sum = 0.0;
  for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

// Chi-square with 5 degrees of freedom: upper 1e-4 quantile 25.745 (R: qchisq(1 - 1e-4, 5)).
constexpr double kChiSquare5 = 25.745;

TEST(Rng, IndexIsUniform) {
  Rng rng(7);
  std::array<int, 6> counts{};
  constexpr int draws = 60000;
  for (int i = 0; i < draws; ++i) ++counts[rng.index(6)];
  EXPECT_LT(chi_square(counts, draws), kChiSquare5);
}

TEST(Rng, IndexTestRefusesABiasedDie) {
  Rng rng(7);
  std::array<int, 6> counts{};
  constexpr int draws = 60000;
  for (int i = 0; i < draws; ++i) ++counts[rng.index(64) % 6];  // 64 = 10 * 6 + 4: the classic modulo bias
  EXPECT_GT(chi_square(counts, draws), kChiSquare5);
}

// Mean of n standard normals is N(0, 1/n); of n uniforms N(1/2, 1/(12 n)). Two-sided 1e-4: 3.8906 standard errors.
constexpr double kNormalQuantile = 3.8906;

TEST(Rng, NormalHasMeanZeroAndVarianceOne) {
  Rng rng(11);
  constexpr int n = 100000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = rng.normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_LT(std::abs(sum / n), kNormalQuantile / std::sqrt(n));
  // The sum of squares is chi-square with n degrees of freedom: nearly N(n, 2 n).
  EXPECT_LT(std::abs(squares / n - 1.0), kNormalQuantile * std::sqrt(2.0 / n));
}

TEST(Rng, UniformStaysInsideAndIsCentred) {
  Rng rng(13);
  constexpr int n = 100000;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double x = rng.uniform(2.0, 4.0);
    ASSERT_GE(x, 2.0);
    ASSERT_LT(x, 4.0);
    sum += (x - 2.0) / 2.0;
  }
  EXPECT_LT(std::abs(sum / n - 0.5), kNormalQuantile / std::sqrt(12.0 * n));
}

}  // namespace
}  // namespace opponens
