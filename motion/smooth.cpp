// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/smooth.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "core/require.hpp"
#include "motion/blended_path.hpp"
#include "motion/joint_metric.hpp"

namespace opponens::motion {
namespace {

using Points =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // [N x d]: a block is contiguous

/// Residual sqrt(w (s1 + s2) / 2) q'' of three neighbours s1 and s2 apart.
class Bending : public ceres::CostFunction {
 public:
  Bending(const Eigen::VectorXd& weights, double before, double after) : root_(weights.cwiseSqrt()) {
    const double mean = 0.5 * (before + after);
    factors_ = std::sqrt(mean) / mean * Eigen::Vector3d(1.0 / before, -1.0 / before - 1.0 / after, 1.0 / after);
    const auto d = static_cast<int>(weights.size());
    set_num_residuals(d);
    for (int i = 0; i < 3; ++i) mutable_parameter_block_sizes()->push_back(d);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index d = root_.size();
    Eigen::Map<Eigen::VectorXd> r(residuals, d);
    r.setZero();
    for (int i = 0; i < 3; ++i) {
      r += factors_[i] * root_.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(parameters[i], d));
      if (jacobians == nullptr || jacobians[i] == nullptr) continue;
      Eigen::Map<Points> jacobian(jacobians[i], d, d);
      jacobian.setZero();
      jacobian.diagonal() = factors_[i] * root_;
    }
    return true;
  }

 private:
  Eigen::VectorXd root_;
  Eigen::Vector3d factors_;
};

/// Residual weight max(0, distance - limit).
class BeyondBox : public ceres::CostFunction {
 public:
  BeyondBox(const BoxDistance& distance, double limit, double weight, int d)
      : distance_(distance), limit_(limit), weight_(weight) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(d);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index d = parameter_block_sizes()[0];
    Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(parameters[0], d);
    const double beyond = distance_(q) - limit_;
    residuals[0] = weight_ * std::max(0.0, beyond);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::VectorXd> slope(jacobians[0], d);
    slope.setZero();
    if (beyond <= 0.0) return true;
    constexpr double kStep = 1e-6;  // rad
    for (Eigen::Index j = 0; j < d; ++j) {
      const double at = q[j];
      q[j] = at + kStep;
      const double above = distance_(q);
      q[j] = at - kStep;
      slope[j] = weight_ * (above - distance_(q)) / (2.0 * kStep);
      q[j] = at;
    }
    return true;
  }

 private:
  const BoxDistance& distance_;
  double limit_;
  double weight_;
};

/// Residuals weight max(0, wanted - clearance).
class TooNear : public ceres::CostFunction {
 public:
  TooNear(const Clearances& clearances, int count, const SmoothSettings& settings, int d)
      : clearances_(clearances), settings_(settings) {
    set_num_residuals(count);
    mutable_parameter_block_sizes()->push_back(d);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index d = parameter_block_sizes()[0];
    const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
    Eigen::MatrixXd derivative;
    const Eigen::VectorXd clearance =
        clearances_(Eigen::Map<const Eigen::VectorXd>(parameters[0], d), wanted ? &derivative : nullptr);
    for (Eigen::Index i = 0; i < clearance.size(); ++i) {
      residuals[i] = settings_.clearance_weight * std::max(0.0, settings_.clearance - clearance[i]);
    }
    if (!wanted) return true;
    Eigen::Map<Points> jacobian(jacobians[0], clearance.size(), d);
    for (Eigen::Index i = 0; i < clearance.size(); ++i) {
      const bool near = clearance[i] < settings_.clearance;
      jacobian.row(i) = (near ? -settings_.clearance_weight : 0.0) * derivative.row(i);
    }
    return true;
  }

 private:
  const Clearances& clearances_;
  const SmoothSettings& settings_;
};

/// A path divided evenly along each of its segments; the last column is what it was.
struct Divided {
  Points points;            ///< [N x d]
  Eigen::VectorXd spacing;  ///< [N - 1] rad
  std::vector<bool> fixed;  ///< [N] ends, and where the boxes change
  int change = -1;          ///< row of the latter; -1: no boxes
};

Divided divided(const Eigen::MatrixXd& waypoints, const Eigen::VectorXd& weights, const FollowedBoxes* boxes,
                int count) {
  const double spacing = path_length(weights, waypoints) / count;
  const int change = boxes == nullptr ? -1 : change_row(*boxes, waypoints).value_or(-1);
  std::vector<Eigen::VectorXd> rows;
  Divided result;
  for (Eigen::Index i = 0; i < waypoints.rows(); ++i) {
    const Eigen::VectorXd at = waypoints.row(i).transpose();
    if (i == change) result.change = static_cast<int>(rows.size());
    rows.push_back(at);
    if (i + 1 == waypoints.rows()) break;
    const Eigen::VectorXd step = waypoints.row(i + 1).transpose() - at;
    const int parts = std::max(1, static_cast<int>(std::lround(std::sqrt(step.cwiseAbs2().dot(weights)) / spacing)));
    for (int k = 1; k < parts; ++k) rows.emplace_back(at + step * k / parts);
  }
  const auto total = static_cast<Eigen::Index>(rows.size());
  result.points.resize(total, waypoints.cols());
  for (Eigen::Index i = 0; i < total; ++i) result.points.row(i) = rows[static_cast<std::size_t>(i)].transpose();
  result.spacing.resize(total - 1);
  for (Eigen::Index i = 0; i + 1 < total; ++i) {
    result.spacing[i] = distance(weights, rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(i) + 1]);
  }
  result.fixed.assign(rows.size(), false);
  result.fixed.front() = result.fixed.back() = true;
  if (result.change >= 0) result.fixed[static_cast<std::size_t>(result.change)] = true;
  return result;
}

Smoothness smoothness(const Points& points, const Eigen::VectorXd& weights) {
  Smoothness result{path_length(weights, points), 0.0};
  for (Eigen::Index i = 1; i + 1 < points.rows(); ++i) {
    const Eigen::VectorXd in = (points.row(i) - points.row(i - 1)).transpose();
    const Eigen::VectorXd out = (points.row(i + 1) - points.row(i)).transpose();
    const double before = std::sqrt(in.cwiseAbs2().dot(weights));
    const double after = std::sqrt(out.cwiseAbs2().dot(weights));
    const double mean = 0.5 * (before + after);
    const Eigen::VectorXd second = (out / after - in / before) / mean;
    result.bending += mean * second.cwiseAbs2().dot(weights);
  }
  return result;
}

/// The solver's answer, before any part of it is asked for.
Points solved(const Divided& path, const Eigen::VectorXd& weights, const Eigen::VectorXd& lower,
              const Eigen::VectorXd& upper, const FollowedBoxes* boxes, const Clearances& clearances,
              const SmoothSettings& settings) {
  Points points = path.points;
  const auto d = static_cast<int>(points.cols());
  const auto block = [&](Eigen::Index i) { return points.row(i).data(); };
  ceres::Problem problem;
  for (Eigen::Index i = 1; i + 1 < points.rows(); ++i) {
    problem.AddResidualBlock(new Bending(weights, path.spacing[i - 1], path.spacing[i]), nullptr, block(i - 1),
                             block(i), block(i + 1));
    if (path.fixed[static_cast<std::size_t>(i)]) continue;
    if (boxes != nullptr) {
      const bool start = i < path.change;
      problem.AddResidualBlock(new BeyondBox(start ? boxes->start : boxes->goal,
                                             start ? boxes->start_limit : boxes->goal_limit, settings.box_weight, d),
                               nullptr, block(i));
    }
    if (clearances) {
      const auto count = static_cast<int>(clearances(points.row(i).transpose(), nullptr).size());
      problem.AddResidualBlock(new TooNear(clearances, count, settings, d), nullptr, block(i));
    }
    for (int j = 0; j < d; ++j) {
      problem.SetParameterLowerBound(block(i), j, std::min(lower[j], points(i, j)));
      problem.SetParameterUpperBound(block(i), j, std::max(upper[j], points(i, j)));
    }
  }
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (path.fixed[static_cast<std::size_t>(i)]) problem.SetParameterBlockConstant(block(i));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = settings.iterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable() && points.allFinite() ? points : path.points;
}

/// Takes back from `points` what is not valid or breaks the law, part by part.
class Keeping {
 public:
  Keeping(const Divided& path, const Points& wanted, const World& world, const FollowedBoxes* boxes,
          const SmoothSettings& settings)
      : path_(path), wanted_(wanted), world_(world), boxes_(boxes), settings_(settings) {
    halved_.assign(static_cast<std::size_t>(path.points.rows()), 0);
  }

  /// nullopt: not even the given path, divided, is valid.
  std::optional<Points> kept(std::int64_t& checks) {
    for (Eigen::Index i = 0; i < path_.points.rows(); ++i) keep_law(i);
    std::vector<bool> asked(static_cast<std::size_t>(path_.points.rows()), false);
    for (Eigen::Index i = 0; i + 1 < path_.points.rows();) {
      if (asked[static_cast<std::size_t>(i)] ||
          valid_motion(world_, point(i).transpose(), point(i + 1).transpose(), checks)) {
        asked[static_cast<std::size_t>(i)] = true;
        ++i;
        continue;
      }
      const bool left = take_back(i);
      const bool right = take_back(i + 1);
      if (!left && !right) return std::nullopt;
      for (Eigen::Index k = std::max<Eigen::Index>(0, i - 1); k <= i + 1; ++k)
        asked[static_cast<std::size_t>(k)] = false;
      i = std::max<Eigen::Index>(0, i - 1);
    }
    Points points = path_.points;
    for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) = point(i);
    return points;
  }

  int moved() const {
    int count = 0;
    for (std::size_t i = 0; i < halved_.size(); ++i) count += !path_.fixed[i] && halved_[i] <= settings_.halvings;
    return count;
  }

 private:
  Eigen::RowVectorXd point(Eigen::Index i) const {
    const int halved = halved_[static_cast<std::size_t>(i)];
    if (halved > settings_.halvings) return path_.points.row(i);
    return path_.points.row(i) + std::ldexp(1.0, -halved) * (wanted_.row(i) - path_.points.row(i));
  }

  bool take_back(Eigen::Index i) {
    int& halved = halved_[static_cast<std::size_t>(i)];
    if (path_.fixed[static_cast<std::size_t>(i)] || halved > settings_.halvings) return false;
    ++halved;
    return true;
  }

  void keep_law(Eigen::Index i) {
    if (boxes_ == nullptr) return;
    const bool start = i < path_.change;
    const BoxDistance& distance = start ? boxes_->start : boxes_->goal;
    const double limit = start ? boxes_->start_limit : boxes_->goal_limit;
    while (distance(point(i).transpose()) > limit + 1e-10 && take_back(i)) {
    }
  }

  const Divided& path_;
  const Points& wanted_;
  const World& world_;
  const FollowedBoxes* boxes_;
  const SmoothSettings& settings_;
  std::vector<int> halved_;  ///< [N] how often the change of a point was halved; above settings_.halvings: taken back
};

}  // namespace

void validate(const SmoothSettings& settings) {
  const auto check = [](bool holds, const char* field, double value, const char* constraint) {
    require(holds, [&] {
      return std::string("SmoothSettings::") + field + " = " + std::to_string(value) + ": must be " + constraint;
    });
  };
  check(settings.points > 1, "points", settings.points, "> 1");
  check(settings.iterations >= 0, "iterations", settings.iterations, ">= 0");
  check(settings.halvings >= 0, "halvings", settings.halvings, ">= 0");
  check(settings.box_weight >= 0.0, "box_weight", settings.box_weight, ">= 0");
  check(std::isfinite(settings.clearance), "clearance", settings.clearance, "finite (m)");
  check(settings.clearance_weight >= 0.0, "clearance_weight", settings.clearance_weight, ">= 0");
}

Smoothed smooth(const JointPath& path, const Eigen::VectorXd& weights, const Eigen::VectorXd& lower,
                const Eigen::VectorXd& upper, const World& world, const FollowedBoxes* boxes,
                const Clearances& clearances, const SmoothSettings& settings) {
  validate(settings);
  require(path.waypoints.rows() > 0 && path.waypoints.cols() == weights.size() && weights.size() == lower.size() &&
              lower.size() == upper.size(),
          "smooth: path, weights and limits differ in the number of joints");
  require(boxes == nullptr || change_row(*boxes, path.waypoints),
          "smooth: the path is further from its boxes than they allow");
  Smoothed result{path, {}, {}, 0, 0, 0};
  const Eigen::MatrixXd waypoints = distinct(path.waypoints);
  if (waypoints.rows() < 3) return result;
  const Divided given = divided(waypoints, weights, boxes, settings.points);
  result.points = static_cast<int>(given.points.rows()) - 2;
  result.before = result.after = smoothness(given.points, weights);
  const Points wanted = solved(given, weights, lower, upper, boxes, clearances, settings);
  Keeping keeping(given, wanted, world, boxes, settings);
  const auto kept = keeping.kept(result.collision_checks);
  if (!kept) return result;
  const Smoothness after = smoothness(*kept, weights);
  if (after.bending >= result.before.bending) return result;  // what was kept of the change is of no use
  result.path.waypoints = *kept;
  result.after = after;
  result.moved = keeping.moved();
  return result;
}

}  // namespace opponens::motion
