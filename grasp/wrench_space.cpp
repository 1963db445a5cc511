// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/wrench_space.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "core/require.hpp"
#include "grasp/friction_cone.hpp"
#include "grasp/quality.hpp"

namespace opponens::grasp {
namespace {

Vector6d curved_support(const std::vector<QuadraticContact>& contacts, WrenchNorm norm, const Vector6d& u) {
  Vector6d result = Vector6d::Zero();
  double best = -std::numeric_limits<double>::infinity();
  for (const QuadraticContact& contact : contacts) {
    const Vector6d w = contact.support(u);
    const double value = u.dot(w);
    if (norm == WrenchNorm::linf && value > 0.0) result += w;
    if (norm == WrenchNorm::l1 && value > best) {
      best = value;
      result = w;
    }
  }
  return result;
}

}  // namespace

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

WrenchSpace::WrenchSpace(const std::vector<Contact>& contacts, const QualityConvention& convention)
    : WrenchSpace(contact_wrenches(contacts, convention), edges_per_contact(convention), convention.norm) {
  if (convention.cone == FrictionCone::pyramid || convention.model == ContactModel::frictionless) return;
  auto cones = std::make_shared<std::vector<QuadraticContact>>();
  scale_ = 0.0;
  for (const Contact& contact : contacts) {
    const double length = cones->emplace_back(contact, convention).scale();
    scale_ = norm_ == WrenchNorm::l1 ? std::max(scale_, length) : scale_ + length;
  }
  quadratic_ = std::move(cones);
}

Vector6d WrenchSpace::support(const Vector6d& u) const {
  if (quadratic_) return curved_support(*quadratic_, norm_, u);
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
  if (quadratic_) return Matrix6Xd(6, 0);
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
