// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/phase_transition.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/statistics.hpp"
#include "analysis/subspace.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

/// A Cholesky factor in memory that all splits share, and what is asked of it. Columns of the lower triangle.
class Factor {
 public:
  explicit Factor(Eigen::Index n) : l_(n, n), y_(n) {}

  Eigen::MatrixXd& matrix() { return l_; }  ///< write the lower triangle here, then factorise()

  /// False when the matrix is not positive definite; the factor is then of no use.
  bool factorise() {
    const Eigen::Index n = l_.cols();
    log_determinant_ = 0.0;
    double product = 1.0;  // of pivots whose logarithm is still to be taken: one logarithm for many
    for (Eigen::Index j = 0; j < n; ++j) {
      double* column = l_.col(j).data();
      for (Eigen::Index k = 0; k < j; ++k) subtract(column, l_(j, k), l_.col(k).data(), j, n);
      const double pivot = column[j];
      if (!(pivot > 0.0)) return false;
      if (const double next = product * pivot; next > kSmallProduct && next < kLargeProduct) {
        product = next;
      } else {
        log_determinant_ += std::log(product) + std::log(pivot);
        product = 1.0;
      }
      const double inverse = 1.0 / std::sqrt(pivot);
      for (Eigen::Index i = j; i < n; ++i) column[i] *= inverse;
    }
    log_determinant_ += std::log(product);
    return true;
  }
  double log_determinant() const { return log_determinant_; }
  double mahalanobis(const Eigen::VectorXd& d) {
    const Eigen::Index n = l_.cols();
    y_ = d;
    for (Eigen::Index j = 0; j < n; ++j) {
      y_[j] /= l_(j, j);
      subtract(y_.data(), y_[j], l_.col(j).data(), j + 1, n);
    }
    return y_.squaredNorm();
  }

 private:
  static constexpr double kSmallProduct = 1e-100;
  static constexpr double kLargeProduct = 1e100;

  static void subtract(double* __restrict to, double factor, const double* __restrict from, Eigen::Index begin,
                       Eigen::Index end) {
    for (Eigen::Index i = begin; i < end; ++i) to[i] -= factor * from[i];
  }

  Eigen::MatrixXd l_;
  Eigen::VectorXd y_;
  double log_determinant_ = 0.0;
};

/// Moments of the samples [0, t) and [t, T) as t grows, of rows centred on the whole recording's mean. Lower triangles.
class PrefixMoments {
 public:
  /// x: [n x T], a sample per column.
  explicit PrefixMoments(const Eigen::MatrixXd& x)
      : total_(Eigen::MatrixXd::Zero(x.rows(), x.rows())),
        total_sum_(x.rowwise().sum()),
        before_(total_),
        before_sum_(Eigen::VectorXd::Zero(x.rows())),
        mean_before_(x.rows()),
        mean_after_(x.rows()),
        rows_(static_cast<double>(x.cols())) {
    for (Eigen::Index t = 0; t < x.cols(); ++t) add_square(total_, x.col(t));
  }

  void add(const Eigen::Ref<const Eigen::VectorXd>& x) {
    add_square(before_, x);
    before_sum_ += x;
    count_ += 1.0;
  }
  double count_before() const { return count_; }
  double count_after() const { return rows_ - count_; }
  /// The two covariances and their sum, each with the ridge on its diagonal, and the difference of the means.
  void split(double ridge, Eigen::MatrixXd& before, Eigen::MatrixXd& after, Eigen::MatrixXd& sum,
             Eigen::VectorXd& difference) {
    const double share_before = 1.0 / count_before();
    const double share_after = 1.0 / count_after();
    mean_before_ = before_sum_ * share_before;
    mean_after_ = (total_sum_ - before_sum_) * share_after;
    difference = mean_before_ - mean_after_;
    const Eigen::Index n = mean_before_.size();
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = j; i < n; ++i) {
        const double one = before_(i, j) * share_before - mean_before_[i] * mean_before_[j];
        const double other = (total_(i, j) - before_(i, j)) * share_after - mean_after_[i] * mean_after_[j];
        before(i, j) = one;
        after(i, j) = other;
        sum(i, j) = one + other;
      }
      for (Eigen::MatrixXd* covariance : {&before, &after, &sum}) (*covariance)(j, j) += ridge;
    }
  }

 private:
  static void add_square(Eigen::MatrixXd& sum, const Eigen::Ref<const Eigen::VectorXd>& x) {
    const Eigen::Index n = x.size();
    for (Eigen::Index j = 0; j < n; ++j) sum.col(j).tail(n - j) += x[j] * x.tail(n - j);
  }

  Eigen::MatrixXd total_;
  Eigen::VectorXd total_sum_;
  Eigen::MatrixXd before_;
  Eigen::VectorXd before_sum_;
  Eigen::VectorXd mean_before_;
  Eigen::VectorXd mean_after_;
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
  PrefixMoments prefix(samples);
  Factor sum(n);
  Factor before(n);
  Factor after(n);
  Eigen::VectorXd difference(n);
  for (Eigen::Index i = 0; i < curves.first - 1; ++i) prefix.add(samples.col(i));
  for (Eigen::Index i = 0; i < curves.log_likeness.size(); ++i) {
    prefix.add(samples.col(curves.first + i - 1));
    prefix.split(ridge, before.matrix(), after.matrix(), sum.matrix(), difference);
    if (!sum.factorise() || !before.factorise() || !after.factorise()) return false;
    curves.log_likeness[i] = -0.5 * (sum.mahalanobis(difference) + sum.log_determinant()) - constant;
    curves.changepoint[i] =
        prefix.count_before() * before.log_determinant() + prefix.count_after() * after.log_determinant();
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
  require(end > begin, "transition: recording " + demonstration.id + ": time does not increase");
  result.fraction = (result.time_s - begin) / (end - begin);
  result.method = rule;
  return result;
}

}  // namespace opponens::analysis
