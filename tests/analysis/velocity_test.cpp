// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/velocity.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/math/distributions/chi_squared.hpp>

#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

Eigen::VectorXd uneven_time(int samples, Rng& rng) {
  Eigen::VectorXd time(samples);
  double t = rng.uniform(-5.0, 5.0);
  for (double& entry : time) entry = t += rng.uniform(0.004, 0.04);
  return time;
}

TEST(JointVelocities, ExactForParabolasAtAnySpacing) {
  for (int trial = 0; trial < 50; ++trial) {
    Rng rng = test::numbered_stream(45, "parabola/", trial);
    const int samples = 3 + static_cast<int>(rng.index(30));
    const Eigen::VectorXd time = uneven_time(samples, rng);
    Eigen::MatrixXd q(samples, 2);
    q.col(0) = 0.3 - 1.2 * time.array() + 0.7 * time.array().square();
    q.col(1) = 2.0 * time.array();
    const Eigen::MatrixXd v = joint_velocities(time, q);
    EXPECT_LT((v.col(0).array() - (-1.2 + 1.4 * time.array())).abs().maxCoeff(), 1e-9) << trial;
    EXPECT_LT((v.col(1).array() - 2.0).abs().maxCoeff(), 1e-9) << trial;
  }
}

TEST(JointVelocities, ErrorFallsWithTheSquareOfTheSpacing) {
  const auto error = [](int samples) {
    const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(samples, 0.0, 2.0);
    const Eigen::MatrixXd q = time.array().sin();
    return (joint_velocities(time, q).col(0).array() - time.array().cos()).abs().maxCoeff();
  };
  EXPECT_NEAR(error(101) / error(201), 4.0, 0.2);
}

TEST(JointVelocities, TwoSamplesGiveALine) {
  const Eigen::MatrixXd v = joint_velocities(Eigen::Vector2d(1.0, 1.5), Eigen::Vector2d(0.0, 1.0));
  EXPECT_DOUBLE_EQ(v(0, 0), 2.0);
  EXPECT_DOUBLE_EQ(v(1, 0), 2.0);
}

TEST(JointVelocities, RefusesTimeThatDoesNotIncrease) {
  const Eigen::MatrixXd q = Eigen::MatrixXd::Zero(3, 1);
  EXPECT_THROW(joint_velocities(Eigen::Vector3d(0, 1, 1), q), std::invalid_argument);
  EXPECT_THROW(joint_velocities(Eigen::Vector3d(0, NAN, 1), q), std::invalid_argument);
  EXPECT_THROW(joint_velocities(Eigen::Vector2d(0, 1), q), std::invalid_argument);
  EXPECT_THROW(joint_velocities(Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Zero(1, 1)), std::invalid_argument);
}

TEST(VelocityNoiseGain, IsTheSpreadThatNoiseGives) {
  // Null: every third slope of white unit noise shares no sample with another, so the sum of their squares over the
  // variance is chi-squared. Two-sided, false-alarm rate 1e-4. The companion, a forward difference's gain, must fail.
  Rng rng = stream(46, "noise gain");
  constexpr int kSlopes = 100000;
  constexpr int kSamples = 3 * kSlopes;
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(kSamples, 0.0, 0.02 * (kSamples - 1));
  const Eigen::MatrixXd v = joint_velocities(time, test::normal_matrix(kSamples, 1, rng));
  double sum = 0.0;
  for (int i = 1; i < kSamples; i += 3) sum += v(i, 0) * v(i, 0);
  const auto accepted = [&](double gain) {
    const double p = boost::math::cdf(boost::math::chi_squared(kSlopes), sum / (gain * gain));
    return p > 0.5e-4 && p < 1.0 - 0.5e-4;
  };
  EXPECT_TRUE(accepted(velocity_noise_gain(time)));
  EXPECT_FALSE(accepted(std::sqrt(2.0) / 0.02));
}

}  // namespace
}  // namespace opponens::analysis
