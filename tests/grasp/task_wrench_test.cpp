// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/task_wrench.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.hpp"
#include "grasp/origin_ball.hpp"
#include "grasp/quality.hpp"
#include "random_contacts.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;

TEST(TaskWrench, CrossPolytopeAndCubeByHand) {
  // |w|_1 <= 1: the ray along (2, 0, ...) ends at 1/2, along (1, ..., 1) at 1/6. Sum of the segments: |w|_max <= 1.
  const WrenchSpace l1(test::cross_polytope(), 1, WrenchNorm::l1);
  const WrenchSpace linf(test::cross_polytope(), 1, WrenchNorm::linf);
  EXPECT_NEAR(load_factor(l1, 2.0 * Vector6d::Unit(0)).factor, 0.5, 1e-14);
  EXPECT_NEAR(load_factor(l1, Vector6d::Ones()).factor, 1.0 / 6.0, 1e-14);
  EXPECT_NEAR(load_factor(linf, Vector6d::Ones()).factor, 1.0, 1e-9);
  EXPECT_NEAR(load_factor(linf, Vector6d::Ones()).upper, 1.0, 1e-9);
  Matrix6Xd loads(6, 3);
  loads << Vector6d::Unit(0), Vector6d::Ones(), -3.0 * Vector6d::Unit(4);
  const TaskQuality task = task_quality(l1, loads);
  EXPECT_EQ(task.limiting, 1);
  EXPECT_NEAR(task.least.factor, 1.0 / 6.0, 1e-14);
}

// A bottle on a palm: no force closure, yet its weight is carried, by exactly its weight; sideways nothing is.
TEST(TaskWrench, APalmCarriesAndDoesNotPull) {
  std::vector<Contact> palm;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * M_PI * i / 3.0;
    palm.push_back({"palm", 0.1 * Vector3d(std::cos(angle), std::sin(angle), 0.0), Vector3d::UnitZ(), 0.0});
  }
  QualityConvention convention;
  convention.model = ContactModel::frictionless;
  convention.rho = 0.05;
  const WrenchSpace space(palm, convention);
  const Vector6d weight = load_against_gravity(2.0, Vector3d(0.01, 0.0, 0.3), Vector3d(0, 0, -5), convention);
  EXPECT_NEAR(weight[2], 2.0 * 9.80665, 1e-12);
  EXPECT_NEAR(weight[4], -0.01 * 2.0 * 9.80665 / 0.05, 1e-12);  // what acts is p x f = +y here, and this is against it
  EXPECT_NEAR(1.0 / load_factor(space, weight).factor, 2.0 * 9.80665, 1e-9);
  const LoadFactor sideways = load_factor(space, load_against({1, 0, 0}, Vector3d::Zero(), convention));
  EXPECT_EQ(sideways.factor, 0.0);
  EXPECT_EQ(sideways.upper, 0.0);
  EXPECT_TRUE(sideways.converged);
  EXPECT_LT((sideways.direction.transpose() * space.wrenches()).maxCoeff(), 1e-12);
  EXPECT_GT(sideways.direction.dot(load_against({1, 0, 0}, Vector3d::Zero(), convention)), 0.5);
  const Vector6d beside = load_against_gravity(2.0, Vector3d(0.2, 0.0, 0.3), -Vector3d::UnitZ(), convention);
  EXPECT_EQ(load_factor(space, beside).factor, 0.0);  // beyond the triangle of contacts: it tips
}

// Against the definition: k load is in the set, and the plane of the answer shows that no more is.
TEST(TaskWrench, FactorIsReachedAndItsPlaneBoundsIt) {
  Rng rng = stream(61, "plane");
  int held = 0;
  for (int i = 0; i < 60; ++i) {
    QualityConvention convention;
    convention.edges = 3 + static_cast<int>(rng.index(6));
    convention.norm = i % 2 ? WrenchNorm::linf : WrenchNorm::l1;
    convention.cone = i % 3 == 2 ? FrictionCone::quadratic : FrictionCone::pyramid;
    const WrenchSpace space(test::random_contacts(5, 0.4, rng), convention);
    Vector6d load;
    for (double& value : load) value = rng.normal();
    const double gap = space.curved() ? 1e-3 : 0.0;
    const LoadFactor found = load_factor(space, load, gap);
    ASSERT_TRUE(found.converged) << "set " << i;
    const double h = std::max(found.direction.dot(space.support(found.direction)), 0.0);
    EXPECT_NEAR(h, found.upper * found.direction.dot(load), 1e-7) << "set " << i;
    EXPECT_GT(found.direction.dot(load), 0.0);
    EXPECT_LE(found.factor, found.upper * (1.0 + 1e-12));
    EXPECT_LE(found.upper, found.factor * (1.0 + std::max(gap, 1e-9)) + 1e-12);
    held += found.factor > 0.0;
  }
  EXPECT_GT(held, 20);
}

// All unit loads: their least factor is epsilon, reached along the direction that decides epsilon.
TEST(TaskWrench, LeastFactorOfUnitLoadsIsEpsilon) {
  Rng rng = stream(62, "ball");
  int compared = 0;
  for (int i = 0; i < 40; ++i) {
    QualityConvention convention;
    convention.norm = i % 2 ? WrenchNorm::linf : WrenchNorm::l1;
    const std::vector<Contact> contacts = test::random_contacts(5, 0.3, rng);
    const GraspQuality quality = evaluate(contacts, convention);
    if (!quality.force_closure()) continue;
    ++compared;
    const WrenchSpace space(contacts, convention);
    EXPECT_NEAR(load_factor(space, quality.direction).factor, *quality.epsilon, 1e-9 + 1e-8 * *quality.epsilon);
    Vector6d other;
    for (double& value : other) value = rng.normal();
    EXPECT_GE(load_factor(space, other.normalized()).factor, *quality.epsilon - 1e-9);
  }
  EXPECT_GT(compared, 15);
}

TEST(TaskWrench, BrokenContractsThrow) {
  const WrenchSpace space(test::cross_polytope(), 1, WrenchNorm::l1);
  EXPECT_THROW(load_factor(space, Vector6d::Zero()), std::invalid_argument);
  EXPECT_THROW(task_quality(space, Matrix6Xd(6, 0)), std::invalid_argument);
  EXPECT_THROW(load_against_gravity(-1.0, Vector3d::Zero(), Vector3d::UnitZ(), {}), std::invalid_argument);
  EXPECT_THROW(load_against_gravity(1.0, Vector3d::Zero(), Vector3d::Zero(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::grasp
