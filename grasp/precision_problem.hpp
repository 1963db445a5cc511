// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/grasp.hpp"
#include "grasp/grasp_objective.hpp"
#include "grasp/pose_chart.hpp"
#include "grasp/precision_space.hpp"
#include "grasp/tip_contact.hpp"

namespace opponens::grasp {

/// Row-major, as NLopt wants the slopes of vector constraints.
using SlopeRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct PrecisionValue {
  double quality = 0.0;           ///< to be large: QualitySlope::value
  Eigen::VectorXd quality_slope;  ///< [n]
  Eigen::VectorXd gaps;           ///< [tips] cm between tip and object; to be 0
  SlopeRows gap_slopes;           ///< [tips x n]
  Eigen::VectorXd excess;         ///< [m] cm (joint limits: 0.1 rad); to be <= 0
  SlopeRows excess_slopes;        ///< [m x n]

  /// Largest of |gaps| and excess.
  double violation() const;
};

/// The nonlinear programme of one precision grasp, over x = [10 t; w; y] as in GraspObjective: hand pose around a
/// seed and k synergy coordinates. Distances to the object are TipField's; a tip at distance v from it, gradient g,
/// m = g / |g|, touches at p = c - v m with normal -m, whose slopes use the field's Hessian:
/// dm = (I - m m') H / |g| dc. Excess, all of them distances of sampled points:
///   object     per link, 1.5 mm less the distance; links that carry a tip may be max_penetration / 2 deep
///   itself     per pair of fingers (or palm), 1.5 mm less the distance of points of one to the other's bodies
///   obstacles  per finger and palm, 2 mm less the distance to support and obstacles
///   limits     per joint that the box lets out of its limits, 6 mrad more than the violation
/// Bodies that are far apart by their bounding spheres have that bound as value, and no slope.
class PrecisionProblem {
 public:
  explicit PrecisionProblem(const PrecisionSpace& space);

  int size() const { return 6 + static_cast<int>(space_.box.half_width.size()); }
  int gaps() const { return static_cast<int>(space_.tips.size()); }
  int excesses() const;
  void place(const HandSeed& seed) { seed_ = seed; }
  HandSeed at(const Eigen::VectorXd& x) const;
  /// Slopes are left as they were unless asked for. The reference is valid until the next call.
  const PrecisionValue& evaluate(const Eigen::VectorXd& x, bool slopes);
  std::int64_t evaluations() const { return evaluations_; }

  /// The gaps by the exact distance (m) and their slopes [tips x n] by x; for the last steps to contact.
  std::vector<TipTouch> touches(const Eigen::VectorXd& x, SlopeRows& slopes);

 private:
  struct Group {  ///< the palm with what is fixed to it, or a finger
    std::vector<std::size_t> links;
  };
  struct Least {  ///< a least distance and where it is
    double value;
    int link = -1;
    int other = -1;
    Eigen::Vector3d p_O = Eigen::Vector3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< of the distance by p_O
  };
  void stand(const Eigen::VectorXd& x);
  void watch_tips(bool slopes);
  void watch_object(bool slopes);
  void watch_itself(bool slopes);
  void watch_obstacles(bool slopes);
  void watch_limits(bool slopes);
  Least least_between(std::size_t a, std::size_t b) const;
  void exceed(double margin, const Least& least, bool slopes);
  void write(Eigen::Index row, const Eigen::VectorXd& by_joints, SlopeRows& rows) const;

  const PrecisionSpace& space_;
  HandSeed seed_;
  PointSlopes points_;
  std::vector<Group> groups_;
  std::vector<std::size_t> bodies_;                    ///< links that are watched against the object
  std::vector<std::vector<Eigen::Vector3d>> samples_;  ///< per link, p_L, without the tip's ball
  std::vector<double> margin_;                         ///< per link, m, least distance to the object
  std::vector<int> limited_;                           ///< joints that the box lets out of their limits
  std::vector<Eigen::Isometry3d> X_HL_;
  Eigen::Isometry3d X_OH_ = Eigen::Isometry3d::Identity();
  Eigen::VectorXd q_;
  std::vector<Contact> contacts_;
  Eigen::VectorXd by_joints_;  ///< [6 + n], scratch
  Eigen::Index row_ = 0;       ///< of excess, next to be written
  PrecisionValue value_;
  std::int64_t evaluations_ = 0;
};

}  // namespace opponens::grasp
