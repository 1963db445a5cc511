// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "grasp/quality.hpp"
#include "grasp/wrench_space.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;

Vector6d wrench(double fx, double fy, double fz, double tx, double ty, double tz) {
  return (Vector6d() << fx, fy, fz, tx, ty, tz).finished();
}

TEST(ContactModel, PointWithFrictionByHand) {
  // n = -z at (0, 0, 2): t_x = n x X = -y, t_y = n x t_x = -x. Torque (p x f) / rho with rho = 2: (-f_y, f_x, 0).
  const std::vector<Contact> contacts = {{"tip", Vector3d(0, 0, 2), -Vector3d::UnitZ(), 0.5}};
  QualityConvention convention;
  convention.edges = 4;
  convention.rho = 2.0;
  const Matrix6Xd w = contact_wrenches(contacts, convention);
  ASSERT_EQ(w.cols(), 4);
  EXPECT_TRUE(w.col(0).isApprox(wrench(0, -0.5, -1, 0.5, 0, 0), 1e-15));
  EXPECT_TRUE(w.col(1).isApprox(wrench(-0.5, 0, -1, 0, -0.5, 0), 1e-15));
  EXPECT_TRUE(w.col(2).isApprox(wrench(0, 0.5, -1, -0.5, 0, 0), 1e-15));
  EXPECT_TRUE(w.col(3).isApprox(wrench(0.5, 0, -1, 0, 0.5, 0), 1e-15));
}

TEST(ContactModel, NormalAlongXUsesTheOtherTangentAndOriginShiftsTorque) {
  const std::vector<Contact> contacts = {{"tip", Vector3d(1, 2, 3), Vector3d::UnitX(), 0.0}};
  QualityConvention convention;
  convention.model = ContactModel::frictionless;
  convention.origin = Vector3d(1, 0, 3);
  const Matrix6Xd w = contact_wrenches(contacts, convention);
  ASSERT_EQ(w.cols(), 1);
  EXPECT_TRUE(w.col(0).isApprox(wrench(1, 0, 0, 0, 0, -2), 1e-15));
  convention.model = ContactModel::point_with_friction;
  EXPECT_TRUE(contact_wrenches(contacts, convention).allFinite());
}

TEST(ContactModel, UnitForceHasLengthOneAndKeepsDirection) {
  const std::vector<Contact> contacts = {{"tip", Vector3d(0.1, 0.2, -0.1), Vector3d(1, 2, 2) / 3.0, 0.7}};
  QualityConvention convention;
  const Matrix6Xd normal = contact_wrenches(contacts, convention);
  convention.unit = ForceUnit::force;
  const Matrix6Xd force = contact_wrenches(contacts, convention);
  for (Eigen::Index j = 0; j < force.cols(); ++j) {
    EXPECT_NEAR(force.col(j).head<3>().norm(), 1.0, 1e-14);
    EXPECT_NEAR(normal.col(j).head<3>().dot(contacts[0].n_O), 1.0, 1e-14);
    EXPECT_NEAR((normal.col(j).normalized() - force.col(j).normalized()).norm(), 0.0, 1e-14);
  }
}

TEST(ContactModel, SoftFingerTwistsAboutItsNormal) {
  const std::vector<Contact> contacts = {{"tip", Vector3d::Zero(), Vector3d::UnitZ(), 0.5}};
  QualityConvention convention;
  convention.model = ContactModel::soft_finger;
  convention.torsion_radius = 0.002;
  const Matrix6Xd w = contact_wrenches(contacts, convention);
  ASSERT_EQ(w.cols(), 20);
  EXPECT_NEAR(w(5, 0), 0.5 * 0.002, 1e-15);    // latitude 90: torque alone
  EXPECT_NEAR(w(5, 19), -0.5 * 0.002, 1e-15);  // latitude -90
  EXPECT_NEAR(w.col(0).head<2>().norm(), 0.0, 1e-15);
  for (Eigen::Index j = 0; j < 20; ++j) {  // on the ellipsoid: (f_t / mu)^2 + (torque / (mu r))^2 = 1
    EXPECT_NEAR(w.col(j).head<2>().squaredNorm() / 0.25 + std::pow(w(5, j) / 0.001, 2), 1.0, 1e-12) << j;
  }
}

TEST(ContactModel, BrokenContractsThrow) {
  const Contact good{"tip", Vector3d::Zero(), Vector3d::UnitZ(), 0.5};
  const auto throws = [](const Contact& contact, const QualityConvention& convention) {
    EXPECT_THROW(contact_wrenches({contact}, convention), std::invalid_argument);
  };
  Contact bad = good;
  bad.n_O *= 2.0;
  throws(bad, {});
  bad = good;
  bad.p_OC.x() = std::nan("");
  throws(bad, {});
  bad = good;
  bad.mu = -0.1;
  throws(bad, {});
  QualityConvention convention;
  convention.edges = 2;
  throws(good, convention);
  convention = {};
  convention.rho = 0.0;
  throws(good, convention);
  convention = {};
  convention.model = ContactModel::soft_finger;
  throws(good, convention);
}

}  // namespace
}  // namespace opponens::grasp
