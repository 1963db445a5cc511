// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/result.hpp"
#include "robot/kinematic_chain.hpp"
#include "robot/ur_closed_form.hpp"

namespace opponens::robot {

/// At most eight arm positions, without memory of their own to allocate.
struct ArmBranches {
  std::array<Vector6d, 8> q;  ///< rad, in the group's order
  int count = 0;
  const Vector6d* begin() const { return q.data(); }
  const Vector6d* end() const { return q.data() + count; }
};

/// Analytic inverse kinematics of an arm of the UR family, whose dimensions are read from the model's own axes, so that
/// it needs no table of robots. The closed form (ur_closed_form.hpp) is exact for an arm with exactly parallel and
/// perpendicular axes. A URDF prints angles with few digits: then X_RT is corrected by the difference of the ideal and
/// the printed arm at the solution, and solved again (defect correction; the difference is of order 1e-9, so one pass
/// mostly settles it, also beside singularities). What that leaves open, at limits and double singularities, goes
/// through damped least squares on the printed arm. Every position returned meets the pose within 1e-10 (m and rad) and
/// is inside the limits. Thread-safe.
class UrKinematics {
 public:
  /// Failure (not_found): the chain is none of the family; says what differs.
  static Result<UrKinematics> of(KinematicChain chain);

  /// The branches: each joint in the turn nearest to the middle of its limits; distinct by 1e-6 rad. None: out of
  /// reach. Where axes 4 and 6 are parallel joint 6 is free: it is set to the middle of its limits or, where the elbow
  /// cannot reach then, so that the elbow is bent most and least. Throws std::invalid_argument unless X_RT is finite
  /// and its rotation orthonormal within 1e-6.
  ArmBranches branches(const Eigen::Isometry3d& X_RT) const;

  /// The branches and all their copies by whole turns that the limits allow.
  std::vector<Eigen::VectorXd> solve(const Eigen::Isometry3d& X_RT) const;

  const KinematicChain& chain() const { return chain_; }
  const UrArm& ideal() const { return arm_; }
  double deviation() const { return deviation_; }  ///< largest seen of the ideal arm's tip, m and rad

 private:
  struct Sides {
    double shoulder, wrist, elbow;
  };
  struct Search {
    const Eigen::Isometry3d& X_RT;
    UrPose X;  ///< X_06
    ArmBranches found;
  };

  UrKinematics(KinematicChain chain, UrArm arm);
  double measure_deviation() const;
  UrPose frame6(const Eigen::Isometry3d& X_RT) const;
  void wrist_roots(Search& search, const UrShoulder& shoulder, Sides sides) const;
  double noise_of_elbow(const Search& search, const UrShoulder& shoulder, const UrWrist& wrist) const;
  bool elbow_roots(Search& search, const UrShoulder& shoulder, const UrWrist& wrist, Sides sides) const;
  bool correct(const Search& search, Sides sides, Vector6d& theta, double miss) const;
  bool accept(Search& search, const Vector6d& theta, bool settled) const;
  Vector6d nearest_turn(const Vector6d& theta) const;

  KinematicChain chain_;
  UrArm arm_;
  UrPose X_0R_;
  UrPose X_T6_;
  double deviation_;
  Vector6d lower_;  ///< of joint 1 to 6, as the following
  Vector6d upper_;
  Vector6d middle_;
  std::array<Eigen::Index, 6> index_;  ///< into the group's positions
};

}  // namespace opponens::robot
