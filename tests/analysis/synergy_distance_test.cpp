// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/synergy_distance.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include "analysis/likeness.hpp"
#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "analysis/synergy_box.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

Eigen::MatrixXd orthonormal(int rows, int columns, Rng& rng) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(test::normal_matrix(rows, columns, rng)).householderQ() *
         Eigen::MatrixXd::Identity(rows, columns);
}

SynergyGroup learnt(const std::string& name, const Eigen::MatrixXd& samples, const Eigen::VectorXd& scale) {
  SynergyGroup group;
  group.name = name;
  group.phase = "grasp";
  group.basis = principal_axes(scaled(moments(samples), scale));
  group.dof_effective = static_cast<int>(samples.cols());
  group.box = make_box(group.basis, scale, 0.05, 0.05, BoxRoot::n, group.dof_effective);
  return group;
}

TEST(PrincipalAngles, OfKnownPlanes) {
  Eigen::MatrixXd a(4, 2);
  a << 1, 0, 0, 1, 0, 0, 0, 0;
  for (const double angle : {0.0, 1e-12, 1e-6, 0.3, 1.2, std::numbers::pi / 2}) {
    Eigen::MatrixXd b(4, 2);  // the first axis shared, the second turned out of the plane
    b << 1, 0, 0, std::cos(angle), 0, std::sin(angle), 0, 0;
    const Eigen::VectorXd angles = principal_angles(a, b);
    ASSERT_EQ(angles.size(), 2);
    EXPECT_NEAR(angles[0], 0.0, 1e-15);
    EXPECT_NEAR(angles[1], angle, 1e-15 + 1e-14 * angle) << "a cosine alone would lose angles below 1e-8";
  }
}

TEST(PrincipalAngles, InvariantSymmetricAndThoseOfTheRotation) {
  for (int trial = 0; trial < 100; ++trial) {
    Rng rng = test::numbered_stream(40, "principal angles/", trial);
    const int n = 3 + static_cast<int>(rng.index(14));
    const int k = 1 + static_cast<int>(rng.index(static_cast<std::uint64_t>(n / 2)));
    const int l = k + static_cast<int>(rng.index(static_cast<std::uint64_t>(n - 2 * k + 1)));
    // b: each axis of a turned by a known angle towards a direction orthogonal to everything, and l - k axes more.
    const Eigen::MatrixXd frame = orthonormal(n, std::min(n, k + l), rng);
    Eigen::VectorXd truth(k);
    for (double& angle : truth) angle = rng.uniform(0.0, std::numbers::pi / 2);
    std::sort(truth.begin(), truth.end());
    const Eigen::MatrixXd a = frame.leftCols(k);
    Eigen::MatrixXd b(n, l);
    b.leftCols(k) = a * truth.array().cos().matrix().asDiagonal();
    b.leftCols(k) += frame.middleCols(k, k) * truth.array().sin().matrix().asDiagonal();
    b.rightCols(l - k) = frame.middleCols(2 * k, l - k);
    const Eigen::VectorXd angles = principal_angles(a, b);
    EXPECT_LT((angles - truth).cwiseAbs().maxCoeff(), 1e-12) << trial;
    EXPECT_LT((principal_angles(b, a) - angles).cwiseAbs().maxCoeff(), 1e-12) << trial;
    const Eigen::MatrixXd turned = b * orthonormal(l, l, rng);  // other axes of the same span
    EXPECT_LT((principal_angles(a, turned) - angles).cwiseAbs().maxCoeff(), 1e-12) << trial;
    EXPECT_NEAR(subspace_distance(angles, k, l), subspace_distance(angles, l, k), 1e-15) << trial;
  }
}

TEST(PrincipalAngles, RefusesWhatIsNoBasis) {
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(3, 2);
  EXPECT_THROW(principal_angles(identity, 2.0 * identity), std::invalid_argument);
  EXPECT_THROW(principal_angles(identity, Eigen::MatrixXd::Identity(4, 2)), std::invalid_argument);
  EXPECT_THROW(principal_angles(identity, Eigen::MatrixXd(3, 0)), std::invalid_argument);
}

TEST(SubspaceDistance, CountsMissingDimensionsAsRightAngles) {
  EXPECT_DOUBLE_EQ(subspace_distance(Eigen::Vector2d(0.3, 0.4), 2, 2), 0.5);
  EXPECT_DOUBLE_EQ(subspace_distance(Eigen::VectorXd::Zero(1), 1, 2), std::numbers::pi / 2);
}

TEST(Compare, EqualGroupsAreAtDistanceZeroWhateverTheScale) {
  Rng rng = stream(41, "compare");
  const Eigen::MatrixXd samples = test::normal_matrix(400, 5, rng) * test::normal_matrix(5, 5, rng);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(5);
  const SynergyGroup a = learnt("cup", samples, ones);
  const SynergyComparison same = compare(a, a, 0.01).value();
  EXPECT_NEAR(same.distance, 0.0, 1e-12);
  EXPECT_NEAR(same.bhattacharyya.value(), 0.0, 1e-12);
  EXPECT_GE(same.shared_a, 0.95);  // beta
  EXPECT_DOUBLE_EQ(same.shared_a, same.shared_b);
  EXPECT_EQ(same.k_a, a.box.axes.cols());
  // Learnt in joint-range units the normal distribution is the same in radians; the kept span need not be.
  const SynergyComparison rescaled =
      compare(a, learnt("cup", samples, Eigen::VectorXd::LinSpaced(5, 0.5, 2.0)), 0.01).value();
  EXPECT_NEAR(rescaled.bhattacharyya.value(), 0.0, 1e-10);
}

TEST(Compare, IsTheBhattacharyyaDistanceAndLikenessOfTheSamples) {
  Rng rng = stream(42, "compare samples");
  const Eigen::MatrixXd one = test::normal_matrix(300, 4, rng) * test::normal_matrix(4, 4, rng);
  const Eigen::MatrixXd other = (test::normal_matrix(300, 4, rng) * test::normal_matrix(4, 4, rng)).array() + 0.3;
  const Eigen::VectorXd scale = Eigen::VectorXd::LinSpaced(4, 0.5, 2.0);
  const SynergyComparison found = compare(learnt("a", one, scale), learnt("a", other, scale), 0.1).value();
  EXPECT_NEAR(found.bhattacharyya.value(), bhattacharyya_distance(moments(one), moments(other), 0.01).value(), 1e-10);
  EXPECT_NEAR(found.log_likeness.value(), log_likeness(moments(one), moments(other), 0.01).value(), 1e-10);
  EXPECT_GT(found.distance, 0.0);
  EXPECT_LT(found.shared_a, 1.0);
}

TEST(Compare, SetsByGroupName) {
  Rng rng = stream(43, "compare sets");
  const auto samples = [&] { return Eigen::MatrixXd(test::normal_matrix(100, 3, rng)); };
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(3);
  SynergySet a;
  a.joint_names = {"x", "y", "z"};
  a.pre_grasp = learnt("pre-grasp", samples(), ones);
  a.grasp = {learnt("cup", samples(), ones), learnt("pen", samples(), ones)};
  SynergySet b = a;
  b.grasp = {learnt("pen", samples(), ones), learnt("tape", samples(), ones)};
  const auto found = compare(a, b, 0.01).value();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].group, "pre-grasp");
  EXPECT_EQ(found[1].group, "pen");
  b.joint_names = {"x", "z", "y"};
  EXPECT_EQ(compare(a, b, 0.01).error().code, FailureCode::invalid_input);
  b = a;
  b.order = 1;
  EXPECT_EQ(compare(a, b, 0.01).error().code, FailureCode::invalid_input);
  SynergySet velocities = a;
  velocities.order = 1;
  EXPECT_EQ(compare(velocities, velocities, 0.01).value().at(0).bhattacharyya, std::nullopt);
  b = a;
  b.pre_grasp.phase = "all";
  b.grasp = {learnt("tape", samples(), ones)};
  EXPECT_EQ(compare(a, b, 0.01).error().code, FailureCode::not_found);
}

TEST(Compare, AJointThatNeverMovesNeedsTheRidge) {
  Rng rng = stream(44, "compare constant");
  Eigen::MatrixXd samples = test::normal_matrix(100, 3, rng);
  samples.col(1).setConstant(0.7);
  const SynergyGroup group = learnt("cup", samples, Eigen::VectorXd::Ones(3));
  EXPECT_TRUE(compare(group, group, 0.01).has_value());
  EXPECT_EQ(compare(group, group, 0.0).error().code, FailureCode::degenerate);
}

}  // namespace
}  // namespace opponens::analysis
