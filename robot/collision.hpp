// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {

/// Names of two bodies: robot links, or scene bodies.
using BodyPair = std::pair<std::string, std::string>;

/// The collision truth (design: "Collision truth"): FCL on the chosen geometry of every link pair that is not allowed
/// and every link-body pair, plus containment: closed meshes are solids. Thread-safe: all queries are const and keep no
/// state.
class CollisionChecker {
 public:
  /// touching: extra pairs that are not checked (link name, scene body name), e.g. the contacts of a grasp.
  CollisionChecker(const RobotModel& robot, const Scene& scene, std::vector<BodyPair> touching = {});
  ~CollisionChecker();
  CollisionChecker(CollisionChecker&&) noexcept;
  CollisionChecker& operator=(CollisionChecker&&) noexcept;

  /// Whether no pair collides at q. Stops at the first colliding pair. q: [d] rad.
  bool free(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// Every colliding pair at q, sorted by name.
  std::vector<BodyPair> colliding_pairs(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  struct Clearance {
    double distance;  ///< m; 0 when colliding, infinite when there is no pair to check
    BodyPair pair;    ///< the nearest pair; when several collide, one of them
  };
  Clearance clearance(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// Links and scene bodies with a mesh that is not closed, sorted: such a mesh is a surface, nothing is inside it.
  std::vector<std::string> open_meshes() const;

  /// The same for a free-flying robot: root at X_WR instead of the scene's (hand-only searches).
  bool free(const Eigen::Isometry3d& X_WR, const Eigen::Ref<const Eigen::VectorXd>& q) const;
  std::vector<BodyPair> colliding_pairs(const Eigen::Isometry3d& X_WR,
                                        const Eigen::Ref<const Eigen::VectorXd>& q) const;

 private:
  struct World;
  std::unique_ptr<const World> world_;
};

}  // namespace opponens::robot
