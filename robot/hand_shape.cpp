// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/hand_shape.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "robot/fingertip_fit.hpp"
#include "robot/three_digits.hpp"

namespace opponens::robot {

namespace {

/// One sample, the tips' plain distances. Failure: no such tip.
Result<FingertipFit> problem(const RobotModel& hand, const std::vector<TipPosition>& tips) {
  FingertipFit fit;
  fit.cylindrical = false;
  fit.tolerance = 1e-12;
  std::set<int> joints;
  for (const TipPosition& wanted : tips) {
    require(wanted.p_H.allFinite(), "the position of tip '" + wanted.tip + "' is not finite");
    const auto& known = hand.description().tips;
    const auto tip = std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.name == wanted.tip; });
    if (tip == known.end()) return failure(FailureCode::not_found, "the hand has no tip '" + wanted.tip + "'");
    fit.targets.push_back({finger_of(hand, *tip), {}, {}, wanted.p_H});
    joints.insert(fit.targets.back().finger.moved_by.begin(), fit.targets.back().finger.moved_by.end());
  }
  fit.fitted.assign(joints.begin(), joints.end());
  return fit;
}

Eigen::VectorXd misses(const RobotModel& hand, const FingertipFit& fit, const Eigen::VectorXd& q) {
  Eigen::VectorXd miss(static_cast<Eigen::Index>(fit.targets.size()));
  for (std::size_t f = 0; f < fit.targets.size(); ++f) {
    const TipTarget& target = fit.targets[f];
    miss[static_cast<Eigen::Index>(f)] = (tip_path(hand, target.finger, q) - target.path).norm();
  }
  return miss;
}

}  // namespace

Result<HandShape> shape_hand(const RobotModel& hand, const std::vector<TipPosition>& tips, const Eigen::VectorXd& start,
                             const HandShapeSettings& settings) {
  require(start.size() == hand.dof() && start.allFinite(), "shape_hand: start is no configuration of this robot");
  require(!tips.empty() && settings.restarts >= 0 && settings.max_iterations > 0 && settings.tolerance > 0.0,
          "shape_hand: it needs tips, iterations and a tolerance");
  Result<FingertipFit> fit = problem(hand, tips);
  if (!fit) return tl::make_unexpected(fit.error());
  RetargetSettings solver;
  solver.rest = solver.velocity = solver.acceleration = 0.0;
  solver.max_iterations = settings.max_iterations;
  Rng rng = stream(settings.seed, "hand shape");
  HandShape best{start, Eigen::VectorXd::Constant(1, std::numeric_limits<double>::infinity())};
  bool all_converged = true;
  for (int i = 0; i == 0 || (i <= settings.restarts && best.miss.maxCoeff() > settings.tolerance); ++i) {
    Eigen::MatrixXd q = hand.clip(start);
    for (const int joint : fit->fitted) {
      if (i > 0) q(joint) = rng.uniform(hand.lower()[joint], hand.upper()[joint]);
    }
    fit->rest = q(fit->fitted, Eigen::all);
    const auto fitted = fit_fingertips(hand, *fit, solver, q);
    if (!fitted) return tl::make_unexpected(fitted.error());
    all_converged = all_converged && fitted->converged;
    const Eigen::VectorXd miss = misses(hand, *fit, q);
    if (miss.maxCoeff() < best.miss.maxCoeff()) best = {q, miss};
  }
  if (best.miss.maxCoeff() <= settings.tolerance) return best;
  return failure(all_converged ? FailureCode::out_of_reach : FailureCode::not_converged,
                 "no hand shape brings all tips to their positions; the nearest misses one by " +
                     three_digits(best.miss.maxCoeff()) + " m");
}

}  // namespace opponens::robot
