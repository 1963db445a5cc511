// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/robust_quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "allegro.hpp"
#include "analysis/intervals.hpp"
#include "grasp/quality.hpp"
#include "robot/mesh.hpp"
#include "tests/support/sample_count.hpp"

namespace opponens::grasp {
namespace {

robot::MeshDistance distance_of(const robot::Geometry& geometry) {
  return robot::MeshDistance(std::make_shared<const robot::TriangleMesh>(robot::merge({geometry})));
}

/// A grasp by contacts alone: closing moves nothing (pre-grasp and grasp agree), so contacts follow along normals.
Grasp by_contacts(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& points, double mu) {
  Grasp grasp;
  grasp.q_grasp = grasp.q_pregrasp = Eigen::VectorXd::Zero(16);
  for (const auto& [p, n] : points) grasp.contacts.push_back({"palm_link", p, n, mu});
  grasp.quality = evaluate(grasp.contacts, QualityConvention{});
  return grasp;
}

constexpr double kRadius = 0.04;

/// Three contacts 120 degrees apart, 4 cm from the z axis through the center: force closure exactly when mu > 0.
Grasp from_three_sides(const Eigen::Vector3d& center, double mu) {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> points;
  for (int i = 0; i < 3; ++i) {
    const double angle = std::numbers::pi * (2 * i + 1) / 3.0;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    points.emplace_back(center + kRadius * out, -out);
  }
  Grasp grasp = by_contacts(points, mu);
  grasp.quality.convention.rho = kRadius;
  grasp.quality.convention.origin = center;
  grasp.quality = evaluate(grasp.contacts, grasp.quality.convention);
  return grasp;
}

/// Two contacts on each of two opposite faces of a box, and two on the faces between.
Grasp around_a_box(double mu) {
  return by_contacts({{{0.03, 0.02, 0.01}, {-1, 0, 0}},
                      {{0.03, -0.02, -0.01}, {-1, 0, 0}},
                      {{-0.03, 0.02, -0.01}, {1, 0, 0}},
                      {{-0.03, -0.02, 0.01}, {1, 0, 0}}},
                     mu);
}

RobustQuality asked(const robot::MeshDistance& object, const Grasp& grasp, const GraspNoise& noise) {
  Rng rng = stream(1, "robust");
  return robust_quality(test::allegro(), object, grasp, noise, rng);
}

const robot::Geometry kBox{robot::Box{{0.06, 0.1, 0.1}}, Eigen::Isometry3d::Identity()};

TEST(RobustQuality, WithoutErrorsItIsTheNominalQuality) {
  const Grasp grasp = around_a_box(0.5);
  ASSERT_TRUE(grasp.quality.force_closure());
  const RobustQuality robust = asked(distance_of(kBox), grasp, {0.0, 0.0, 0.0, 20});
  EXPECT_EQ(robust.force_closure, 1.0);
  EXPECT_EQ(robust.force_closure_high, 1.0);
  EXPECT_NEAR(robust.force_closure_low, std::pow(0.025, 1.0 / 20.0), 1e-12);  // Clopper and Pearson, all of 20
  EXPECT_NEAR(robust.epsilon_mean, *grasp.quality.epsilon, 1e-4);
  EXPECT_NEAR(robust.epsilon_low, *grasp.quality.epsilon, 1e-4);
  EXPECT_EQ(robust.noise.samples, 20);
}

TEST(RobustQuality, ErrorsCostQuality) {
  const robot::MeshDistance object = distance_of(kBox);
  const Grasp grasp = around_a_box(0.5);
  const RobustQuality little = asked(object, grasp, {0.002, 0.0, 0.0, sample_count(400)});
  EXPECT_EQ(little.force_closure, 1.0);  // contacts stay on their faces, 3 cm from the nearest edge
  EXPECT_LT(little.epsilon_low, little.epsilon_mean);
  EXPECT_LT(little.epsilon_mean, *grasp.quality.epsilon);
  const RobustQuality more = asked(object, grasp, {0.02, 0.1, 0.0, sample_count(400)});
  EXPECT_LT(more.epsilon_mean, little.epsilon_mean);
  const RobustQuality away = asked(object, grasp, {5.0, 0.0, 0.0, sample_count(400)});
  EXPECT_EQ(away.force_closure, 0.0);  // every contact is lost
  EXPECT_EQ(away.epsilon_mean, 0.0);
  EXPECT_EQ(away.force_closure_low, 0.0);
}

/// The object turns about its centre of mass, wherever its frame is: a sphere does not notice.
TEST(RobustQuality, TurnsAboutTheConventionsOrigin) {
  const Eigen::Vector3d center(0.5, -0.3, 0.2);
  const auto fine = std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Sphere{kRadius}, 256));
  const robot::Geometry ball{fine, Eigen::Isometry3d(Eigen::Translation3d(center))};
  Grasp grasp = from_three_sides(center, 0.5);
  const RobustQuality turned = asked(distance_of(ball), grasp, {0.0, 0.5, 0.0, sample_count(200)});
  EXPECT_EQ(turned.force_closure, 1.0);
  EXPECT_NEAR(turned.epsilon_mean, *grasp.quality.epsilon, 0.05 * *grasp.quality.epsilon);  // of triangles
  grasp.quality.convention.origin.setZero();  // known wrong: the sphere swings away by 0.3 m
  const RobustQuality swung = asked(distance_of(ball), grasp, {0.0, 0.5, 0.0, sample_count(200)});
  EXPECT_LT(swung.force_closure, 0.2);
}

/// Force closure means mu + error > 0, so its share is the normal distribution's at mu / sigma. The exact binomial
/// interval at 1e-4 holds it; the share that twice the error would give lies outside.
TEST(RobustQuality, ShareIsTheProbabilityOfClosure) {
  constexpr int kSamples = 4000;
  // A prism: its flat sides give the contacts their normals exactly.
  const auto prism =
      std::make_shared<const robot::TriangleMesh>(robot::revolve({{2.0 * kRadius, -0.1}, {2.0 * kRadius, 0.1}}, 3));
  const robot::Geometry sides{prism, Eigen::Isometry3d::Identity()};
  const Grasp grasp = from_three_sides(Eigen::Vector3d::Zero(), 0.1);
  const RobustQuality robust = asked(distance_of(sides), grasp, {0.0, 0.0, 0.1, kSamples});
  const auto normal = [](double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); };
  const int closed = static_cast<int>(std::lround(robust.force_closure * kSamples));
  const analysis::Interval interval = analysis::proportion_interval(closed, kSamples, 1.0 - 1e-4);
  EXPECT_LE(interval.low, normal(1.0));
  EXPECT_GE(interval.high, normal(1.0));
  EXPECT_GT(interval.low, normal(0.5));
}

/// A finger follows the object along its closing motion, not along the normal: the index finger's first joint moves
/// the contact across a plate that is tilted against that motion.
TEST(RobustQuality, FingersFollowAlongTheirClosing) {
  const robot::RobotModel& hand = test::allegro();
  Grasp grasp;
  grasp.q_grasp = Eigen::VectorXd::Zero(16);
  grasp.q_grasp[12] = 0.6;
  grasp.q_pregrasp = grasp.q_grasp;
  grasp.q_pregrasp[1] -= 0.2;
  const int tip = hand.link_index("link_3.0_tip");
  const auto X_HL = hand.link_poses(grasp.q_grasp);
  const Eigen::Vector3d p = X_HL[static_cast<std::size_t>(tip)].translation();
  const Eigen::Vector3d way = (hand.point_jacobian(X_HL, tip, p) * (grasp.q_grasp - grasp.q_pregrasp)).normalized();
  const Eigen::Vector3d across = way.unitOrthogonal();
  const Eigen::Vector3d n = (way + across).normalized();  // 45 degrees to the motion
  // A thick plate with its face at p, 5 mm farther than the grasp thinks, along the face's normal.
  robot::Geometry plate{robot::Box{{0.4, 0.4, 0.4}}, Eigen::Isometry3d::Identity()};
  plate.X_BG.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), n).toRotationMatrix();
  plate.X_BG.translation() = p + (0.2 + 0.005) * n;
  grasp.contacts = {{"link_3.0_tip", p, n, 0.5}};
  const Contact followed =
      disturbed_contacts(hand, distance_of(plate), grasp, Eigen::Isometry3d::Identity(), 0.0).at(0);
  const Eigen::Vector3d expected = p + 0.005 * std::numbers::sqrt2 * way;
  EXPECT_LT((followed.p_OC - expected).norm(), 5e-5);
  EXPECT_LT((followed.n_O - n).norm(), 1e-9);
  grasp.q_pregrasp = grasp.q_grasp;  // what does not close follows along the normal
  const Contact pushed = disturbed_contacts(hand, distance_of(plate), grasp, Eigen::Isometry3d::Identity(), 0.1).at(0);
  EXPECT_LT((pushed.p_OC - (p + 0.005 * n)).norm(), 5e-5);
  EXPECT_DOUBLE_EQ(pushed.mu, 0.6);
}

TEST(RobustQuality, SameStreamSameNumbersAndBrokenContractsThrow) {
  const robot::MeshDistance object = distance_of(kBox);
  const Grasp grasp = around_a_box(0.5);
  const RobustQuality a = asked(object, grasp, {0.01, 0.1, 0.1, 50});
  const RobustQuality b = asked(object, grasp, {0.01, 0.1, 0.1, 50});
  EXPECT_EQ(a.epsilon_mean, b.epsilon_mean);
  EXPECT_EQ(a.epsilon_low, b.epsilon_low);
  EXPECT_THROW(asked(object, grasp, {-1.0, 0.0, 0.0, 5}), std::invalid_argument);
  EXPECT_THROW(asked(object, grasp, {0.0, std::numeric_limits<double>::quiet_NaN(), 0.0, 5}), std::invalid_argument);
  EXPECT_THROW(asked(object, grasp, {0.0, 0.0, 0.0, 0}), std::invalid_argument);
  Grasp other = grasp;
  other.q_grasp.resize(3);
  EXPECT_THROW(asked(object, other, {}), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::grasp
