// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <Eigen/Core>

#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::benchmarks {

/// The peer: FCL used as robotics software uses it, with a dynamic tree of boxes over the robot's shapes and one over
/// the scene's, OBBRSS trees of meshes, allowed pairs skipped, and the end at the first contact. Meshes are surfaces
/// here: nothing is seen to lie inside them. Kinematics are RobotModel's.
class FclPeer {
 public:
  FclPeer(const robot::RobotModel& robot, const robot::Scene& scene);
  ~FclPeer();

  bool free(const Eigen::Ref<const Eigen::VectorXd>& q);

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace opponens::benchmarks
