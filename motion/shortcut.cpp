// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/shortcut.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "motion/joint_metric.hpp"

namespace opponens::motion {
namespace {

using Waypoints = std::vector<Eigen::VectorXd>;

/// A point on the path: between waypoint `segment` (fraction 0) and the next.
struct PathPoint {
  std::size_t segment;
  double fraction;
  bool operator<(const PathPoint& other) const {
    return segment != other.segment ? segment < other.segment : fraction < other.fraction;
  }
};

Eigen::VectorXd at(const Waypoints& waypoints, const PathPoint& point) {
  if (point.fraction == 0.0) return waypoints[point.segment];
  return waypoints[point.segment] + point.fraction * (waypoints[point.segment + 1] - waypoints[point.segment]);
}

PathPoint random_point(const Waypoints& waypoints, bool on_waypoint, Rng& rng) {
  const std::size_t segments = waypoints.size() - 1;
  if (on_waypoint) return {static_cast<std::size_t>(rng.index(segments + 1)), 0.0};
  const auto segment = static_cast<std::size_t>(rng.index(segments));
  return {segment, rng.uniform()};
}

double length_of(const Eigen::VectorXd& weights, const Waypoints& waypoints) {
  double length = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) length += distance(weights, waypoints[i - 1], waypoints[i]);
  return length;
}

bool valid_motion(const World& world, const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                  std::int64_t& checks) {
  return !world.first_invalid(q_from, q_to, checks) && !(world.confirm && world.confirm(q_from, q_to, checks));
}

/// The path with the part between two points made straight.
Waypoints joined(const Waypoints& waypoints, const PathPoint& first, const PathPoint& last) {
  Waypoints result(waypoints.begin(), waypoints.begin() + static_cast<std::ptrdiff_t>(first.segment) + 1);
  if (first.fraction > 0.0) result.push_back(at(waypoints, first));
  result.push_back(at(waypoints, last));
  result.insert(result.end(), waypoints.begin() + static_cast<std::ptrdiff_t>(last.segment) + 1, waypoints.end());
  return result;
}

}  // namespace

void validate(const ShortcutSettings& settings) {
  require(settings.iterations >= 0,
          "ShortcutSettings::iterations = " + std::to_string(settings.iterations) + ": must be >= 0");
}

Shortcut shortcut(const JointPath& path, const Eigen::VectorXd& weights, const World& world,
                  const ShortcutSettings& settings, std::uint64_t seed) {
  validate(settings);
  require(path.waypoints.cols() == weights.size(), "shortcut: path and weights differ in the number of joints");
  Rng rng = stream(seed, "motion/shortcut");
  Waypoints waypoints;
  for (const auto& row : path.waypoints.rowwise()) waypoints.emplace_back(row.transpose());
  Shortcut result{path, path_length(weights, path.waypoints), 0.0, 0, 0};
  double length = result.length_before;
  for (int i = 0; i < settings.iterations && waypoints.size() > 2; ++i) {
    PathPoint first = random_point(waypoints, i % 2 == 0, rng);
    PathPoint last = random_point(waypoints, i % 2 == 0, rng);
    if (last < first) std::swap(first, last);
    if (first.segment == last.segment) continue;
    Waypoints candidate = joined(waypoints, first, last);
    const double candidate_length = length_of(weights, candidate);
    if (candidate_length >= length - 1e-9) continue;
    // The straight part, and what is left of the segments it was joined to: those are checked at other fractions than
    // before.
    const std::size_t begin = first.segment;
    const std::size_t end = begin + (first.fraction > 0.0 ? 2 : 1) + (last.fraction > 0.0 ? 1 : 0);
    bool valid = true;
    for (std::size_t j = begin; j < end && valid; ++j) {
      valid = valid_motion(world, candidate[j], candidate[j + 1], result.collision_checks);
    }
    if (!valid) continue;
    waypoints = std::move(candidate);
    length = candidate_length;
    ++result.accepted;
  }
  result.path.waypoints.resize(static_cast<Eigen::Index>(waypoints.size()), weights.size());
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    result.path.waypoints.row(static_cast<Eigen::Index>(i)) = waypoints[i].transpose();
  }
  result.length = path_length(weights, result.path.waypoints);
  return result;
}

}  // namespace opponens::motion
