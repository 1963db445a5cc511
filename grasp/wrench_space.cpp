// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/wrench_space.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "core/require.hpp"

namespace opponens::grasp {

WrenchSpace::WrenchSpace(Matrix6Xd wrenches, int per_contact, WrenchNorm norm)
    : wrenches_(std::move(wrenches)), per_contact_(per_contact), norm_(norm), scale_(0.0) {
  require(per_contact_ > 0 && wrenches_.cols() > 0 && wrenches_.cols() % per_contact_ == 0,
          "WrenchSpace: the number of wrenches must be a positive multiple of per_contact");
  if (norm_ == WrenchNorm::l1) {
    scale_ = wrenches_.colwise().norm().maxCoeff();
    return;
  }
  for (Eigen::Index first = 0; first < wrenches_.cols(); first += per_contact_) {
    scale_ += wrenches_.middleCols(first, per_contact_).colwise().norm().maxCoeff();
  }
}

Vector6d WrenchSpace::support(const Vector6d& u) const {
  if (norm_ == WrenchNorm::l1) {
    const double* w = wrenches_.data();
    Eigen::Index best = 0;
    double best_value = -std::numeric_limits<double>::infinity();
    for (Eigen::Index j = 0; j < wrenches_.cols(); ++j, w += 6) {
      const double value = (u[0] * w[0] + u[1] * w[1] + u[2] * w[2]) + (u[3] * w[3] + u[4] * w[4] + u[5] * w[5]);
      if (value > best_value) {
        best_value = value;
        best = j;
      }
    }
    return wrenches_.col(best);
  }
  Vector6d sum = Vector6d::Zero();
  for (Eigen::Index first = 0; first < wrenches_.cols(); first += per_contact_) {
    Eigen::Index best = 0;
    if ((u.transpose() * wrenches_.middleCols(first, per_contact_)).maxCoeff(&best) > 0.0) {
      sum += wrenches_.col(first + best);
    }
  }
  return sum;
}

Matrix6Xd WrenchSpace::points(std::size_t max_points) const {
  if (norm_ == WrenchNorm::l1) {
    return static_cast<std::size_t>(wrenches_.cols()) <= max_points ? wrenches_ : Matrix6Xd(6, 0);
  }
  Matrix6Xd sums = Matrix6Xd::Zero(6, 1);
  for (Eigen::Index first = 0; first < wrenches_.cols(); first += per_contact_) {
    const Eigen::Index count = sums.cols();
    if (static_cast<std::size_t>(count * (per_contact_ + 1)) > max_points) return Matrix6Xd(6, 0);
    Matrix6Xd next(6, count * (per_contact_ + 1));
    next.leftCols(count) = sums;
    for (Eigen::Index j = 0; j < per_contact_; ++j) {
      next.middleCols(count * (j + 1), count) = sums.colwise() + wrenches_.col(first + j);
    }
    sums = std::move(next);
  }
  return sums;
}

int wrench_rank(const Matrix6Xd& wrenches, double relative_tolerance) {
  if (wrenches.cols() == 0) return 0;
  // Singular values of W are those of the triangular factor of W': 6 x 6 however many wrenches there are.
  Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(wrenches.cols(), 6), 6);
  padded.topRows(wrenches.cols()) = wrenches.transpose();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(padded);
  const Eigen::Matrix<double, 6, 6> r = qr.matrixQR().topRows<6>().triangularView<Eigen::Upper>();
  const Vector6d sigma = Eigen::JacobiSVD<Eigen::Matrix<double, 6, 6>>(r).singularValues();
  if (sigma[0] == 0.0) return 0;
  return static_cast<int>((sigma.array() > relative_tolerance * sigma[0]).count());
}

}  // namespace opponens::grasp
