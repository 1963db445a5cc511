// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"

namespace opponens::grasp {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

struct QuadraticContact;

/// The set of wrenches a grasp can resist, given by its support function h(u) = max over the set of u'w:
/// L1 (total normal force <= 1): the convex hull of the primitive wrenches, h(u) = max_j u'w_j.
/// L-infinity (each contact's normal force <= 1): the Minkowski sum over contacts of conv({0} and its wrenches),
/// h(u) = sum_i max(0, max_j u'w_ij). The origin belongs to each summand, as in GraspIt!: a contact may push less.
/// With quadratic cones the maximum over a contact's wrenches w_ij is one over its exact cone: a curved set.
class WrenchSpace {
 public:
  /// wrenches: [6 x (m * per_contact)], contact by contact.
  WrenchSpace(Matrix6Xd wrenches, int per_contact, WrenchNorm norm);
  /// The set of given contacts under a convention, pyramids or quadratic cones; at least one contact.
  WrenchSpace(const std::vector<Contact>& contacts, const QualityConvention& convention);

  /// A point of the set that is extreme in direction u. Cost: 12 flops per wrench.
  Vector6d support(const Vector6d& u) const;

  bool curved() const { return quadratic_ != nullptr; }
  const Matrix6Xd& wrenches() const { return wrenches_; }  ///< of the pyramids, also when the set is curved
  WrenchNorm norm() const { return norm_; }
  double scale() const { return scale_; }  ///< an upper bound of the length of the set's points

  /// The points whose hull is the set: the wrenches (L1), or the sums of one wrench or zero per contact (L-infinity).
  /// Empty when there would be more than max_points, and for a curved set.
  Matrix6Xd points(std::size_t max_points) const;

 private:
  Matrix6Xd wrenches_;
  int per_contact_;
  WrenchNorm norm_;
  double scale_;
  std::shared_ptr<const std::vector<QuadraticContact>> quadratic_;  // null: pyramids
};

/// Number of linearly independent wrenches: singular values above relative_tolerance times the largest one.
int wrench_rank(const Matrix6Xd& wrenches, double relative_tolerance);

}  // namespace opponens::grasp
