// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Inverse kinematics of the UR5, for palm poses of uniformly random positions inside the limits. One iteration is one
// pose; the counter poses is per second of CPU, solutions per pose. Ours: all branches, each checked and inside the
// limits; the same with every whole turn as the planner gets them; damped least squares from random starts. Peers: the
// published equations (Hawkins 2013) written down plainly, all eight branches without limits or check; one descent of
// Ceres from the middle of the limits.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <benchmark/benchmark.h>
#include <ceres/ceres.h>

#include "core/rng.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/load_robot.hpp"
#include "robot/ur_kinematics.hpp"

namespace {

using namespace opponens;
using Eigen::Isometry3d;
using robot::Vector6d;

constexpr std::size_t kPoses = 4096;

struct Arm {
  robot::RobotModel model{robot::load_robot(OPPONENS_SOURCE_DIR "/models/ur5_allegro/ur5_allegro_right.yaml")};
  robot::KinematicChain palm = robot::kinematic_chain(model, model.arm(), model.palm());
  robot::KinematicChain flange = robot::kinematic_chain(model, model.arm(), model.link_index("tool0"));
  std::vector<Isometry3d> palm_poses;
  std::vector<Isometry3d> flange_poses;

  Arm() {
    Rng rng(1);
    for (std::size_t i = 0; i < kPoses; ++i) {
      Vector6d q;
      for (int j = 0; j < 6; ++j) q[j] = rng.uniform(palm.lower[j], palm.upper[j]);
      palm_poses.push_back(robot::tip_pose(palm, q));
      flange_poses.push_back(robot::tip_pose(flange, q));
    }
  }
};

const Arm& arm() {
  static const Arm one;
  return one;
}

/// Runs solve(i), which returns a number of solutions, over the poses in turn.
template <typename Solve>
void over_poses(benchmark::State& state, const Solve& solve) {
  std::size_t next = 0;
  std::int64_t solutions = 0;
  for (auto _ : state) {
    solutions += solve(next);
    next = (next + 1) % kPoses;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["solutions"] = static_cast<double>(solutions) / static_cast<double>(state.iterations());
  state.counters["solutions/s"] = benchmark::Counter(static_cast<double>(solutions), benchmark::Counter::kIsRate);
}

void ours_branches(benchmark::State& state) {
  const auto solver = robot::UrKinematics::of(arm().palm).value();
  over_poses(state, [&](std::size_t i) {
    const robot::ArmBranches found = solver.branches(arm().palm_poses[i]);
    benchmark::DoNotOptimize(found);
    return found.count;
  });
}

/// A few digits short of parallel and perpendicular, so that every branch goes through defect correction.
void ours_branches_of_an_inexact_arm(benchmark::State& state) {
  robot::KinematicChain inexact = arm().palm;
  Rng rng(2);
  for (auto& joint : inexact.joints) {
    const Eigen::Vector3d axis(rng.normal(), rng.normal(), rng.normal());
    joint.X_PJ.rotate(Eigen::AngleAxisd(1e-9, axis.normalized()));
  }
  const auto solver = robot::UrKinematics::of(inexact).value();
  over_poses(state, [&](std::size_t i) { return solver.branches(arm().palm_poses[i]).count; });
}

void ours_with_all_turns(benchmark::State& state) {
  const auto solve = robot::make_inverse_kinematics(arm().model);
  over_poses(state, [&](std::size_t i) { return solve(arm().palm_poses[i], {})->size(); });
}

void ours_one_descent(benchmark::State& state) {
  const Eigen::VectorXd middle = 0.5 * (arm().palm.lower + arm().palm.upper);
  over_poses(state, [&](std::size_t i) {
    return robot::descend(arm().palm, {arm().palm_poses[i]}, middle, 100, 1e-10).residual < 1e-10 ? 1 : 0;
  });
}

/// Hawkins 2013, equations for theta 1, 5, 6, 3, 2, 4, with a2, a3 < 0 as published. Flange pose to angles.
int hawkins(const Isometry3d& T, std::array<Vector6d, 8>& q) {
  constexpr double d1 = 0.089159, a2 = -0.425, a3 = -0.39225, d4 = 0.10915, d5 = 0.09465, d6 = 0.0823;
  const auto& M = T.matrix();
  int count = 0;
  const Eigen::Vector3d p05 = T * Eigen::Vector3d(0, 0, -d6);
  const double radius = std::hypot(p05.x(), p05.y());
  if (radius < d4) return 0;
  for (const double shoulder : {1.0, -1.0}) {
    const double t1 = std::atan2(p05.y(), p05.x()) + shoulder * std::acos(d4 / radius) + 0.5 * std::numbers::pi;
    const double s1 = std::sin(t1), c1 = std::cos(t1);
    const double c5 = (M(0, 3) * s1 - M(1, 3) * c1 - d4) / d6;
    if (std::abs(c5) > 1.0) continue;
    for (const double wrist : {1.0, -1.0}) {
      const double t5 = wrist * std::acos(c5);
      const double s5 = std::sin(t5);
      const double t6 = std::atan2((-M(0, 1) * s1 + M(1, 1) * c1) / s5, (M(0, 0) * s1 - M(1, 0) * c1) / s5);
      const double s6 = std::sin(t6), c6 = std::cos(t6);
      // T14 = T01^-1 T06 (T45 T56)^-1; its x and y hold the elbow's plane.
      const double x04x = -s5 * (M(0, 2) * c1 + M(1, 2) * s1) -
                          c5 * (s6 * (M(0, 1) * c1 + M(1, 1) * s1) - c6 * (M(0, 0) * c1 + M(1, 0) * s1));
      const double x04y = c5 * (M(2, 0) * c6 - M(2, 1) * s6) - M(2, 2) * s5;
      const double p13x = d5 * (s6 * (M(0, 0) * c1 + M(1, 0) * s1) + c6 * (M(0, 1) * c1 + M(1, 1) * s1)) -
                          d6 * (M(0, 2) * c1 + M(1, 2) * s1) + M(0, 3) * c1 + M(1, 3) * s1;
      const double p13y = M(2, 3) - d1 - d6 * M(2, 2) + d5 * (M(2, 1) * c6 + M(2, 0) * s6);
      const double c3 = (p13x * p13x + p13y * p13y - a2 * a2 - a3 * a3) / (2.0 * a2 * a3);
      if (std::abs(c3) > 1.0) continue;
      for (const double elbow : {1.0, -1.0}) {
        const double t3 = elbow * std::acos(c3);
        const double A = a2 + a3 * c3;
        const double B = a3 * std::sin(t3);
        const double t2 = std::atan2(p13y * A - p13x * B, p13x * A + p13y * B);
        const double t4 = std::atan2(x04y, x04x) - t2 - t3;
        q[static_cast<std::size_t>(count++)] << t1, t2, t3, t4, t5, t6;
      }
    }
  }
  return count;
}

void hawkins_equations(benchmark::State& state) {
  std::array<Vector6d, 8> q;
  double worst = 0.0;  // that it is the same arm
  for (const Isometry3d& pose : arm().flange_poses) {
    for (int i = 0, count = hawkins(pose, q); i < count; ++i) {
      const Isometry3d reached = robot::tip_pose(arm().flange, q[static_cast<std::size_t>(i)]);
      worst = std::max(worst, (reached.matrix() - pose.matrix()).cwiseAbs().maxCoeff());
    }
  }
  over_poses(state, [&](std::size_t i) {
    const int count = hawkins(arm().flange_poses[i], q);
    benchmark::DoNotOptimize(q);
    return count;
  });
  state.counters["largest_error"] = worst;
}

class PoseCost : public ceres::SizedCostFunction<6, 6> {
 public:
  explicit PoseCost(const Isometry3d& goal) : goal_(goal) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Vector6d> q(parameters[0]);
    Eigen::Matrix<double, 6, Eigen::Dynamic> J;
    Eigen::Map<Vector6d>(residuals, 6) = robot::pose_error(robot::tip_pose(arm().palm, q, J), goal_);
    if (jacobians && jacobians[0]) {
      Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> J_rows(jacobians[0]);
      J_rows = -J;
    }
    return true;
  }

 private:
  const Isometry3d& goal_;
};

void ceres_one_descent(benchmark::State& state) {
  over_poses(state, [&](std::size_t i) {
    Eigen::VectorXd q = 0.5 * (arm().palm.lower + arm().palm.upper);
    ceres::Problem problem;
    problem.AddResidualBlock(new PoseCost(arm().palm_poses[i]), nullptr, q.data());  // the problem owns it
    for (int j = 0; j < 6; ++j) {
      problem.SetParameterLowerBound(q.data(), j, arm().palm.lower[j]);
      problem.SetParameterUpperBound(q.data(), j, arm().palm.upper[j]);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = 100;
    options.function_tolerance = 0.0;
    options.gradient_tolerance = 1e-11;
    options.parameter_tolerance = 0.0;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return std::sqrt(2.0 * summary.final_cost) < 1e-10 ? 1 : 0;
  });
}

BENCHMARK(ours_branches);
BENCHMARK(ours_branches_of_an_inexact_arm);
BENCHMARK(ours_with_all_turns);
BENCHMARK(hawkins_equations);
BENCHMARK(ours_one_descent);
BENCHMARK(ceres_one_descent);

}  // namespace
