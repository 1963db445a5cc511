// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/path.hpp"
#include "robot/geometry.hpp"
#include "robot/srdf.hpp"

namespace opponens::robot {

enum class JointType { fixed, revolute, prismatic };

struct Mimic {
  std::string joint;
  double multiplier = 1.0;
  double offset = 0.0;  ///< rad or m
};

struct Joint {
  std::string name;
  JointType type = JointType::fixed;
  int parent = -1;                                         ///< link index
  int child = -1;                                          ///< link index
  Eigen::Isometry3d X_PJ = Eigen::Isometry3d::Identity();  ///< joint frame in the parent link, at zero
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();         ///< unit, in the joint frame
  double lower = 0.0;                                      ///< rad or m
  double upper = 0.0;                                      ///< rad or m
  double velocity = 0.0;                                   ///< rad/s or m/s, limit
  std::optional<Mimic> mimic;
  std::optional<double>
      rest;  ///< rad or m, position while q does not drive it; default: zero, or the limit nearest to it
  std::optional<double> acceleration;  ///< rad/s^2 or m/s^2, limit; URDF has none
};

struct Link {
  std::string name;
  int joint = -1;                   ///< index of the joint that moves it; -1 for the root
  std::vector<Geometry> collision;  ///< of the chosen kind: urdf collision or visual
};

/// A point of the hand's surface where contact is intended (the paper's Fig. 5), or a finger tip.
struct SurfacePoint {
  std::string name;
  std::string finger;  ///< "index", "middle", "ring", "thumb", "palm", ...
  int link = -1;
  Eigen::Vector3d p_L;  ///< m
  Eigen::Vector3d n_L;  ///< unit, out of the link's surface
};

/// A mesh that a URDF names and that is not there.
struct MissingMesh {
  std::string link;
  std::string mesh;    ///< as the URDF writes it
  std::string reason;  ///< "does not exist: /path", "package 'x' has no path", ...
};

/// One arm with its hand, of a robot that has several. All names carry the arm's prefix: "right/elbow_joint".
struct ArmDescription {
  std::string name;
  std::vector<std::string> arm_joints;   ///< [a] in planning order
  std::vector<std::string> hand_joints;  ///< [n] in hand.yaml's order
  std::string palm_link;
  std::string arm_tip_link;
  std::vector<SurfacePoint> tips;
  std::vector<SurfacePoint> contact_points;
  Eigen::VectorXd weights;  ///< [a+n]
};

/// A kinematic tree as loaded: links in topological order (root first), joints in the order of their child links.
struct RobotDescription {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<std::string> arm_joints;   ///< [a] actuated, in planning order; empty for a hand alone
  std::vector<std::string> hand_joints;  ///< [n] actuated, in hand.yaml's order
  std::string palm_link;                 ///< frame H
  std::string arm_tip_link;              ///< last arm link (the hand's mount), empty for a hand alone
  std::vector<SurfacePoint> tips;
  std::vector<SurfacePoint> contact_points;
  Eigen::VectorXd weights;                           ///< [a+n] of the joint metric, default 1
  std::set<std::pair<int, int>> allowed_collisions;  ///< link index pairs (first < second) that may touch
  std::vector<std::filesystem::path> files;          ///< it was read from, meshes included
  std::vector<std::string> notes;                    ///< what was ignored or defaulted while loading
  std::vector<MissingMesh> missing_meshes;           ///< only where loading was asked to go on without them
  std::vector<Srdf> semantics;                       ///< the SRDFs read
  std::vector<ArmDescription> arms;                  ///< all of a robot with several; empty: one arm, or a hand alone
  std::vector<std::string> driven_arms;              ///< those that q drives, in its order; the others rest
};

/// The same robot with every length multiplied by factor > 0: joint frames, shapes, surface points, prismatic limits.
/// Meshes are copied.
RobotDescription scaled(const RobotDescription& description, double factor);

/// 1/s: a joint without an acceleration limit of its own may reach its velocity limit from rest within half a second.
/// A choice of ours (a UR5: 6.3 rad/s^2; its MoveIt configuration says 5), as URDF states no such limit.
inline constexpr double kAccelerationRate = 2.0;

/// An arm that q drives.
struct DrivenArm {
  std::string name;  ///< empty: the robot has one arm
  PlanningGroup arm;
  PlanningGroup hand;
  int palm = 0;  ///< link index
};

/// Kinematics of a tree. Immutable after construction, safe to share between threads. A configuration q = [q_a; q_h]
/// is ordered by name as given in the description, never by position in the URDF. Where q drives several arms, it is
/// [q_a of each arm; q_h of each arm]: arm() and hand() then span those of all arms, palm() is the first arm's, and
/// arms() tells them apart. Joints that q does not drive rest: their links stay where those positions put them.
class RobotModel {
 public:
  /// How a joint's position follows from q: multiplier q[index] + offset.
  struct Drive {
    int index = -1;  ///< into q; -1: constant (fixed, or not actuated)
    double multiplier = 1.0;
    double offset = 0.0;  ///< rad or m
  };

  /// Throws std::invalid_argument when the description is inconsistent (order, names, sizes), InputError when no
  /// position of a joint keeps those that mimic it inside their limits.
  explicit RobotModel(RobotDescription description);

  const RobotDescription& description() const { return description_; }
  const std::vector<Link>& links() const { return description_.links; }
  const std::vector<std::string>& joint_names() const { return joint_names_; }  ///< [d], arm then hand
  int dof() const { return static_cast<int>(joint_names_.size()); }
  const PlanningGroup& arm() const { return arm_; }
  const PlanningGroup& hand() const { return hand_; }
  /// [d] of the joints and of those that mimic them.
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }                  ///< [d]
  const Eigen::VectorXd& velocity() const { return velocity_; }            ///< [d]
  const Eigen::VectorXd& acceleration() const { return acceleration_; }    ///< [d] default: kAccelerationRate velocity
  const Eigen::VectorXd& weights() const { return description_.weights; }  ///< [d]
  const Eigen::VectorXd& rest() const { return rest_; }  ///< [d] where they rest when q drives them not
  int link_index(const std::string& name) const;         ///< throws std::invalid_argument when absent
  int palm() const { return palm_; }
  const std::vector<Drive>& drives() const { return drives_; }  ///< [joints of the description]
  const std::vector<DrivenArm>& arms() const { return arms_; }  ///< at least one
  /// Arm and hand of every driven arm, in q's order: "arm", "hand", or "right/arm", "left/arm", "right/hand", ...
  std::vector<PlanningGroup> groups() const;

  /// [joints] rad or m, positions of all joints in the description's order: driven and resting ones too, 0 if fixed.
  Eigen::VectorXd joint_positions(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// Poses X_RL of every link in the root frame R. Cost: one product per link. q: [d] rad.
  std::vector<Eigen::Isometry3d> link_poses(const Eigen::Ref<const Eigen::VectorXd>& q) const;
  /// The same, reusing the output's memory.
  void link_poses(const Eigen::Ref<const Eigen::VectorXd>& q, std::vector<Eigen::Isometry3d>& X_RL) const;

  /// Pose X_RC of the link that a joint moves, given its parent's: the step that link_poses takes for each joint.
  void place_child(std::size_t joint, const Eigen::Ref<const Eigen::VectorXd>& q, const Eigen::Isometry3d& X_RP,
                   Eigen::Isometry3d& X_RC) const;

  /// Geometric Jacobian [3 x d] of the point p_R fixed to a link, in R, given the link poses at q.
  Eigen::Matrix3Xd point_jacobian(const std::vector<Eigen::Isometry3d>& X_RL, int link,
                                  const Eigen::Vector3d& p_R) const;

  /// q clipped to the joint limits.
  Eigen::VectorXd clip(const Eigen::Ref<const Eigen::VectorXd>& q) const;
  bool within_limits(const Eigen::Ref<const Eigen::VectorXd>& q, double tolerance = 1e-9) const;

 private:
  /// Rotation of a revolute joint about its axis, parent to child: fixed + sin(q) odd + (1 - cos(q)) even (Rodrigues).
  struct Turn {
    Eigen::Matrix3d fixed;
    Eigen::Matrix3d odd;
    Eigen::Matrix3d even;
  };

  void index_joints();
  void index_arms();
  void resolve_drives();
  void restrict_driver(const Joint& joint, const Drive& drive);

  RobotDescription description_;
  std::vector<std::string> joint_names_;
  PlanningGroup arm_;
  PlanningGroup hand_;
  std::vector<DrivenArm> arms_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::VectorXd velocity_;
  Eigen::VectorXd acceleration_;
  Eigen::VectorXd rest_;
  std::vector<Drive> drives_;  ///< [joints]
  std::vector<Turn> turns_;    ///< [joints]
  int palm_ = 0;
};

}  // namespace opponens::robot
