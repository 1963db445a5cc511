// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: the shapes of a robot and its scene, the pairs of them to check, and the exact check of one pair.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/collision.hpp"
#include "robot/convex_apart.hpp"
#include "robot/mesh_pieces.hpp"
#include "robot/narrow_phase.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {

/// One geometry of a link or of a scene body.
struct CollisionPart {
  CollisionShape shape;
  int body;                ///< link index, or scene body index
  Eigen::Isometry3d X_BG;  ///< scene: X_WG
};

/// What is checked against what. Immutable.
struct CollisionWorld {
  RobotModel robot;
  Eigen::Isometry3d X_WR;
  std::vector<std::string> body_names;     ///< of the scene
  std::vector<CollisionPart> parts;        ///< of the robot, most distal link first, then of the scene
  int robot_parts = 0;                     ///< how many of them are the robot's
  std::vector<std::vector<int>> partners;  ///< [robot parts] to check each against: later parts, ascending

  CollisionWorld(const RobotModel& model, const Scene& scene, const std::vector<BodyPair>& touching);

  bool of_scene(int part) const { return part >= robot_parts; }
  const CollisionShape& shape(int part) const { return parts[static_cast<std::size_t>(part)].shape; }
  bool is_mesh(int part) const { return robot::is_mesh(shape(part)); }
  bool is_box(int part) const { return std::holds_alternative<Box>(shape(part).shape()); }

  /// Calls visit(a, b) for the pairs to check until it returns true; whether it did.
  template <typename Visit>
  bool any_pair(const Visit& visit) const {
    for (int i = 0; i < robot_parts; ++i) {
      for (const int j : partners[static_cast<std::size_t>(i)]) {
        if (visit(i, j)) return true;
      }
    }
    return false;
  }

  const std::string& name_of(int part) const;
  /// Names of the bodies of two parts: a scene body last, two links in alphabetical order.
  BodyPair names_of(int a, int b) const;
};

/// Where the parts are at one configuration, found when asked for.
class Placement {
 public:
  /// A part in the world.
  struct Placed {
    Eigen::Isometry3d X_WG;
    OrientedBox box;
  };

  /// Room for one Placement at a time, to be used again and again.
  class Memory {
    friend class Placement;
    std::vector<Eigen::Isometry3d> X_RL_;  ///< [links]
    std::vector<Placed> placed_;           ///< [parts]
    // What is known of the present placement bears its number.
    std::vector<std::uint64_t> link_known_;
    std::vector<std::uint64_t> part_known_;
    std::uint64_t number_ = 0;
  };

  /// All are referred to and must outlive this. q: [d] rad, finite.
  Placement(const CollisionWorld& world, const Eigen::Isometry3d& X_WR, const Eigen::Ref<const Eigen::VectorXd>& q,
            Memory& memory);

  const Placed& at(int part);

  /// The exact verdict on a pair: bounding volumes, then the narrow phase.
  bool collide(int a, int b);
  /// What is certain of two parts, which FCL takes longer to find out: by their convex hulls, the convex pieces of
  /// meshes, and points that both share.
  Solids relation(int a, int b);
  double separation(int a, int b);
  /// A lower bound of the separation from bounding volumes, m.
  double distance_bound(int a, int b);

 private:
  const Eigen::Isometry3d& link(int index);

  const CollisionWorld& world_;
  Eigen::Isometry3d X_WR_;
  Eigen::Map<const Eigen::VectorXd> q_;
  Memory& memory_;
};

}  // namespace opponens::robot
