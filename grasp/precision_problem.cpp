// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/precision_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/synergy_box.hpp"
#include "grasp/quality.hpp"
#include "grasp/wrench_gradient.hpp"

namespace opponens::grasp {
namespace {

constexpr double kLengthUnit = 0.01;      // m per unit of gaps and excess: near to the size of quality's changes
constexpr double kAngleUnit = 0.1;        // rad per unit of excess
constexpr double kObjectMargin = 0.0015;  // m; the final check asks for 0.5 mm of dense points
constexpr double kHandMargin = 0.0015;    // m; the final check asks for 0.5 mm
constexpr double kLimitMargin = 0.006;    // rad; what the optimiser counts as feasible is 0.005 rad off
constexpr double kSupportMargin = 0.002;  // m; the final check asks for 1 mm
constexpr double kNotTheBall = 0.0005;    // m, a sample this far from a tip's ball belongs to the rest of its link
constexpr double kBeyond = 0.005;         // m, bodies farther apart than this have no slope

}  // namespace

double PrecisionValue::violation() const {
  const double touching = gaps.size() > 0 ? gaps.cwiseAbs().maxCoeff() : 0.0;
  return excess.size() > 0 ? std::max(touching, excess.maxCoeff()) : touching;
}

PrecisionProblem::PrecisionProblem(const PrecisionSpace& space)
    : space_(space), points_(space.hand, space.surface), by_joints_(6 + space.hand.dof()) {
  const HandSurface& surface = space.surface;
  const auto& links = space.hand.links();
  for (const auto& shape : surface.shapes) samples_.push_back(shape->coarse);
  margin_.assign(links.size(), kObjectMargin);
  for (const FingerTip& tip : space.tips) {
    const auto link = static_cast<std::size_t>(tip.link);
    margin_[link] = -0.5 * space.max_penetration;
    if (tip.radius > 0.0) {
      std::erase_if(samples_[link], [&](const Eigen::Vector3d& p) {
        return (p - tip.center_L).norm() < tip.radius + (tip.exact ? kNotTheBall : 4.0 * kNotTheBall);
      });
    }
    contacts_.push_back({links[link].name, {}, {}, space.convention.mu});
  }
  for (std::size_t link = 0; link < links.size(); ++link) {
    if (!samples_[link].empty()) bodies_.push_back(link);
  }
  Group palm;
  for (const int link : surface.palm_links) palm.links.push_back(static_cast<std::size_t>(link));
  groups_.push_back(palm);
  for (const Finger& finger : surface.fingers) {
    groups_.emplace_back();
    for (const int link : finger.links) groups_.back().links.push_back(static_cast<std::size_t>(link));
  }
  const SynergyBox& box = space.box;
  const Eigen::VectorXd middle = box.scale.cwiseProduct(box.center);
  const Eigen::VectorXd reach = box.scale.cwiseProduct(box.axes.cwiseAbs() * box.half_width);
  for (int j = 0; j < space.hand.dof(); ++j) {
    const bool out =
        middle[j] + reach[j] > space.hand.upper()[j] + 1e-9 || middle[j] - reach[j] < space.hand.lower()[j] - 1e-9;
    if (out) limited_.push_back(j);
  }
  value_.quality_slope.resize(size());
  value_.gaps.resize(gaps());
  value_.gap_slopes.resize(gaps(), size());
  value_.excess.resize(excesses());
  value_.excess_slopes.resize(excesses(), size());
}

int PrecisionProblem::excesses() const {
  const std::size_t groups = groups_.size();
  const std::size_t obstacles = space_.target.obstacles.empty() ? 0 : groups;
  return static_cast<int>(bodies_.size() + groups * (groups - 1) / 2 + obstacles + 2 * limited_.size());
}

HandSeed PrecisionProblem::at(const Eigen::VectorXd& x) const {
  return {chart_pose(seed_.X_OH, x.head<6>()), x.tail(size() - 6)};
}

void PrecisionProblem::stand(const Eigen::VectorXd& x) {
  const HandSeed pose = at(x);
  X_OH_ = pose.X_OH;
  q_ = analysis::configuration(space_.box, pose.y);
  space_.hand.link_poses(q_, X_HL_);
  points_.place(X_OH_, x.segment<3>(3), X_HL_);
}

void PrecisionProblem::write(Eigen::Index row, const Eigen::VectorXd& by_joints, SlopeRows& rows) const {
  rows.row(row).head<6>() = by_joints.head<6>();
  rows.row(row).tail(size() - 6).noalias() =
      (by_joints.tail(space_.hand.dof()).cwiseProduct(space_.box.scale)).transpose() * space_.box.axes;
}

void PrecisionProblem::watch_tips(bool slopes) {
  std::vector<FieldSample> at(space_.tips.size());
  std::vector<Eigen::Vector3d> center(space_.tips.size());
  for (std::size_t i = 0; i < space_.tips.size(); ++i) {
    const FingerTip& tip = space_.tips[i];
    const auto link = static_cast<std::size_t>(tip.link);
    center[i] = X_OH_ * (X_HL_[link] * tip.center_L);
    at[i] = space_.field.query(center[i]);
    const Eigen::Vector3d m = at[i].gradient.normalized();
    contacts_[i].p_OC = center[i] - at[i].value * m;
    contacts_[i].n_O = -m;
    const auto row = static_cast<Eigen::Index>(i);
    value_.gaps[row] = (at[i].value - tip.radius) / kLengthUnit;
    if (!slopes) continue;
    by_joints_.setZero();
    points_.add(link, center[i], at[i].gradient / kLengthUnit, by_joints_);
    write(row, by_joints_, value_.gap_slopes);
  }
  const Matrix6Xd wrenches = contact_wrenches(contacts_, space_.convention);
  const QualitySlope quality = quality_slope(wrenches, space_.goal);
  value_.quality = quality.known ? quality.value : -1.0;
  if (!slopes) return;
  const ContactGradient by_contact = contact_gradient(contacts_, space_.convention, quality.slope);
  by_joints_.setZero();
  for (std::size_t i = 0; i < space_.tips.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double steepness = at[i].gradient.norm();
    const Eigen::Vector3d m = at[i].gradient / steepness;
    const Eigen::Matrix3d turning = (at[i].hessian - m * (m.transpose() * at[i].hessian)) / steepness;  // dm / dc
    const Eigen::Vector3d by_point = by_contact.position.col(column);
    const Eigen::Vector3d by_center = by_point - at[i].gradient * m.dot(by_point) -
                                      turning.transpose() * (at[i].value * by_point + by_contact.normal.col(column));
    points_.add(static_cast<std::size_t>(space_.tips[i].link), center[i], by_center, by_joints_);
  }
  value_.quality_slope.head<6>() = by_joints_.head<6>();
  value_.quality_slope.tail(size() - 6) =
      space_.box.axes.transpose() * by_joints_.tail(space_.hand.dof()).cwiseProduct(space_.box.scale);
}

void PrecisionProblem::exceed(double margin, const Least& least, bool slopes) {
  value_.excess[row_] = (margin - least.value) / kLengthUnit;
  if (slopes) {
    by_joints_.setZero();
    const Eigen::Vector3d g = -least.gradient / kLengthUnit;
    if (least.link >= 0) points_.add(static_cast<std::size_t>(least.link), least.p_O, g, by_joints_);
    if (least.other >= 0) points_.add(static_cast<std::size_t>(least.other), least.p_O, -g, by_joints_);
    write(row_, by_joints_, value_.excess_slopes);
  }
  ++row_;
}

void PrecisionProblem::watch_object(bool slopes) {
  const DistanceGrid& grid = *space_.target.grid;
  for (const std::size_t link : bodies_) {
    const Eigen::Isometry3d X_OL = X_OH_ * X_HL_[link];
    const double bound = grid.value(X_OL * space_.surface.link_center[link]) - space_.surface.link_radius[link];
    Least least{std::max(bound, margin_[link] + kBeyond)};
    if (bound < margin_[link] + kBeyond) {
      least.value = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3d& p_L : samples_[link]) {
        const Eigen::Vector3d p_O = X_OL * p_L;
        const double d = grid.value(p_O);
        if (d < least.value) least = {d, static_cast<int>(link), -1, p_O, Eigen::Vector3d::Zero()};
      }
      least.gradient = grid.query(least.p_O).gradient;
    }
    exceed(margin_[link], least, slopes);
  }
}

PrecisionProblem::Least PrecisionProblem::least_between(std::size_t a, std::size_t b) const {
  const HandSurface& surface = space_.surface;
  const Eigen::Isometry3d X_BA = X_HL_[b].inverse() * X_HL_[a];
  const double bound =
      (X_BA * surface.link_center[a] - surface.link_center[b]).norm() - surface.link_radius[a] - surface.link_radius[b];
  Least least{bound};
  if (bound > kHandMargin + kBeyond) return least;
  least.value = std::numeric_limits<double>::infinity();
  const double reach = surface.link_radius[b] + kHandMargin + kBeyond;
  for (const Eigen::Vector3d& p_A : surface.shapes[a]->coarse) {
    const Eigen::Vector3d p_B = X_BA * p_A;
    const double apart = (p_B - surface.link_center[b]).norm();
    if (apart > reach) {  // a bound will do
      if (apart - surface.link_radius[b] < least.value)
        least = {apart - surface.link_radius[b], -1, -1, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
      continue;
    }
    const SignedDistance d = surface.shapes[b]->body.query(p_B, 1.0);
    if (d.value >= least.value) continue;
    least = {d.value, static_cast<int>(a), static_cast<int>(b), X_OH_ * (X_HL_[a] * p_A),
             X_OH_.linear() * (X_HL_[b].linear() * d.gradient)};
  }
  return least;
}

void PrecisionProblem::watch_itself(bool slopes) {
  for (std::size_t first = 0; first < groups_.size(); ++first) {
    for (std::size_t second = first + 1; second < groups_.size(); ++second) {
      Least least{kHandMargin + kBeyond};
      for (const std::size_t a : groups_[second].links) {
        for (const int stranger : space_.surface.strangers[a]) {
          const auto b = static_cast<std::size_t>(stranger);
          const auto& others = groups_[first].links;
          if (std::find(others.begin(), others.end(), b) == others.end()) continue;
          const Least pair = least_between(a, b);
          if (pair.value < least.value) least = pair;
        }
      }
      exceed(kHandMargin, least, slopes);
    }
  }
}

void PrecisionProblem::watch_obstacles(bool slopes) {
  if (space_.target.obstacles.empty()) return;
  for (const Group& group : groups_) {
    Least least{kSupportMargin + kBeyond};
    for (const std::size_t link : group.links) {
      const Eigen::Isometry3d X_OL = X_OH_ * X_HL_[link];
      const double reach = space_.surface.link_radius[link] + kSupportMargin + kBeyond;
      if (space_.target.obstacle_distance(X_OL * space_.surface.link_center[link], reach).value > reach) continue;
      for (const Eigen::Vector3d& p_L : space_.surface.shapes[link]->coarse) {
        const Eigen::Vector3d p_O = X_OL * p_L;
        const SignedDistance d = space_.target.obstacle_distance(p_O, reach);
        if (d.value < least.value) least = {d.value, static_cast<int>(link), -1, p_O, d.gradient};
      }
    }
    exceed(kSupportMargin, least, slopes);
  }
}

void PrecisionProblem::watch_limits(bool slopes) {
  const auto limit = [&](int joint, double excess, double sign) {
    value_.excess[row_] = (excess + kLimitMargin) / kAngleUnit;
    if (slopes) {
      by_joints_.setZero();
      by_joints_[6 + joint] = sign / kAngleUnit;
      write(row_, by_joints_, value_.excess_slopes);
    }
    ++row_;
  };
  for (const int joint : limited_) {
    limit(joint, q_[joint] - space_.hand.upper()[joint], 1.0);
    limit(joint, space_.hand.lower()[joint] - q_[joint], -1.0);
  }
}

const PrecisionValue& PrecisionProblem::evaluate(const Eigen::VectorXd& x, bool slopes) {
  ++evaluations_;
  row_ = 0;
  stand(x);
  watch_tips(slopes);
  watch_object(slopes);
  watch_itself(slopes);
  watch_obstacles(slopes);
  watch_limits(slopes);
  return value_;
}

std::vector<TipTouch> PrecisionProblem::touches(const Eigen::VectorXd& x, SlopeRows& slopes) {
  stand(x);
  slopes.resize(gaps(), size());
  std::vector<TipTouch> touches;
  for (const FingerTip& tip : space_.tips) {
    const auto link = static_cast<std::size_t>(tip.link);
    const Eigen::Isometry3d X_OL = X_OH_ * X_HL_[link];
    touches.push_back(touch(tip, space_.surface, space_.target, X_OL));
    by_joints_.setZero();
    // The tip's own nearest point moves with the link; for a ball its centre does as well.
    const Eigen::Vector3d p_O = tip.exact ? Eigen::Vector3d(X_OL * tip.center_L) : touches.back().p_O;
    points_.add(link, p_O, -touches.back().n_O, by_joints_);
    write(static_cast<Eigen::Index>(touches.size()) - 1, by_joints_, slopes);
  }
  return touches;
}

}  // namespace opponens::grasp
