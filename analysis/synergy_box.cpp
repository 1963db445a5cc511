// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/synergy_box.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <boost/math/special_functions/erf.hpp>

#include "analysis/pca.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

void check_fraction(double value, const char* name) {
  require(value > 0.0 && value < 1.0,
          [&] { return std::string(name) + " must be a fraction in (0, 1), is " + std::to_string(value); });
}

void check_point(const SynergyBox& box, const Eigen::VectorXd& q) {
  require(q.size() == box.center.size() && box.scale.size() == box.center.size(),
          "synergy box: the configuration has " + std::to_string(q.size()) + " joints, the box " +
              std::to_string(box.center.size()));
}

Eigen::VectorXd joined(const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
  Eigen::VectorXd both(first.size() + second.size());
  both << first, second;
  return both;
}

}  // namespace

double axis_probability(double alpha, BoxRoot root, int n, int k) {
  check_fraction(alpha, "alpha");
  require(n >= 1 && k >= 1, "synergy box: n and k must be >= 1");
  switch (root) {
    case BoxRoot::n:
      return std::pow(1.0 - alpha, 1.0 / n);
    case BoxRoot::k:
      return std::pow(1.0 - alpha, 1.0 / k);
    case BoxRoot::literal:
      return std::sqrt(1.0 - alpha);
  }
  require(false, "synergy box: unknown root");
  return 0.0;
}

Eigen::VectorXd box_half_width(const Eigen::VectorXd& variance, double alpha, BoxRoot root, int n, int k) {
  require((variance.array() >= 0.0).all(), "box_half_width: a variance is negative");
  const double deviations = std::numbers::sqrt2 * boost::math::erf_inv(axis_probability(alpha, root, n, k));
  return deviations * variance.cwiseSqrt();
}

int synergies_needed(const Eigen::VectorXd& variance, double beta) {
  check_fraction(beta, "beta");
  const Eigen::VectorXd share = cumulative_variance(variance);
  int k = 1;
  while (k < share.size() && share[k - 1] < 1.0 - beta) ++k;
  return k;
}

SynergyBox make_box(const SynergyBasis& basis, const Eigen::VectorXd& scale, double alpha, double beta, BoxRoot root,
                    int dof_effective) {
  require(scale.size() == basis.mean.size(), "make_box: scale and basis differ in size");
  const int k = synergies_needed(basis.variance, beta);
  SynergyBox box;
  box.center = basis.mean;
  box.axes = basis.axes.leftCols(k);
  box.half_width = box_half_width(basis.variance, alpha, root, dof_effective, k).head(k);
  box.scale = scale;
  box.alpha = alpha;
  box.beta = beta;
  return box;
}

SynergyBox product_box(const std::vector<SynergyBox>& boxes) {
  require(!boxes.empty(), "product_box: there is no box");
  SynergyBox product = boxes.front();
  for (auto box = boxes.begin() + 1; box != boxes.end(); ++box) {
    const Eigen::Index n = product.center.size();
    const Eigen::Index k = product.half_width.size();
    SynergyBox both;
    both.center = joined(product.center, box->center);
    both.axes = Eigen::MatrixXd::Zero(n + box->axes.rows(), k + box->axes.cols());
    both.axes.topLeftCorner(n, k) = product.axes;
    both.axes.bottomRightCorner(box->axes.rows(), box->axes.cols()) = box->axes;
    both.half_width = joined(product.half_width, box->half_width);
    both.scale = joined(product.scale, box->scale);
    both.alpha = 1.0 - (1.0 - product.alpha) * (1.0 - box->alpha);
    both.beta = std::max(product.beta, box->beta);
    product = std::move(both);
  }
  return product;
}

Eigen::VectorXd coordinates(const SynergyBox& box, const Eigen::VectorXd& q) {
  check_point(box, q);
  return box.axes.transpose() * (q.cwiseQuotient(box.scale) - box.center);
}

Eigen::VectorXd configuration(const SynergyBox& box, const Eigen::VectorXd& y) {
  require(y.size() == box.axes.cols(), "synergy box: the coordinates do not match the number of synergies");
  return box.scale.cwiseProduct(box.center + box.axes * y);
}

Eigen::VectorXd project(const SynergyBox& box, const Eigen::VectorXd& q) {
  return configuration(box, coordinates(box, q).cwiseMax(-box.half_width).cwiseMin(box.half_width));
}

bool contains(const SynergyBox& box, const Eigen::VectorXd& q, double tolerance) {
  return ((coordinates(box, q).cwiseAbs() - box.half_width).array() <= tolerance).all();
}

}  // namespace opponens::analysis
