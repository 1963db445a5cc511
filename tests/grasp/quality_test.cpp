// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "core/rng.hpp"
#include "random_contacts.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;

std::vector<Contact> three_on_a_sphere(double mu) {
  std::vector<Contact> contacts;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * M_PI * i / 3.0;
    const Vector3d p(std::cos(angle), std::sin(angle), 0.0);
    contacts.push_back({"tip", p, -p, mu});
  }
  return contacts;
}

TEST(Quality, ThreeContactsOnASphere) {
  const GraspQuality quality = evaluate(three_on_a_sphere(0.5), {}, {true});
  EXPECT_EQ(quality.state, ClosureState::force_closure);
  EXPECT_NEAR(quality.min_weight.value(), 1.0 / 24.0, 1e-14);  // by symmetry all 24 weights are equal
  EXPECT_GT(quality.volume.value(), 0.0);
  EXPECT_NEAR(quality.direction.norm(), 1.0, 1e-14);
  // Every contact pushes with 1 against z-torque and z-force only by friction, so epsilon cannot exceed mu.
  EXPECT_LT(quality.epsilon.value(), 0.5);
  EXPECT_FALSE(evaluate(three_on_a_sphere(0.5), {}).volume.has_value());
}

TEST(Quality, TwoPointsAreRankDeficientTwoSoftFingersAreNot) {
  const std::vector<Contact> pinch = {{"a", Vector3d::UnitX(), -Vector3d::UnitX(), 0.5},
                                      {"b", -Vector3d::UnitX(), Vector3d::UnitX(), 0.5}};
  const GraspQuality points = evaluate(pinch, {});
  EXPECT_EQ(points.state, ClosureState::rank_deficient);  // no torque about the line between them
  EXPECT_FALSE(points.epsilon.has_value());
  QualityConvention soft;
  soft.model = ContactModel::soft_finger;
  soft.torsion_radius = 0.01;
  const GraspQuality fingers = evaluate(pinch, soft);
  EXPECT_TRUE(fingers.force_closure());
  // Torque about x comes from torsion alone: at most mu r, so epsilon is at most that.
  EXPECT_LE(fingers.epsilon.value(), 0.5 * 0.01 + 1e-12);
  EXPECT_GT(fingers.epsilon.value(), 0.9 * 0.5 * 0.01);
}

TEST(Quality, StatesOfPoorSets) {
  EXPECT_EQ(evaluate({}, {}).state, ClosureState::rank_deficient);
  EXPECT_FALSE(evaluate({}, {}).min_weight.has_value());
  EXPECT_EQ(evaluate(three_on_a_sphere(0.0), {}).state, ClosureState::rank_deficient);  // no torque at all
  std::vector<Contact> one_side = three_on_a_sphere(0.3);
  for (Contact& contact : one_side) {
    contact.p_OC.z() = 1.0;
    contact.n_O = -contact.p_OC.normalized();
  }
  const GraspQuality quality = evaluate(one_side, {});
  EXPECT_EQ(quality.state, ClosureState::not_force_closure);
  EXPECT_LT(quality.epsilon.value(), 0.0);
  EXPECT_LT(quality.min_weight.value(), 0.0);
  const auto w = contact_wrenches(one_side, {});
  EXPECT_NEAR((quality.direction.transpose() * w).maxCoeff(), quality.epsilon.value(), 1e-10);
}

TEST(Quality, BelowAnIncumbentIsAStateWithoutEpsilon) {
  const double epsilon = evaluate(three_on_a_sphere(0.5), {}).epsilon.value();
  const GraspQuality given_up = evaluate(three_on_a_sphere(0.5), {}, {.at_least = 1.01 * epsilon});
  EXPECT_EQ(given_up.state, ClosureState::below_incumbent);
  EXPECT_FALSE(given_up.epsilon.has_value());
  EXPECT_FALSE(given_up.force_closure());
  EXPECT_EQ(evaluate(three_on_a_sphere(0.5), {}, {.at_least = 0.99 * epsilon}).epsilon, epsilon);
}

// Seven frictionless contacts can hold a body, six never can (Somov 1900): wrenches that positively span R^6.
TEST(Quality, SevenFrictionlessContactsHoldACubeAndNoSixOfThemDo) {
  Rng rng = stream(31, "cube");
  QualityConvention convention;
  convention.model = ContactModel::frictionless;
  std::vector<Contact> contacts;
  do {
    contacts.clear();
    for (int i = 0; i < 7; ++i) {
      const int face = i < 6 ? i : static_cast<int>(rng.index(6));
      Vector3d p(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      p[face / 2] = face % 2 ? 1.0 : -1.0;
      contacts.push_back({"", p, -p[face / 2] * Vector3d::Unit(face / 2), 0.0});
    }
  } while (!evaluate(contacts, convention).force_closure());
  EXPECT_GT(evaluate(contacts, convention).min_weight.value(), 0.0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    std::vector<Contact> fewer = contacts;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(evaluate(fewer, convention).state, ClosureState::force_closure) << i;
  }
}

TEST(Quality, GrowsWithFrictionAndWithContacts) {
  Rng rng = stream(32, "monotone");
  int grew = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<Contact> contacts = test::random_contacts(5, 0.3, rng);
    const double first = evaluate(contacts, {}).epsilon.value();
    std::vector<Contact> rougher = contacts;
    for (Contact& contact : rougher) contact.mu += 0.2;
    EXPECT_GE(evaluate(rougher, {}).epsilon.value(), first - 1e-12) << "set " << i;
    contacts.push_back(test::random_contacts(1, 0.3, rng)[0]);
    const double more = evaluate(contacts, {}).epsilon.value();
    EXPECT_GE(more, first - 1e-12) << "set " << i;
    grew += more > first + 1e-6;
  }
  EXPECT_GT(grew, 100);
}

TEST(Quality, LInfinityIsAtLeastL1) {
  Rng rng = stream(33, "norms");
  for (int i = 0; i < 20; ++i) {
    const std::vector<Contact> contacts = test::random_contacts(4, 0.2, rng);
    QualityConvention convention;
    convention.edges = 4;
    const double l1 = evaluate(contacts, convention).epsilon.value();
    convention.norm = WrenchNorm::linf;
    if (l1 > 0.0) {
      EXPECT_GE(evaluate(contacts, convention).epsilon.value(), l1);
    }
  }
}

TEST(Quality, SameAnswersFromManyThreads) {
  Rng rng = stream(34, "threads");
  std::vector<std::vector<Contact>> sets;
  for (int i = 0; i < 40; ++i) sets.push_back(test::random_contacts(6, 0.2, rng));
  const auto all = [&] {
    std::vector<double> values;
    for (const auto& set : sets) {
      const GraspQuality quality = evaluate(set, {}, {true});
      values.push_back(quality.epsilon.value());
      values.push_back(quality.volume.value_or(-1.0));
    }
    return values;
  };
  std::vector<double> first;
  std::vector<double> second;
  {
    std::jthread other([&] { first = all(); });
    second = all();
  }
  EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace opponens::grasp
