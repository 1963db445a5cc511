// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/phase_transition.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "analysis/statistics.hpp"
#include "analysis/subspace.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

/// log|S| and, when asked for, d'S^-1 d, reusing one factorisation's memory over all splits.
class SplitCosts {
 public:
  explicit SplitCosts(Eigen::Index n) : factor_(n) {}

  bool factorise(const Eigen::MatrixXd& s) {
    factor_.compute(s);
    return factor_.info() == Eigen::Success && (factor_.matrixLLT().diagonal().array() > 0.0).all();
  }
  double log_determinant() const { return 2.0 * factor_.matrixLLT().diagonal().array().log().sum(); }
  double mahalanobis(const Eigen::VectorXd& d) const { return factor_.matrixL().solve(d).squaredNorm(); }

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

/// Moments of the samples [0, t) and [t, T) as t grows, of rows centred on the whole recording's mean.
class PrefixMoments {
 public:
  explicit PrefixMoments(const Eigen::MatrixXd& centred)
      : total_(centred.transpose() * centred),
        total_sum_(centred.colwise().sum().transpose()),
        before_(Eigen::MatrixXd::Zero(centred.cols(), centred.cols())),
        before_sum_(Eigen::VectorXd::Zero(centred.cols())),
        rows_(static_cast<double>(centred.rows())) {}

  void add(const Eigen::Ref<const Eigen::VectorXd>& x) {
    before_.noalias() += x * x.transpose();
    before_sum_ += x;
    count_ += 1.0;
  }
  double count_before() const { return count_; }
  double count_after() const { return rows_ - count_; }
  void split(Eigen::MatrixXd& before, Eigen::MatrixXd& after, Eigen::VectorXd& difference) const {
    const Eigen::VectorXd mean_before = before_sum_ / count_before();
    const Eigen::VectorXd mean_after = (total_sum_ - before_sum_) / count_after();
    before.noalias() = before_ / count_before() - mean_before * mean_before.transpose();
    after.noalias() = (total_ - before_) / count_after() - mean_after * mean_after.transpose();
    difference = mean_before - mean_after;
  }

 private:
  Eigen::MatrixXd total_;
  Eigen::VectorXd total_sum_;
  Eigen::MatrixXd before_;
  Eigen::VectorXd before_sum_;
  double rows_;
  double count_ = 0.0;
};

void check(const Demonstration& demonstration, const TransitionSettings& settings) {
  require(demonstration.q_h.rows() >= 1 && demonstration.q_h.rows() == demonstration.time.size() &&
              demonstration.q_h.cols() == static_cast<Eigen::Index>(demonstration.joint_names.size()),
          "transition: recording " + demonstration.id + ": time, joint_names and q_h differ in size");
  require(std::isfinite(settings.resolution) && settings.resolution >= 0.0, "transition: resolution must be >= 0 rad");
  require(!settings.min_window || *settings.min_window >= 2, "transition: min_window must be >= 2 samples");
}

Eigen::MatrixXd columns(const Eigen::MatrixXd& q, const std::vector<int>& kept) {
  Eigen::MatrixXd result(q.rows(), static_cast<Eigen::Index>(kept.size()));
  for (Eigen::Index j = 0; j < result.cols(); ++j) result.col(j) = q.col(kept[static_cast<std::size_t>(j)]);
  return result;
}

/// Fills both curves; false when a covariance is singular (only possible without a ridge).
bool fill_costs(const Eigen::MatrixXd& centred, const TransitionSettings& settings, TransitionCurves& curves) {
  const Eigen::Index n = centred.cols();
  const double ridge = settings.resolution * settings.resolution;
  const double power =
      settings.normaliser == Normaliser::printed ? 1.0 + 2.0 * static_cast<double>(n) : static_cast<double>(n);
  const double constant = 0.5 * power * std::log(2.0 * std::numbers::pi);
  const Eigen::MatrixXd samples = centred.transpose();
  PrefixMoments prefix(centred);
  SplitCosts costs(n);
  Eigen::MatrixXd before(n, n);
  Eigen::MatrixXd after(n, n);
  Eigen::MatrixXd s(n, n);
  Eigen::VectorXd difference(n);
  for (Eigen::Index i = 0; i < curves.first - 1; ++i) prefix.add(samples.col(i));
  for (Eigen::Index i = 0; i < curves.log_likeness.size(); ++i) {
    prefix.add(samples.col(curves.first + i - 1));
    prefix.split(before, after, difference);
    s = before + after;
    s.diagonal().array() += ridge;
    if (!costs.factorise(s)) return false;
    curves.log_likeness[i] = -0.5 * (costs.mahalanobis(difference) + costs.log_determinant()) - constant;
    before.diagonal().array() += ridge;
    after.diagonal().array() += ridge;
    if (!costs.factorise(before)) return false;
    curves.changepoint[i] = prefix.count_before() * costs.log_determinant();
    if (!costs.factorise(after)) return false;
    curves.changepoint[i] += prefix.count_after() * costs.log_determinant();
  }
  return true;
}

}  // namespace

Result<TransitionCurves> transition_curves(const Demonstration& demonstration, const TransitionSettings& settings) {
  check(demonstration, settings);
  const Eigen::Index n = demonstration.q_h.cols();
  const SampleStatistics whole = moments(demonstration.q_h);
  const EffectiveSubspace subspace =
      effective_subspace(whole.covariance, Eigen::VectorXd::Constant(n, settings.resolution));
  if (subspace.kept.empty()) {
    return failure(FailureCode::degenerate, "recording " + demonstration.id + ": no channel moves more than the " +
                                                "sensor resolution of " + std::to_string(settings.resolution) + " rad");
  }
  const auto samples = static_cast<int>(demonstration.q_h.rows());
  const int window = settings.min_window.value_or(subspace.dof() + 1);
  if (samples < 2 * window) {
    return failure(FailureCode::too_few_samples, "recording " + demonstration.id + ": " + std::to_string(samples) +
                                                     " samples, a transition needs " + std::to_string(window) +
                                                     " on each side");
  }
  TransitionCurves curves;
  curves.first = window;
  curves.log_likeness.resize(samples - 2 * window + 1);
  curves.changepoint.resize(curves.log_likeness.size());
  curves.kept = subspace.kept;
  curves.dropped_channels = names_at(demonstration.joint_names, subspace.dropped);
  const Eigen::MatrixXd centred = columns(demonstration.q_h.rowwise() - whole.mean.transpose(), subspace.kept);
  if (!fill_costs(centred, settings, curves)) {
    return failure(FailureCode::degenerate, "recording " + demonstration.id +
                                                ": a window's covariance is singular; set a sensor resolution > 0");
  }
  return curves;
}

Transition transition(const Demonstration& demonstration, const TransitionCurves& curves, TransitionRule rule) {
  const Eigen::VectorXd& cost = rule == TransitionRule::likeness ? curves.log_likeness : curves.changepoint;
  require(cost.size() >= 1 && curves.first >= 1 && curves.first + cost.size() <= demonstration.time.size(),
          "transition: the curves are not of this recording");
  const auto best = std::min_element(cost.begin(), cost.end()) - cost.begin();
  Transition result;
  result.index = curves.first + static_cast<int>(best);
  result.time_s = demonstration.time[result.index];
  const double begin = demonstration.time[0];
  const double end = demonstration.time[demonstration.time.size() - 1];
  result.fraction = (result.time_s - begin) / (end - begin);
  result.method = rule;
  return result;
}

}  // namespace opponens::analysis
