// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/wrench_gradient.hpp"

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "grasp/min_weight.hpp"
#include "grasp/quality.hpp"
#include "random_contacts.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;

QualityConvention random_convention(Rng& rng) {
  QualityConvention convention;
  convention.model = static_cast<ContactModel>(rng.index(3));
  convention.edges = 3 + static_cast<int>(rng.index(6));
  convention.unit = static_cast<ForceUnit>(rng.index(2));
  convention.rho = rng.uniform(0.3, 3.0);
  convention.torsion_radius = rng.uniform(0.001, 0.02);
  convention.origin = 0.2 * test::random_unit(rng);
  return convention;
}

Contact moved(const Contact& contact, const Vector3d& dp, const Vector3d& dn) {
  Contact other = contact;
  other.p_OC += dp;
  other.n_O = (contact.n_O + dn).normalized();
  return other;
}

TEST(WrenchGradient, JacobianEqualsCentralDifferencesForEveryModelAndUnit) {
  Rng rng = stream(41, "jacobian");
  constexpr double h = 1e-6;
  double largest = 0.0;
  for (int i = 0; i < 200; ++i) {
    const QualityConvention convention = random_convention(rng);
    const Contact contact = test::random_contacts(1, 0.5, rng).front();
    if (contact.n_O.cross(Vector3d::UnitX()).norm() < 0.1) continue;  // the tangents turn too fast to difference
    const auto jacobian = wrench_jacobian(contact, convention);
    for (Eigen::Index k = 0; k < 6; ++k) {
      const Vector3d dp = k < 3 ? Vector3d(h * Vector3d::Unit(k)) : Vector3d::Zero();
      const Vector3d dn = k < 3 ? Vector3d::Zero() : Vector3d(h * Vector3d::Unit(k - 3));
      const Matrix6Xd up = contact_wrenches({moved(contact, dp, dn)}, convention);
      const Matrix6Xd down = contact_wrenches({moved(contact, -dp, -dn)}, convention);
      const Eigen::VectorXd numeric = (up - down).reshaped() / (2.0 * h);
      EXPECT_NEAR((jacobian.col(k) - numeric).cwiseAbs().maxCoeff(), 0.0, 1e-6) << "contact " << i << " column " << k;
    }
    largest = std::max(largest, jacobian.rightCols<3>().cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest, 1.0);
}

TEST(WrenchGradient, ReverseFormIsTheJacobianTransposed) {
  Rng rng = stream(42, "reverse");
  for (int i = 0; i < 50; ++i) {
    const QualityConvention convention = random_convention(rng);
    const std::vector<Contact> contacts = test::random_contacts(4, 0.5, rng);
    Matrix6Xd slope = contact_wrenches(contacts, convention);
    for (double& value : slope.reshaped()) value = rng.normal();
    const ContactGradient gradient = contact_gradient(contacts, convention, slope);
    const Eigen::Index per_contact = slope.cols() / 4;
    for (Eigen::Index k = 0; k < 4; ++k) {
      const auto jacobian = wrench_jacobian(contacts[static_cast<std::size_t>(k)], convention);
      const Eigen::Matrix<double, 6, 1> expected =
          jacobian.transpose() * slope.middleCols(per_contact * k, per_contact).reshaped();
      const double size = 1.0 + expected.norm();
      EXPECT_NEAR((gradient.position.col(k) - expected.head<3>()).norm(), 0.0, 1e-12 * size);
      EXPECT_NEAR((gradient.normal.col(k) - expected.tail<3>()).norm(), 0.0, 1e-12 * size);
    }
  }
}

// l* itself along random motions of the contacts. Three edges a cone: generic sets have one optimum.
TEST(WrenchGradient, MinWeightFollowsTheContacts) {
  Rng rng = stream(43, "chain");
  constexpr double h = 1e-6;
  int compared = 0;
  double largest = 0.0;
  for (int i = 0; i < 200; ++i) {
    QualityConvention convention;
    convention.edges = 3;
    convention.unit = static_cast<ForceUnit>(rng.index(2));
    const std::vector<Contact> contacts = test::random_contacts(4, 0.4, rng);
    const MinWeight solution = min_weight(contact_wrenches(contacts, convention));
    if (solution.state != MinWeight::State::optimal || solution.value == 0.0) continue;
    const ContactGradient gradient = contact_gradient(contacts, convention, min_weight_gradient(solution));
    std::vector<Contact> up;
    std::vector<Contact> down;
    double slope = 0.0;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const Vector3d dp = test::random_unit(rng);
      const Vector3d dn = test::random_unit(rng);
      up.push_back(moved(contacts[k], h * dp, h * dn));
      down.push_back(moved(contacts[k], -h * dp, -h * dn));
      slope += gradient.position.col(static_cast<Eigen::Index>(k)).dot(dp) +
               gradient.normal.col(static_cast<Eigen::Index>(k)).dot(dn);
    }
    const MinWeight above = min_weight(contact_wrenches(up, convention));
    const MinWeight below = min_weight(contact_wrenches(down, convention));
    const double forward = (above.value - solution.value) / h;
    const double backward = (solution.value - below.value) / h;
    if (std::abs(forward - backward) > 1e-3 * (1.0 + std::abs(forward))) continue;  // a kink of the optimum
    EXPECT_NEAR(slope, 0.5 * (forward + backward), 1e-5 * (1.0 + std::abs(slope))) << "set " << i;
    largest = std::max(largest, std::abs(slope));
    ++compared;
  }
  EXPECT_GT(compared, 150);
  EXPECT_GT(largest, 0.01);
}

TEST(WrenchGradient, BrokenContractsThrow) {
  const std::vector<Contact> one = {{"tip", Vector3d::Zero(), Vector3d::UnitZ(), 0.5}};
  EXPECT_THROW(contact_gradient(one, {}, Matrix6Xd::Zero(6, 7)), std::invalid_argument);
  EXPECT_THROW(wrench_jacobian({"tip", Vector3d::Zero(), Vector3d::Zero(), 0.5}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::grasp
