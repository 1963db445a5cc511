// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/likeness.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "analysis/statistics.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

SampleStatistics gaussian(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance) {
  return {1.0, mean, covariance};
}

double density(const Eigen::VectorXd& x, const SampleStatistics& s) {
  const Eigen::VectorXd d = x - s.mean;
  const double norm = std::pow(2.0 * std::numbers::pi, static_cast<double>(x.size())) * s.covariance.determinant();
  return std::exp(-0.5 * d.dot(s.covariance.inverse() * d)) / std::sqrt(norm);
}

/// Integral over [-12, 12]^2 of f by the trapezoidal rule, which converges exponentially for such functions.
template <typename F>
double integral(F&& f) {
  const double step = 0.05;
  double sum = 0.0;
  for (double x = -12; x <= 12; x += step) {
    for (double y = -12; y <= 12; y += step) sum += f(Eigen::Vector2d(x, y));
  }
  return sum * step * step;
}

struct Pair {
  SampleStatistics a;
  SampleStatistics b;
};

Pair planar_pair() {
  Eigen::Matrix2d first;
  first << 1.0, 0.3, 0.3, 0.5;
  Eigen::Matrix2d second;
  second << 0.4, -0.1, -0.1, 0.9;
  return {gaussian(Eigen::Vector2d(0.5, -0.2), first), gaussian(Eigen::Vector2d(-0.4, 0.6), second)};
}

TEST(Likeness, IsTheOverlapIntegral) {
  const Pair pair = planar_pair();
  const double overlap = integral([&](const Eigen::Vector2d& x) { return density(x, pair.a) * density(x, pair.b); });
  EXPECT_NEAR(log_likeness(pair.a, pair.b, 0.0).value(), std::log(overlap), 1e-12);
}

TEST(Likeness, ClosedFormInOneDimension) {
  const auto a = gaussian(Eigen::VectorXd::Constant(1, 1.0), Eigen::MatrixXd::Constant(1, 1, 0.3));
  const auto b = gaussian(Eigen::VectorXd::Constant(1, 3.0), Eigen::MatrixXd::Constant(1, 1, 0.5));
  const double s = 0.3 + 0.5 + 0.2;  // with a ridge of 0.2
  EXPECT_NEAR(log_likeness(a, b, 0.2).value(), -0.5 * 4.0 / s - 0.5 * std::log(2 * std::numbers::pi * s), 1e-14);
}

TEST(Likeness, PrintedNormaliserDiffersByAConstant) {
  const Pair pair = planar_pair();
  const double constant = -0.5 * 3.0 * std::log(2.0 * std::numbers::pi);  // (1 + 2n - n)/2 with n = 2
  EXPECT_NEAR(
      log_likeness(pair.a, pair.b, 0.0, Normaliser::printed).value() - log_likeness(pair.a, pair.b, 0.0).value(),
      constant, 1e-13);
  EXPECT_NEAR(
      log_likeness(pair.a, pair.a, 0.0, Normaliser::printed).value() - log_likeness(pair.a, pair.a, 0.0).value(),
      constant, 1e-13);
}

TEST(Likeness, DoesNotOverflowInManyDimensions) {
  // The density's normaliser itself, 1e-9^(-200), is not a double.
  const auto a = gaussian(Eigen::VectorXd::Zero(200), 1e-18 * Eigen::MatrixXd::Identity(200, 200));
  EXPECT_NEAR(log_likeness(a, a, 0.0).value(), -100.0 * std::log(2e-18) - 100.0 * std::log(2 * std::numbers::pi), 1e-9);
}

TEST(Likeness, SingularIsAFailureAndARidgeMendsIt) {
  const auto flat = gaussian(Eigen::Vector2d::Zero(), Eigen::Vector2d(1.0, 0.0).asDiagonal());
  const auto result = log_likeness(flat, flat, 0.0);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, FailureCode::degenerate);
  EXPECT_TRUE(log_likeness(flat, flat, 1e-6));
  EXPECT_THROW((void)log_likeness(flat, gaussian(Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()), 0.0),
               std::invalid_argument);
  EXPECT_THROW((void)log_likeness(flat, flat, -1.0), std::invalid_argument);
}

TEST(Bhattacharyya, IsTheIntegralOfTheRoot) {
  const Pair pair = planar_pair();
  const double coefficient =
      integral([&](const Eigen::Vector2d& x) { return std::sqrt(density(x, pair.a) * density(x, pair.b)); });
  EXPECT_NEAR(bhattacharyya_coefficient(pair.a, pair.b, 0.0).value(), coefficient, 1e-12);
  EXPECT_NEAR(bhattacharyya_distance(pair.a, pair.b, 0.0).value(), -std::log(coefficient), 1e-12);
}

TEST(Bhattacharyya, BoundedAndOneForEqualSets) {
  const Pair pair = planar_pair();
  EXPECT_NEAR(bhattacharyya_coefficient(pair.a, pair.a, 0.0).value(), 1.0, 1e-14);
  for (int trial = 0; trial < 100; ++trial) {
    Rng rng = test::numbered_stream(6, "bounded/", trial);
    const auto a = moments(test::normal_matrix(30, 4, rng));
    const auto b = moments(test::normal_matrix(30, 4, rng) * rng.uniform(0.1, 3.0));
    const double ab = bhattacharyya_coefficient(a, b, 0.0).value();
    EXPECT_GT(ab, 0.0) << trial;
    EXPECT_LE(ab, 1.0) << trial;
    EXPECT_DOUBLE_EQ(ab, bhattacharyya_coefficient(b, a, 0.0).value()) << trial;
  }
}

}  // namespace
}  // namespace opponens::analysis
