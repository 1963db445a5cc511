// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/human_likeness.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/statistics.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

const LikenessReference kReference{"test", Eigen::Vector2d(4.0, 1.0).asDiagonal()};

Eigen::MatrixXd path(std::initializer_list<Eigen::RowVector2d> points) {
  Eigen::MatrixXd q(static_cast<Eigen::Index>(points.size()), 2);
  Eigen::Index row = 0;
  for (const auto& point : points) q.row(row++) = point;
  return q;
}

TEST(HumanLikeness, HandComputed) {
  EXPECT_NEAR(*human_likeness(path({{0, 0}, {3, 0}}), kReference), 100.0, 1e-12);
  EXPECT_NEAR(*human_likeness(path({{0, 0}, {0, -2}}), kReference), 50.0, 1e-12);
  EXPECT_NEAR(*human_likeness(path({{0, 0}, {3, 0}, {3, 1}}), kReference), (3 * 100.0 + 50.0) / 4.0, 1e-12);
  EXPECT_NEAR(*human_likeness(path({{0, 0}, {1, 1}}), kReference), 100.0 * std::sqrt(5.0 / 2.0) / 2.0, 1e-12);
}

TEST(HumanLikeness, FreeMotionsOfAnyOrderAreTheReference) {
  Rng rng = stream(12, "free");
  std::vector<Demonstration> recordings;
  for (int i = 0; i < 4; ++i) {
    recordings.push_back(test::recording(std::to_string(i), test::normal_matrix(30, 2, rng)));
    recordings.back().labels["kind"] = i == 1 ? "grasp" : "free";
  }
  const LikenessReference found =
      free_motion_reference({&recordings[0], &recordings[1], &recordings[2], &recordings[3]}).value();
  EXPECT_EQ(found.name, "free finger motions");
  Eigen::MatrixXd free(90, 2);
  free << recordings[0].q_h, recordings[2].q_h, recordings[3].q_h;
  EXPECT_TRUE(found.covariance.isApprox(moments(free).covariance, 1e-12));
  recordings[3].origin = Origin::simulated;
  const LikenessReference other = free_motion_reference({&recordings[3], &recordings[0], &recordings[2]}).value();
  EXPECT_EQ(other.name, "free finger motions (simulated)");
  EXPECT_TRUE(other.covariance == found.covariance);
  EXPECT_FALSE(free_motion_reference({&recordings[1]}));
}

TEST(HumanLikeness, Null) {
  EXPECT_FALSE(human_likeness(path({{1, 1}, {1, 1}}), kReference));
  EXPECT_FALSE(human_likeness(path({{1, 1}}), kReference));
  EXPECT_FALSE(human_likeness(path({{0, 0}, {1, 1}}), {"empty", Eigen::Matrix2d::Zero()}));
  EXPECT_THROW((void)human_likeness(Eigen::MatrixXd::Zero(3, 3), kReference), std::invalid_argument);
}

TEST(HumanLikeness, BoundedAndUnchangedBySubdivisionReversalAndScale) {
  for (int trial = 0; trial < 100; ++trial) {
    Rng rng = test::numbered_stream(11, "hl/", trial);
    const LikenessReference reference{"random", moments(test::normal_matrix(50, 5, rng)).covariance};
    const Eigen::MatrixXd q = test::normal_matrix(6, 5, rng);
    const double value = human_likeness(q, reference).value();
    EXPECT_GT(value, 0.0);
    EXPECT_LE(value, 100.0);
    Eigen::MatrixXd fine(11, 5);
    for (int i = 0; i < 6; ++i) fine.row(2 * i) = q.row(i);
    for (int i = 0; i < 5; ++i) fine.row(2 * i + 1) = 0.3 * q.row(i) + 0.7 * q.row(i + 1);
    EXPECT_NEAR(human_likeness(fine, reference).value(), value, 1e-11) << trial;
    EXPECT_NEAR(human_likeness(q.colwise().reverse().eval(), reference).value(), value, 1e-11) << trial;
    const LikenessReference wider{"wider", 9.0 * reference.covariance};
    EXPECT_NEAR(human_likeness(q, wider).value(), value, 1e-11) << trial;
  }
}

}  // namespace
}  // namespace opponens::analysis
