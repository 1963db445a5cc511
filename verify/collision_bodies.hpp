// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::verify {

/// verify's own collision world: every geometry of robot and scene as an FCL object and as a solid. Holds the
/// configuration that was set last.
class CollisionBodies {
 public:
  CollisionBodies(const robot::RobotModel& robot, const robot::Scene& scene);
  ~CollisionBodies();

  void set(const Eigen::VectorXd& q);

  using Pair = std::pair<std::string, std::string>;  ///< link, and link or scene body
  /// Pairs that collide, but for the allowed ones of the robot.
  std::set<Pair> colliding() const;
  struct Clearance {
    double distance;  ///< m
    Pair pair;        ///< empty names when nothing is below the horizon
  };
  /// Least distance of any pair that is neither allowed nor in `except`, m; only what is below `horizon` is looked for.
  /// Between triangulated surfaces with 64 segments around, so for round shapes of radius r it may be too large by
  /// 0.0012 r each. Only for configurations that are free: a surface within a solid has a distance too.
  Clearance clearance(const std::set<Pair>& except, double horizon) const;
  /// Deepest point of the link in the body or of the body in the link, m: surface samples of the link every 2 mm, and
  /// the body's vertices.
  double penetration(const std::string& link, const std::string& body) const;

 private:
  struct Part;
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace opponens::verify
