// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/precision_solver.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <nlopt.h>
#include <Eigen/Dense>

#include "core/require.hpp"

namespace opponens::grasp {
namespace {

constexpr double kFarthestShift = 0.1;  // m
constexpr double kFarthestTurn = 1.0;   // rad
constexpr double kFeasible = 0.05;      // cm, 0.1 rad: the exact distances are closed in afterwards
constexpr double kClosed = 2e-6;        // m
constexpr int kNewtonSteps = 12;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct EndOptimizer {
  void operator()(nlopt_opt_s* optimizer) const { nlopt_destroy(optimizer); }
};

struct NloptRun {
  PrecisionRun& run;
  nlopt_opt_s* optimizer;
  /// nullptr also stops the optimiser.
  const PrecisionValue* value(unsigned n, const double* x, bool slopes) const {
    const PrecisionValue* value = run.visit(Eigen::Map<const Eigen::VectorXd>(x, n), slopes);
    if (value == nullptr) nlopt_force_stop(optimizer);
    return value;
  }
};

double nlopt_quality(unsigned n, const double* x, double* slope, void* data) {
  const PrecisionValue* value = static_cast<NloptRun*>(data)->value(n, x, slope != nullptr);
  if (value == nullptr) return kInfinite;
  if (slope != nullptr) Eigen::Map<Eigen::VectorXd>(slope, n) = -value->quality_slope;
  return -value->quality;
}

/// Copies values and row-major slopes out; zero where there are none.
void put(const Eigen::VectorXd* values, const SlopeRows* slopes, unsigned count, unsigned n, double* result,
         double* slope) {
  if (values == nullptr) {
    Eigen::Map<Eigen::VectorXd>(result, count).setZero();
    if (slope != nullptr) Eigen::Map<Eigen::VectorXd>(slope, static_cast<Eigen::Index>(count) * n).setZero();
    return;
  }
  Eigen::Map<Eigen::VectorXd>(result, count) = *values;
  if (slope != nullptr) Eigen::Map<SlopeRows>(slope, count, n) = *slopes;
}

void nlopt_gaps(unsigned count, double* result, unsigned n, const double* x, double* slope, void* data) {
  const PrecisionValue* value = static_cast<NloptRun*>(data)->value(n, x, slope != nullptr);
  put(value ? &value->gaps : nullptr, value ? &value->gap_slopes : nullptr, count, n, result, slope);
}

void nlopt_excess(unsigned count, double* result, unsigned n, const double* x, double* slope, void* data) {
  const PrecisionValue* value = static_cast<NloptRun*>(data)->value(n, x, slope != nullptr);
  put(value ? &value->excess : nullptr, value ? &value->excess_slopes : nullptr, count, n, result, slope);
}

}  // namespace

PrecisionRun::PrecisionRun(PrecisionProblem& problem, const HandSeed& seed, const SynergyBox& box)
    : problem_(problem), quality_(-kInfinite), violation_(kInfinite) {
  require(seed.X_OH.matrix().allFinite() && seed.y.allFinite(), "PrecisionRun: the seed must be finite");
  require(seed.y.size() == box.half_width.size(), "PrecisionRun: the seed must have the box's synergies");
  problem.place(seed);
  const int n = problem.size();
  upper_.resize(n);
  upper_ << Eigen::Vector3d::Constant(kFarthestShift / kChartPosition), Eigen::Vector3d::Constant(kFarthestTurn),
      box.half_width;
  lower_ = -upper_;
  start_ = Eigen::VectorXd::Zero(n);
  start_.tail(n - 6) = seed.y.cwiseMax(-box.half_width).cwiseMin(box.half_width);
}

const PrecisionValue* PrecisionRun::visit(const Eigen::VectorXd& x, bool slopes) {
  if (!x.allFinite()) return nullptr;
  if (last_.size() == x.size() && last_ == x && (last_has_slopes_ || !slopes)) return last_value_;
  const PrecisionValue& value = problem_.evaluate(x, slopes);
  last_ = x;
  last_has_slopes_ = slopes;
  const double violation = value.violation();
  const bool finite =
      std::isfinite(value.quality) && std::isfinite(violation) &&
      (!slopes || (value.quality_slope.allFinite() && value.gap_slopes.allFinite() && value.excess_slopes.allFinite()));
  last_value_ = finite ? &value : nullptr;
  if (!finite) return nullptr;
  if (violation <= kFeasible && value.quality > quality_) {
    quality_ = value.quality;
    feasible_ = x;
  }
  if (violation < violation_) {
    violation_ = violation;
    nearest_ = x;
  }
  return last_value_;
}

std::optional<Eigen::VectorXd> PrecisionRun::best() const {
  if (feasible_.size() > 0) return feasible_;
  if (nearest_.size() > 0) return nearest_;
  return std::nullopt;
}

void solve(PrecisionRun& run, PrecisionProblem& problem, PrecisionSolver solver, int max_evaluations) {
  const auto n = static_cast<unsigned>(problem.size());
  const std::unique_ptr<nlopt_opt_s, EndOptimizer> optimizer(
      nlopt_create(solver == PrecisionSolver::slsqp ? NLOPT_LD_SLSQP : NLOPT_LN_COBYLA, n));
  NloptRun data{run, optimizer.get()};
  nlopt_set_min_objective(optimizer.get(), nlopt_quality, &data);
  const std::vector<double> gap_tolerance(static_cast<std::size_t>(problem.gaps()), 1e-3);
  const std::vector<double> excess_tolerance(static_cast<std::size_t>(problem.excesses()), 1e-3);
  nlopt_add_equality_mconstraint(optimizer.get(), static_cast<unsigned>(problem.gaps()), nlopt_gaps, &data,
                                 gap_tolerance.data());
  nlopt_add_inequality_mconstraint(optimizer.get(), static_cast<unsigned>(problem.excesses()), nlopt_excess, &data,
                                   excess_tolerance.data());
  nlopt_set_lower_bounds(optimizer.get(), run.lower().data());
  nlopt_set_upper_bounds(optimizer.get(), run.upper().data());
  nlopt_set_maxeval(optimizer.get(), max_evaluations);
  nlopt_set_ftol_abs(optimizer.get(), 1e-4);
  nlopt_set_xtol_abs1(optimizer.get(), 1e-5);
  if (solver == PrecisionSolver::cobyla) nlopt_set_initial_step1(optimizer.get(), 0.1);
  Eigen::VectorXd x = run.start();
  double cost = kInfinite;
  nlopt_optimize(optimizer.get(), x.data(), &cost);  // code, x and cost are not trusted: the run has judged each point
}

double close_gaps(PrecisionProblem& problem, const PrecisionRun& run, Eigen::VectorXd& x) {
  const Eigen::Index n = x.size();
  SlopeRows slopes;
  double largest = kInfinite;
  for (int step = 0; step <= kNewtonSteps; ++step) {
    const std::vector<TipTouch> touches = problem.touches(x, slopes);
    Eigen::VectorXd gaps(static_cast<Eigen::Index>(touches.size()));
    for (std::size_t i = 0; i < touches.size(); ++i) gaps[static_cast<Eigen::Index>(i)] = touches[i].gap;
    largest = gaps.cwiseAbs().maxCoeff();
    if (!std::isfinite(largest) || largest <= kClosed || step == kNewtonSteps) break;
    SlopeRows free = slopes;
    Eigen::VectorXd change = Eigen::VectorXd::Zero(n);
    for (int held = -1; held != 0;) {  // variables that the step drives out of their bounds stay
      Eigen::MatrixXd normal = free * free.transpose();
      normal.diagonal().array() += 1e-12;
      change = -free.transpose() * normal.ldlt().solve(gaps);
      held = 0;
      for (Eigen::Index i = 0; i < n; ++i) {
        const bool out = (x[i] >= run.upper()[i] && change[i] > 0.0) || (x[i] <= run.lower()[i] && change[i] < 0.0);
        if (!out || free.col(i).isZero(0.0)) continue;
        free.col(i).setZero();
        ++held;
      }
    }
    x = (x + change).cwiseMax(run.lower()).cwiseMin(run.upper());
  }
  return largest;
}

}  // namespace opponens::grasp
