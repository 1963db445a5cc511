// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "robot/fingertip_fit.hpp"

namespace opponens::robot {

namespace {

bool moves(const TipTarget& target, int joint) {
  const auto& moving = target.finger.moved_by;
  return std::find(moving.begin(), moving.end(), joint) != moving.end();
}

bool share_a_joint(const FingertipFit& fit, const TipTarget& a, const TipTarget& b) {
  return std::any_of(fit.fitted.begin(), fit.fitted.end(),
                     [&](int joint) { return moves(a, joint) && moves(b, joint); });
}

/// Number of the part of each target: that of its first target.
std::vector<std::size_t> part_numbers(const FingertipFit& fit) {
  std::vector<std::size_t> part(fit.targets.size());
  for (std::size_t f = 0; f < part.size(); ++f) {
    part[f] = f;
    for (std::size_t g = 0; g < f; ++g) {
      if (part[g] == part[f] || !share_a_joint(fit, fit.targets[f], fit.targets[g])) continue;
      const auto [keep, drop] = std::minmax(part[f], part[g]);
      std::replace(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(f) + 1, std::size_t{drop},
                   std::size_t{keep});
    }
  }
  return part;
}

}  // namespace

std::vector<FingertipFit> independent_parts(const FingertipFit& fit) {
  if (fit.shifted) return {fit};
  const std::vector<std::size_t> part = part_numbers(fit);
  std::vector<FingertipFit> parts;
  for (std::size_t number = 0; number < part.size(); ++number) {
    FingertipFit one{{}, {}, {}, fit.time, fit.cylindrical, fit.tolerance, fit.shifted};
    for (std::size_t f = 0; f < part.size(); ++f) {
      if (part[f] == number) one.targets.push_back(fit.targets[f]);
    }
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < fit.fitted.size(); ++i) {
      const bool ours = std::any_of(one.targets.begin(), one.targets.end(),
                                    [&](const TipTarget& target) { return moves(target, fit.fitted[i]); });
      if (!ours) continue;
      one.fitted.push_back(fit.fitted[i]);
      rows.push_back(static_cast<Eigen::Index>(i));
    }
    one.rest = fit.rest(rows, Eigen::all);
    if (!one.fitted.empty()) parts.push_back(std::move(one));
  }
  return parts;
}

FingertipFit sample_of(const FingertipFit& fit, Eigen::Index sample) {
  FingertipFit one = fit;
  one.rest = fit.rest.col(sample);
  one.time.resize(0);
  for (std::size_t f = 0; f < fit.targets.size(); ++f) one.targets[f].path = fit.targets[f].path.col(sample);
  return one;
}

}  // namespace opponens::robot
