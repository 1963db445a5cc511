// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/shortcut.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
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

/// The path with the part between two points made straight.
Waypoints joined(const Waypoints& waypoints, const PathPoint& first, const PathPoint& last) {
  Waypoints result(waypoints.begin(), waypoints.begin() + static_cast<std::ptrdiff_t>(first.segment) + 1);
  if (first.fraction > 0.0) result.push_back(at(waypoints, first));
  result.push_back(at(waypoints, last));
  result.insert(result.end(), waypoints.begin() + static_cast<std::ptrdiff_t>(last.segment) + 1, waypoints.end());
  return result;
}

Waypoints waypoints_of(const Eigen::MatrixXd& rows) {
  Waypoints waypoints;
  for (const auto& row : rows.rowwise()) waypoints.emplace_back(row.transpose());
  return waypoints;
}

Eigen::MatrixXd rows_of(const Waypoints& waypoints) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(waypoints.size()), waypoints.front().size());
  for (std::size_t i = 0; i < waypoints.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = waypoints[i].transpose();
  return rows;
}

/// A path in place of another, which differs from it between the waypoints begin and end only.
struct Candidate {
  Waypoints waypoints;
  std::size_t begin;
  std::size_t end;
};

/// The part between two points, made straight; with what is left of the segments it is joined to: those are checked at
/// other fractions than before.
Candidate straight_between(const Waypoints& waypoints, const PathPoint& first, const PathPoint& last) {
  return {joined(waypoints, first, last), first.segment,
          first.segment + (first.fraction > 0.0 ? 2 : 1) + (last.fraction > 0.0 ? 1 : 0)};
}

/// What a candidate has to keep beside validity; changes it so that it does, or refuses it.
using Law = std::function<bool(Candidate& candidate, std::size_t straight, Rng& rng)>;

/// The law of the boxes; straight: the waypoint that the straight part begins at.
Law law_of(const FollowedBoxes& boxes, const PlanningGroup& kept) {
  return [&boxes, &kept](Candidate& candidate, std::size_t straight, Rng& rng) {
    if (change_row(boxes, rows_of(candidate.waypoints))) return true;
    const Eigen::VectorXd& from = candidate.waypoints[straight];
    const Eigen::VectorXd between = from + rng.uniform() * (candidate.waypoints[straight + 1] - from);
    candidate.waypoints.insert(candidate.waypoints.begin() + static_cast<std::ptrdiff_t>(straight) + 1,
                               within_both(boxes, between, kept));
    ++candidate.end;
    return change_row(boxes, rows_of(candidate.waypoints)).has_value();
  };
}

Shortcut shortened(const JointPath& path, const Eigen::VectorXd& weights, const World& world,
                   const ShortcutSettings& settings, std::uint64_t seed, const Law& law) {
  validate(settings);
  require(path.waypoints.cols() == weights.size(), "shortcut: path and weights differ in the number of joints");
  Rng rng = stream(seed, "motion/shortcut");
  Waypoints waypoints = waypoints_of(path.waypoints);
  Shortcut result{path, path_length(weights, path.waypoints), 0.0, 0, 0};
  double length = result.length_before;
  for (int i = 0; i < settings.iterations && waypoints.size() > 2; ++i) {
    PathPoint first = random_point(waypoints, i % 2 == 0, rng);
    PathPoint last = random_point(waypoints, i % 2 == 0, rng);
    if (last < first) std::swap(first, last);
    if (first.segment == last.segment) continue;
    Candidate candidate = straight_between(waypoints, first, last);
    if (length_of(weights, candidate.waypoints) >= length - 1e-9) continue;
    if (law && !law(candidate, first.segment + (first.fraction > 0.0 ? 1 : 0), rng)) continue;
    const double candidate_length = length_of(weights, candidate.waypoints);
    bool valid = candidate_length < length - 1e-9;
    for (std::size_t j = candidate.begin; j < candidate.end && valid; ++j) {
      valid = valid_motion(world, candidate.waypoints[j], candidate.waypoints[j + 1], result.collision_checks);
    }
    if (!valid) continue;
    waypoints = std::move(candidate.waypoints);
    length = candidate_length;
    ++result.accepted;
  }
  if (!waypoints.empty()) result.path.waypoints = rows_of(waypoints);
  result.length = path_length(weights, result.path.waypoints);
  return result;
}

}  // namespace

void validate(const ShortcutSettings& settings) {
  require(settings.iterations >= 0,
          "ShortcutSettings::iterations = " + std::to_string(settings.iterations) + ": must be >= 0");
}

Shortcut shortcut(const JointPath& path, const Eigen::VectorXd& weights, const World& world,
                  const ShortcutSettings& settings, std::uint64_t seed) {
  return shortened(path, weights, world, settings, seed, {});
}

Shortcut shortcut_in_boxes(const JointPath& path, const Eigen::VectorXd& weights, const World& world,
                           const FollowedBoxes& boxes, const PlanningGroup& kept, std::uint64_t seed) {
  require(change_row(boxes, path.waypoints).has_value(),
          "shortcut_in_boxes: the path is further from its boxes than they allow");
  return shortened(path, weights, world, {}, seed, law_of(boxes, kept));
}

}  // namespace opponens::motion
