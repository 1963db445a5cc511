// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace opponens {

/// xoshiro256++ (Blackman and Vigna 2021, doi:10.1145/3460772), seeded through splitmix64. The standard library's
/// distributions are implementation-defined; these are ours, so equal seeds give equal numbers everywhere.
class Rng {
 public:
  using result_type = std::uint64_t;

  explicit Rng(std::uint64_t seed);

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()();

  double uniform();                          ///< in [0, 1), 53 random bits
  double uniform(double low, double high);   ///< in [low, high)
  double normal();                           ///< standard normal (Marsaglia's polar method)
  std::uint64_t index(std::uint64_t count);  ///< in [0, count), unbiased; count > 0

 private:
  std::array<std::uint64_t, 4> state_;
  double spare_normal_ = 0.0;
  bool has_spare_ = false;
};

/// An independent stream for one purpose, e.g. stream(seed, "grasp/3"): the same whatever other streams were used for.
Rng stream(std::uint64_t seed, std::string_view name);

}  // namespace opponens
