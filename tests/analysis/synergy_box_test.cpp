// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/synergy_box.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

TEST(BoxHalfWidth, KnownQuantiles) {
  // One axis: the two-sided 95 % quantile of a standard normal, 1.959963984540054 (any table).
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  EXPECT_NEAR(box_half_width(one, 0.05, BoxRoot::n, 1, 1)[0], 1.959963984540054, 1e-12);
  // The printed root is right for n = 2 only.
  const Eigen::VectorXd two = Eigen::Vector2d(4.0, 1.0);
  EXPECT_TRUE(box_half_width(two, 0.05, BoxRoot::n, 2, 1) == box_half_width(two, 0.05, BoxRoot::literal, 2, 1));
  EXPECT_NEAR(
      box_half_width(two, 0.05, BoxRoot::literal, 2, 2)[0] / box_half_width(two, 0.05, BoxRoot::literal, 2, 2)[1], 2.0,
      1e-14);
  // The defining equation: erf(h / (sqrt(2) sigma)) is the root.
  for (const BoxRoot root : {BoxRoot::n, BoxRoot::k, BoxRoot::literal}) {
    const double h = box_half_width(one, 0.05, root, 16, 5)[0];
    EXPECT_NEAR(std::erf(h / std::sqrt(2.0)), axis_probability(0.05, root, 16, 5), 1e-14);
  }
  EXPECT_NEAR(std::pow(axis_probability(0.05, BoxRoot::k, 16, 5), 5), 0.95, 1e-14);
}

TEST(BoxHalfWidth, BrokenContracts) {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  EXPECT_THROW(box_half_width(one, 0.0, BoxRoot::n, 1, 1), std::invalid_argument);
  EXPECT_THROW(box_half_width(one, 5.0, BoxRoot::n, 1, 1), std::invalid_argument);
  EXPECT_THROW(box_half_width(one, 0.05, BoxRoot::n, 0, 1), std::invalid_argument);
  EXPECT_THROW(box_half_width(-one, 0.05, BoxRoot::n, 1, 1), std::invalid_argument);
}

TEST(SynergiesNeeded, SmallestThatReaches) {
  const Eigen::VectorXd variance = Eigen::Vector4d(70, 25, 4, 1);
  EXPECT_EQ(synergies_needed(variance, 0.30), 1);
  EXPECT_EQ(synergies_needed(variance, 0.29), 2);
  EXPECT_EQ(synergies_needed(variance, 0.05), 2);
  EXPECT_EQ(synergies_needed(variance, 0.049), 3);
  EXPECT_EQ(synergies_needed(variance, 1e-9), 4);
  EXPECT_EQ(synergies_needed(Eigen::Vector3d::Zero(), 0.05), 1);
}

struct Case {
  SynergyBox box;
  Eigen::VectorXd q;
};

Case random_case(int trial) {
  Rng rng = test::numbered_stream(9, "box/", trial);
  const int n = 2 + trial % 15;
  Eigen::VectorXd scale(n);
  for (double& s : scale) s = rng.uniform(0.5, 2.0);
  const Eigen::MatrixXd samples = test::normal_matrix(60, n, rng) * test::normal_matrix(n, n, rng);
  const SynergyBasis basis = principal_axes(scaled(moments(samples), scale));
  const SynergyBox box = make_box(basis, scale, 0.05, rng.uniform(0.01, 0.5), BoxRoot::n, n);
  return {box, Eigen::VectorXd(4.0 * test::normal_matrix(n, 1, rng))};
}

TEST(Project, IdempotentInsideAndNearest) {
  for (int trial = 0; trial < 200; ++trial) {
    const auto [box, q] = random_case(trial);
    const Eigen::VectorXd p = project(box, q);
    EXPECT_TRUE(contains(box, p)) << trial;
    EXPECT_LT((project(box, p) - p).norm(), 1e-12 * (1.0 + p.norm())) << trial;
    // Nearest in scaled space: no point of the box is nearer.
    const double distance = (q - p).cwiseQuotient(box.scale).norm();
    Rng rng = test::numbered_stream(10, "nearest/", trial);
    for (int other = 0; other < 20; ++other) {
      Eigen::VectorXd y(box.half_width.size());
      for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = box.half_width[i] * rng.uniform(-1.0, 1.0);
      EXPECT_LE(distance, (q - configuration(box, y)).cwiseQuotient(box.scale).norm() + 1e-12) << trial;
    }
  }
}

TEST(Coordinates, InverseOfConfiguration) {
  for (int trial = 0; trial < 50; ++trial) {
    const auto [box, q] = random_case(trial);
    const Eigen::VectorXd y = coordinates(box, q);
    EXPECT_LT((coordinates(box, configuration(box, y)) - y).norm(), 1e-11) << trial;
  }
  const auto [box, q] = random_case(3);
  EXPECT_THROW(coordinates(box, Eigen::VectorXd::Zero(q.size() + 1)), std::invalid_argument);
  EXPECT_THROW(configuration(box, Eigen::VectorXd::Zero(99)), std::invalid_argument);
}

TEST(Contains, LooksAtTheKeptCoordinatesOnly) {
  SynergyBox box;
  box.center = Eigen::Vector2d(1, 1);
  box.axes = Eigen::Vector2d(1, 0);
  box.half_width = Eigen::VectorXd::Constant(1, 0.5);
  box.scale = Eigen::Vector2d::Ones();
  EXPECT_TRUE(contains(box, Eigen::Vector2d(1.5, 7)));
  EXPECT_FALSE(contains(box, Eigen::Vector2d(1.51, 1)));
  EXPECT_TRUE(contains(box, Eigen::Vector2d(1.51, 1), 0.02));
  EXPECT_TRUE(project(box, Eigen::Vector2d(3, 7)).isApprox(Eigen::Vector2d(1.5, 1)));
}

TEST(ProductBox, ProjectsEachHandAlone) {
  for (int trial = 0; trial < 50; ++trial) {
    const auto [first, q_first] = random_case(trial);
    const auto [second, q_second] = random_case(trial + 7);
    const SynergyBox both = product_box({first, second});
    Eigen::VectorXd q(q_first.size() + q_second.size());
    q << q_first, q_second;
    const Eigen::VectorXd p = project(both, q);
    EXPECT_LT((p.head(q_first.size()) - project(first, q_first)).norm(), 1e-12 * (1.0 + q.norm())) << trial;
    EXPECT_LT((p.tail(q_second.size()) - project(second, q_second)).norm(), 1e-12 * (1.0 + q.norm())) << trial;
    EXPECT_EQ(contains(both, q), contains(first, q_first) && contains(second, q_second)) << trial;
    const Eigen::MatrixXd gram = both.axes.transpose() * both.axes;
    EXPECT_LT((gram - Eigen::MatrixXd::Identity(gram.rows(), gram.cols())).norm(), 1e-10) << trial;
    EXPECT_NEAR(both.alpha, 1.0 - 0.95 * 0.95, 1e-15);
    EXPECT_EQ(both.beta, std::max(first.beta, second.beta));
  }
}

TEST(ProductBox, OfOneIsThatOne) {
  const auto [box, q] = random_case(3);
  const SynergyBox product = product_box({box});
  EXPECT_EQ(project(product, q), project(box, q));
  EXPECT_EQ(product.alpha, box.alpha);
  EXPECT_THROW(product_box({}), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::analysis
