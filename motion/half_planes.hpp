// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

namespace opponens::motion {

/// a x + b u <= c.
struct HalfPlane {
  double a;
  double b;
  double c;
};

struct Interval {
  double lower;
  double upper;
  bool empty() const { return lower > upper; }
};

/// The largest x for which some u keeps all half planes, with |x|, |u| <= bound; nullopt where none does. Incremental
/// linear programming in two variables (Seidel 1991, doi:10.1007/BF02574699) in the order given, so deterministic:
/// O(n^2) at worst. Rows are taken as kept within 1e-9 of their size.
std::optional<double> largest_x(const std::vector<HalfPlane>& planes, double bound = 1e9);

/// The values of u that keep all half planes at a given x, |u| <= bound.
Interval range_of_u(const std::vector<HalfPlane>& planes, double x, double bound = 1e9);

}  // namespace opponens::motion
