// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "motion/followed_boxes.hpp"
#include "motion/world.hpp"

namespace opponens::motion {

/// A piece of a path q(s) by arc length s in [0, length], rad in the plain norm of joint space: straight, or an arc of
/// a circle. Straight: q = origin + s y. Arc: q = origin + radius (x cos(s / radius) + y sin(s / radius)).
struct PathPiece {
  Eigen::VectorXd origin;  ///< [d] rad
  Eigen::VectorXd x;       ///< [d] unit, from the centre to the arc's beginning; empty when straight
  Eigen::VectorXd y;       ///< [d] unit, the direction at its beginning
  double radius = 0.0;     ///< rad; 0: straight
  double length = 0.0;     ///< rad, positive
  bool rest = false;       ///< the motion comes to rest at its end
  int row = -1;            ///< waypoint that a straight piece begins after, or that an arc goes around
};
Eigen::VectorXd position(const PathPiece& piece, double s);
Eigen::VectorXd direction(const PathPiece& piece, double s);  ///< dq/ds, unit
Eigen::VectorXd curvature(const PathPiece& piece, double s);  ///< d2q/ds2, 1/rad

/// Straight pieces and arcs, each beginning where the one before ends; the direction is continuous where it does not
/// rest.
struct BlendedPath {
  std::vector<PathPiece> pieces;
  int corners = 0;  ///< inner waypoints of the path it was made from
  int stops = 0;    ///< of these, those where it rests
  std::int64_t collision_checks = 0;
};

struct BlendSettings {
  double deviation = 0.1;       ///< rad, plain norm: an arc passes its corner no further away, so no joint does
  double arc_deviation = 1e-4;  ///< rad, plain norm: of an arc from the chords that stand for it where it is checked
  double arc_step = 0.1;        ///< rad of turn, that a chord spans at most
  int halvings = 6;             ///< of the deviation where a blend is not valid; then the corner is a stop
};
void validate(const BlendSettings& settings);  ///< throws std::invalid_argument naming field, value, constraint

/// Number of chords that an arc is checked and stored by.
int chords(const PathPiece& arc, const BlendSettings& settings);

/// The waypoints without those within 1e-9 rad of the one before, which make no motion; the ends stay as they are where
/// more than one is left. Trees and shortcuts make such a waypoint about once in some thousand paths.
Eigen::MatrixXd distinct(const Eigen::MatrixXd& waypoints);

/// Circular blends (Kunz and Stilman 2012, doi:10.15607/RSS.2012.VIII.027, section III): at an inner waypoint with
/// turn alpha the arc begins l = min(half of either segment, deviation sin(alpha/2) / (1 - cos(alpha/2))) before it and
/// ends as far after it; radius l / tan(alpha/2). Each arc's chords, and the straight rest of the segments, are asked
/// for in `world`; a blend that is not valid is halved, and given up for a stop after `halvings` halvings, so what is
/// returned is as valid as the given path, which must be. Arcs lie in the triangle of three waypoints, so the distance
/// from a box stays within those of the waypoints; where the two boxes change, boxes (when given) is asked. At a turn
/// back there is a stop. waypoints: [N x d] rad, N >= 2, distinct from their predecessors.
BlendedPath blend_corners(const Eigen::MatrixXd& waypoints, const World& world, const BlendSettings& settings,
                          const FollowedBoxes* boxes = nullptr);

/// The path itself, at rest at every waypoint.
BlendedPath stop_at_corners(const Eigen::MatrixXd& waypoints);

}  // namespace opponens::motion
