// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/synergies.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_surface.hpp"
#include "robot/robot_model.hpp"

namespace opponens::grasp {

/// A hand near the object: palm pose and synergy coordinates.
struct HandSeed {
  Eigen::Isometry3d X_OH = Eigen::Isometry3d::Identity();
  Eigen::VectorXd y;  ///< [k] scaled units
};

/// The cost that NLopt minimises, over x = [10 t; w; y]: palm position t (m, from the seed's), rotation vector w (left
/// of the seed's rotation), synergy coordinates y of the group's box. With d the signed distance to the object, n a
/// contact point's outward normal, and rho(e) = e^2 / (e^2 + (2 cm)^2) (Geman and McClure 1987):
///   contact      sum_c w_c [ rho(d(p_c)) + rho(d(p_c + 1 cm n_c) + 1 cm) ]: on the surface, and facing it: the second
///                point is 1 cm deep exactly when the normals oppose; every finger weighs the same
///   balance      3 (|sum_c s_c n_c|^2 + |sum_c s_c (p_c - com) x n_c / rho|^2) / (sum_c s_c)^2 with
///                s_c = w_c (1 - rho(d(p_c))): normals of the touching points that cancel in force and torque
///   penetration  0.02 sum_s (min(0, d(p_s)) / 5 mm)^2 over points of the hand's surface
///   obstacles    the same with the distance to support and obstacles less 5 mm
///   limits       0.5 sum_j (violation / 0.1 rad)^2
/// The gradient is exact for the gridded distance (wrenches summed from finger tip to palm).
class GraspObjective {
 public:
  GraspObjective(const robot::RobotModel& hand, const HandSurface& surface, const GraspTarget& target,
                 const SynergyBox& box);

  int size() const { return 6 + static_cast<int>(box_.half_width.size()); }
  /// Cost at x around the seed; gradient [size] is written when not null.
  double evaluate(const HandSeed& seed, const Eigen::VectorXd& x, Eigen::VectorXd* gradient);
  HandSeed at(const HandSeed& seed, const Eigen::VectorXd& x) const;
  std::int64_t evaluations() const { return evaluations_; }

 private:
  struct Pull {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< d cost / d p of the points of a link, in H
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< sum of p x force about H's origin
  };
  struct Touch {  ///< a contact point of the hand, for the balance
    std::size_t link;
    Eigen::Vector3d p_H, p_O, n_O, slope;  ///< slope: gradient of the distance, in O
    double share;                          ///< s_c
    double share_slope;                    ///< d s_c / d d
  };
  struct Goal {
    int link;
    Eigen::Vector3d p_L;
    double depth;  ///< m, wanted distance is -depth
    double weight;
  };
  double add_contacts(const Eigen::Isometry3d& X_OH);
  double add_balance(const Eigen::Isometry3d& X_OH);
  double add_penetration(const Eigen::Isometry3d& X_OH);
  void add(std::size_t link, const Eigen::Vector3d& p_H, const Eigen::Vector3d& gradient_H);
  Eigen::VectorXd joint_gradient() const;

  const robot::RobotModel& hand_;
  const HandSurface& surface_;
  const GraspTarget& target_;
  const SynergyBox& box_;
  std::vector<Goal> goals_;
  std::vector<Touch> touches_;
  std::vector<Eigen::Isometry3d> X_HL_;
  std::vector<Pull> pull_;
  std::int64_t evaluations_ = 0;
};

/// Minimises from x = 0, y = the seed's by NLopt's SLSQP inside |t| <= 5 cm, |w_i| <= 0.6 rad and the box. A result
/// that is not finite, or worse than the seed, leaves the seed (NLopt may report success with NaN).
HandSeed optimize_seed(GraspObjective& objective, const HandSeed& seed, const Eigen::VectorXd& half_width,
                       int max_evaluations);

}  // namespace opponens::grasp
