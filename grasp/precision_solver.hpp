// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "grasp/precision_problem.hpp"

namespace opponens::grasp {

enum class PrecisionSolver {
  slsqp,   ///< sequential quadratic programming with the problem's slopes (Kraft 1988)
  cobyla,  ///< linear models, no slopes (Powell 1994): a check; needs many times the evaluations
};

/// The run of one optimiser over one problem. Every point that it visits is judged here, so that neither its return
/// code nor its last point has to be trusted: NLopt is known to report success with NaN.
class PrecisionRun {
 public:
  /// x around the seed: |t| <= 10 cm, |w_i| <= 1 rad, y in the box.
  PrecisionRun(PrecisionProblem& problem, const HandSeed& seed, const SynergyBox& box);

  const Eigen::VectorXd& start() const { return start_; }
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }

  /// The problem at x, remembered: the same x again costs nothing. nullptr where x is not finite, or its value is not.
  const PrecisionValue* visit(const Eigen::VectorXd& x, bool slopes);

  /// Of the points visited the one with the best quality among those that violate nothing by more than 0.5 mm
  /// (0.005 rad); where there is none, the one that violates least. nullopt: none was finite.
  std::optional<Eigen::VectorXd> best() const;

 private:
  PrecisionProblem& problem_;
  Eigen::VectorXd start_, lower_, upper_;
  Eigen::VectorXd last_;
  bool last_has_slopes_ = false;
  const PrecisionValue* last_value_ = nullptr;
  Eigen::VectorXd feasible_, nearest_;
  double quality_, violation_;
};

/// Maximises the problem's quality from the seed; at most max_evaluations. Deterministic.
void solve(PrecisionRun& run, PrecisionProblem& problem, PrecisionSolver solver, int max_evaluations);

/// Newton steps on the exact distances, least change of x first (minimum norm), variables at a bound held: brings every
/// tip to the surface. x: in and out. Returns the largest |gap|, m.
double close_gaps(PrecisionProblem& problem, const PrecisionRun& run, Eigen::VectorXd& x);

}  // namespace opponens::grasp
