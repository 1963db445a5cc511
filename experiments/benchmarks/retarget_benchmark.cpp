// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Retargeting of an 84-sample recording to the Allegro by fingertips: the whole recording as one sparse problem, beside
// the same sum sample by sample, each with dense QR and started where the last ended (no smoothness over time, and so
// an easier problem). Both stay inside the joint limits. The counter rms_mm is the fingertips' residual.
#include <cmath>
#include <numbers>

#include <benchmark/benchmark.h>
#include <ceres/ceres.h>

#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "robot/retarget.hpp"
#include "tests/robot/swinging_hand.hpp"

namespace {

using namespace opponens;

constexpr int kSamples = 84;
constexpr double kCentimetres = 100.0;

struct Hands {
  robot::RobotModel human{robot::load_hand(OPPONENS_SOURCE_DIR "/models/human_hand/human_hand.yaml")};
  robot::RobotModel hand{robot::load_hand(OPPONENS_SOURCE_DIR "/models/ur5_allegro/allegro_right.yaml")};
  robot::HandMapping mapping = robot::load_hand_mapping(OPPONENS_SOURCE_DIR "/models/ur5_allegro/allegro_right.yaml");
  robot::HandAlignment alignment = robot::align_hands(human, hand, mapping).value();
};

/// The human hand swings through the middle of its ranges.
Demonstration swing(const robot::RobotModel& human) { return robot::swing(human, 0.2, 0.7, kSamples); }

void whole_recording_sparse(benchmark::State& state) {
  const Hands hands;
  const Demonstration recording = swing(hands.human);
  robot::RetargetSettings settings = robot::default_settings(robot::MappingKind::fingertip);
  settings.alignment = hands.alignment;
  double rms = 0.0;
  for (auto _ : state) {
    const auto mapped = robot::retarget(recording, {}, hands.human, hands.hand, hands.mapping, settings);
    rms = mapped->tip_residual_rms;
  }
  state.counters["rms_mm"] = 1e3 * rms;
}

/// All fingertips of one sample, and the pull to the posture of the joint mapping.
class SampleCost : public ceres::CostFunction {
 public:
  SampleCost(const robot::RobotModel& hand, Eigen::Matrix3Xd targets, Eigen::VectorXd rest, double weight)
      : hand_(hand), targets_(std::move(targets)), rest_(std::move(rest)), weight_(weight) {
    mutable_parameter_block_sizes()->push_back(hand.dof());
    set_num_residuals(static_cast<int>(targets_.size()) + hand.dof());
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const int n = hand_.dof();
    const Eigen::Map<const Eigen::VectorXd> q(parameters[0], n);
    const auto X = hand_.link_poses(q);
    const auto& tips = hand_.description().tips;
    Eigen::Map<Eigen::VectorXd>(residuals + targets_.size(), n) = weight_ * (q - rest_);
    const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
    for (std::size_t f = 0; f < tips.size(); ++f) {
      const Eigen::Vector3d p = X[static_cast<std::size_t>(tips[f].link)] * tips[f].p_L;
      Eigen::Map<Eigen::Vector3d> rows(residuals + 3 * f);
      rows = kCentimetres * (p - targets_.col(static_cast<Eigen::Index>(f)));
      if (!wanted) continue;
      Eigen::Map<RowMajor>(jacobians[0] + 3 * f * static_cast<std::size_t>(n), 3, n) =
          kCentimetres * hand_.point_jacobian(X, tips[f].link, p);
    }
    if (wanted) {
      Eigen::Map<RowMajor>(jacobians[0] + targets_.size() * n, n, n) = weight_ * Eigen::MatrixXd::Identity(n, n);
    }
    return true;
  }

 private:
  const robot::RobotModel& hand_;
  Eigen::Matrix3Xd targets_;
  Eigen::VectorXd rest_;
  double weight_;
};

void sample_by_sample_dense(benchmark::State& state) {
  const Hands hands;
  const Demonstration recording = swing(hands.human);
  robot::RetargetSettings settings = robot::default_settings(robot::MappingKind::joint);
  settings.alignment = hands.alignment;
  const double weight = robot::default_settings(robot::MappingKind::fingertip).rest;
  double squares = 0.0;
  for (auto _ : state) {
    const auto start = robot::retarget(recording, {}, hands.human, hands.hand, hands.mapping, settings);
    const Eigen::MatrixXd& rest = start->demonstration.q_h;
    Eigen::VectorXd q = rest.row(0).transpose();
    squares = 0.0;
    for (Eigen::Index t = 0; t < kSamples; ++t) {
      const auto X = hands.human.link_poses(recording.q_h.row(t).transpose());
      Eigen::Matrix3Xd targets(3, 4);
      const auto& tips = hands.hand.description().tips;
      for (std::size_t f = 0; f < tips.size(); ++f) {
        for (const auto& tip : hands.human.description().tips) {
          if (tip.name != hands.mapping.fingertips.at(tips[f].name)) continue;
          targets.col(static_cast<Eigen::Index>(f)) =
              hands.alignment.offset +
              hands.alignment.scale * hands.mapping.R_robot_human * (X[static_cast<std::size_t>(tip.link)] * tip.p_L);
        }
      }
      const SampleCost cost(hands.hand, targets, rest.row(t).transpose(), weight);
      ceres::Problem::Options owner;
      owner.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
      ceres::Problem problem(owner);
      problem.AddResidualBlock(const_cast<SampleCost*>(&cost), nullptr, q.data());  // Ceres takes no const
      for (int i = 0; i < hands.hand.dof(); ++i) {
        problem.SetParameterLowerBound(q.data(), i, hands.hand.lower()[i]);
        problem.SetParameterUpperBound(q.data(), i, hands.hand.upper()[i]);
      }
      ceres::Solver::Options options;
      options.linear_solver_type = ceres::DENSE_QR;
      options.logging_type = ceres::SILENT;
      options.num_threads = 1;
      options.function_tolerance = 1e-5;
      ceres::Solver::Summary summary;
      ceres::Solve(options, &problem, &summary);
      const auto Y = hands.hand.link_poses(q);
      for (std::size_t f = 0; f < tips.size(); ++f) {
        squares += (Y[static_cast<std::size_t>(tips[f].link)] * tips[f].p_L - targets.col(static_cast<Eigen::Index>(f)))
                       .squaredNorm();
      }
    }
  }
  state.counters["rms_mm"] = 1e3 * std::sqrt(squares / (4.0 * kSamples));
}

BENCHMARK(whole_recording_sparse)->Unit(benchmark::kMillisecond);
BENCHMARK(sample_by_sample_dense)->Unit(benchmark::kMillisecond);

}  // namespace
