// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/grasp_objective.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>

#include <nlopt.h>

#include "analysis/synergy_box.hpp"
#include "grasp/pose_chart.hpp"

namespace opponens::grasp {
namespace {

constexpr double kReach = 0.02;  // m, scale of the contact cost
constexpr double kBalanceWeight = 3.0;
constexpr double kFacingDepth = 0.01;       // m
constexpr double kPenetrationUnit = 0.005;  // m
constexpr double kPenetrationWeight = 0.02;
constexpr double kObstacleGap = 0.005;  // m
constexpr double kLimitUnit = 0.1;      // rad
constexpr double kLimitWeight = 0.5;
constexpr double kMaxShift = 0.05;  // m
constexpr double kMaxTurn = 0.6;    // rad

struct DestroyOptimizer {
  void operator()(nlopt_opt_s* optimizer) const { nlopt_destroy(optimizer); }
};

struct Problem {
  GraspObjective& objective;
  const HandSeed& seed;
};

double nlopt_cost(unsigned n, const double* x, double* gradient, void* data) {
  const Problem& problem = *static_cast<Problem*>(data);
  const Eigen::VectorXd point = Eigen::Map<const Eigen::VectorXd>(x, n);
  if (!point.allFinite()) {  // NLopt has been seen to ask for NaN
    if (gradient) Eigen::Map<Eigen::VectorXd>(gradient, n).setZero();
    return std::numeric_limits<double>::infinity();
  }
  Eigen::VectorXd slope;
  const double cost = problem.objective.evaluate(problem.seed, point, gradient ? &slope : nullptr);
  if (gradient) Eigen::Map<Eigen::VectorXd>(gradient, n) = slope;
  return cost;
}

}  // namespace

GraspObjective::GraspObjective(const robot::RobotModel& hand, const HandSurface& surface, const GraspTarget& target,
                               const SynergyBox& box)
    : hand_(hand), surface_(surface), target_(target), box_(box), pull_(hand.links().size()) {
  std::map<std::string, int> count;
  for (const robot::SurfacePoint& point : hand.description().contact_points) ++count[point.finger];
  for (const robot::SurfacePoint& point : hand.description().contact_points) {
    const double weight = 1.0 / (static_cast<double>(count.size()) * count[point.finger]);
    goals_.push_back({point.link, point.p_L, 0.0, weight});
    goals_.push_back({point.link, point.p_L + kFacingDepth * point.n_L, kFacingDepth, weight});
  }
}

HandSeed GraspObjective::at(const HandSeed& seed, const Eigen::VectorXd& x) const {
  return {chart_pose(seed.X_OH, x.head<6>()), x.tail(size() - 6)};
}

void GraspObjective::add(std::size_t link, const Eigen::Vector3d& p_H, const Eigen::Vector3d& gradient_H) {
  pull_[link].force += gradient_H;
  pull_[link].torque += p_H.cross(gradient_H);
}

double GraspObjective::add_contacts(const Eigen::Isometry3d& X_OH) {
  double cost = 0.0;
  for (const Goal& goal : goals_) {
    const auto link = static_cast<std::size_t>(goal.link);
    const Eigen::Vector3d p_H = X_HL_[link] * goal.p_L;
    const SignedDistance d = target_.grid->query(X_OH * p_H);
    const double error = d.value + goal.depth;
    const double bottom = error * error + kReach * kReach;
    cost += goal.weight * error * error / bottom;
    const double slope = goal.weight * 2.0 * error * kReach * kReach / (bottom * bottom);
    add(link, p_H, X_OH.linear().transpose() * (slope * d.gradient));
  }
  return cost;
}

double GraspObjective::add_balance(const Eigen::Isometry3d& X_OH) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  double total = 0.0;
  touches_.clear();
  const auto& points = hand_.description().contact_points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto link = static_cast<std::size_t>(points[i].link);
    const Eigen::Vector3d p_H = X_HL_[link] * points[i].p_L;
    const Eigen::Vector3d p_O = X_OH * p_H;
    const SignedDistance d = target_.grid->query(p_O);
    const double bottom = d.value * d.value + kReach * kReach;
    const double weight = goals_[2 * i].weight * kReach * kReach;
    const Eigen::Vector3d n_O = X_OH.linear() * (X_HL_[link].linear() * points[i].n_L);
    touches_.push_back({link, p_H, p_O, n_O, d.gradient, weight / bottom, -2.0 * weight * d.value / (bottom * bottom)});
    force += touches_.back().share * n_O;
    torque += touches_.back().share * (p_O - target_.center_of_mass).cross(n_O) / target_.rho;
    total += touches_.back().share;
  }
  const double cost = kBalanceWeight * (force.squaredNorm() + torque.squaredNorm()) / (total * total);
  const Eigen::Vector3d by_force = 2.0 * kBalanceWeight / (total * total) * force;
  const Eigen::Vector3d by_torque = 2.0 * kBalanceWeight / (total * total * target_.rho) * torque;
  for (const Touch& t : touches_) {
    const Eigen::Vector3d arm = t.p_O - target_.center_of_mass;
    const double by_share = by_force.dot(t.n_O) + by_torque.dot(arm.cross(t.n_O)) - 2.0 * cost / total;
    const Eigen::Vector3d by_point = t.share * t.n_O.cross(by_torque) + by_share * t.share_slope * t.slope;
    const Eigen::Vector3d by_normal = t.share * (by_force + by_torque.cross(arm));
    add(t.link, t.p_H, X_OH.linear().transpose() * by_point);
    pull_[t.link].torque += X_OH.linear().transpose() * t.n_O.cross(by_normal);  // turning the link turns its normal
  }
  return cost;
}

double GraspObjective::add_penetration(const Eigen::Isometry3d& X_OH) {
  double cost = 0.0;
  const auto penalize = [&](std::size_t link, const Eigen::Vector3d& p_H, const SignedDistance& d, double margin) {
    const double depth = margin - d.value;
    if (depth <= 0.0) return;
    cost += kPenetrationWeight * std::pow(depth / kPenetrationUnit, 2);
    const double slope = -2.0 * kPenetrationWeight * depth / (kPenetrationUnit * kPenetrationUnit);
    add(link, p_H, X_OH.linear().transpose() * (slope * d.gradient));
  };
  for (std::size_t link = 0; link < surface_.shapes.size(); ++link) {
    const Eigen::Vector3d center = X_OH * X_HL_[link] * surface_.link_center[link];
    const double radius = surface_.link_radius[link];
    const bool near_object = target_.grid->value(center) < radius + target_.grid->spacing();
    const double reach = radius + kObstacleGap;
    const bool near_obstacle = target_.obstacle_distance(center, reach).value < reach;
    if (!near_object && !near_obstacle) continue;
    for (const Eigen::Vector3d& p_L : surface_.shapes[link]->sparse) {
      const Eigen::Vector3d p_H = X_HL_[link] * p_L;
      const Eigen::Vector3d p_O = X_OH * p_H;
      if (near_object) penalize(link, p_H, target_.grid->query(p_O), 0.0);
      if (near_obstacle) penalize(link, p_H, target_.obstacle_distance(p_O, kObstacleGap), kObstacleGap);
    }
  }
  return cost;
}

Eigen::VectorXd GraspObjective::joint_gradient() const {
  std::vector<Pull> total = pull_;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(hand_.dof());
  const robot::RobotDescription& d = hand_.description();
  for (std::size_t link = d.links.size(); link-- > 1;) {
    const robot::Joint& joint = d.joints[static_cast<std::size_t>(d.links[link].joint)];
    const LinkDrive& drive = surface_.drives[link];
    if (drive.index >= 0) {
      const Eigen::Vector3d axis = X_HL_[link].linear() * joint.axis;
      const Eigen::Vector3d moment = total[link].torque - X_HL_[link].translation().cross(total[link].force);
      const double slope = joint.type == robot::JointType::prismatic ? axis.dot(total[link].force) : axis.dot(moment);
      gradient[drive.index] += drive.multiplier * slope;
    }
    Pull& parent = total[static_cast<std::size_t>(joint.parent)];
    parent.force += total[link].force;
    parent.torque += total[link].torque;
  }
  return gradient;
}

double GraspObjective::evaluate(const HandSeed& seed, const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  ++evaluations_;
  const HandSeed point = at(seed, x);
  const Eigen::VectorXd q = analysis::configuration(box_, point.y);
  hand_.link_poses(q, X_HL_);
  pull_.assign(pull_.size(), Pull{});
  double cost = add_contacts(point.X_OH) + add_balance(point.X_OH) + add_penetration(point.X_OH);
  const Eigen::VectorXd violation = (q - hand_.clip(q)) / kLimitUnit;
  cost += kLimitWeight * violation.squaredNorm();
  if (!gradient) return cost;
  Pull total;
  for (const Pull& pull : pull_) {
    total.force += pull.force;
    total.torque += pull.torque;
  }
  const Eigen::VectorXd slope_q = joint_gradient() + 2.0 * kLimitWeight / kLimitUnit * violation;
  gradient->resize(size());
  gradient->head<3>() = kChartPosition * (point.X_OH.linear() * total.force);
  gradient->segment<3>(3) = turning_jacobian(x.segment<3>(3)).transpose() * (point.X_OH.linear() * total.torque);
  gradient->tail(size() - 6) = box_.axes.transpose() * box_.scale.cwiseProduct(slope_q);
  return cost;
}

HandSeed optimize_seed(GraspObjective& objective, const HandSeed& seed, const Eigen::VectorXd& half_width,
                       int max_evaluations) {
  const int n = objective.size();
  Eigen::VectorXd lower(n);
  lower << Eigen::Vector3d::Constant(-kMaxShift / kChartPosition), Eigen::Vector3d::Constant(-kMaxTurn), -half_width;
  const Eigen::VectorXd upper = -lower;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  x.tail(n - 6) = seed.y.cwiseMax(-half_width).cwiseMin(half_width);
  const Eigen::VectorXd start = x;
  Problem problem{objective, seed};
  const std::unique_ptr<nlopt_opt_s, DestroyOptimizer> optimizer(
      nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(n)));
  nlopt_set_min_objective(optimizer.get(), nlopt_cost, &problem);
  nlopt_set_lower_bounds(optimizer.get(), lower.data());
  nlopt_set_upper_bounds(optimizer.get(), upper.data());
  nlopt_set_maxeval(optimizer.get(), max_evaluations);
  nlopt_set_ftol_rel(optimizer.get(), 1e-4);
  double cost = std::numeric_limits<double>::infinity();
  nlopt_optimize(optimizer.get(), x.data(), &cost);  // its code is not trusted: the answer itself is checked
  if (!x.allFinite()) return {seed.X_OH, start.tail(n - 6)};
  x = x.cwiseMax(lower).cwiseMin(upper);
  const double before = objective.evaluate(seed, start, nullptr);
  const double after = objective.evaluate(seed, x, nullptr);
  return objective.at(seed, after < before ? x : start);
}

}  // namespace opponens::grasp
