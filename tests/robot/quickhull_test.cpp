// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/quickhull.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace opponens::robot {
namespace {

/// The corners of a box [0, 1]^d moved by -0.25, with its middle as the first column.
Eigen::MatrixXd box(Eigen::Index d) {
  Eigen::MatrixXd points = Eigen::MatrixXd::Constant(d, (Eigen::Index{1} << d) + 1, 0.25);
  for (Eigen::Index i = 1; i < points.cols(); ++i) {
    for (Eigen::Index k = 0; k < d; ++k) points(k, i) = (((i - 1) >> k) & 1) != 0 ? 0.75 : -0.25;
  }
  return points;
}

TEST(Quickhull, OfABoxOfAnyDimension) {
  for (const Eigen::Index d : {2, 3, 6}) {
    auto hull = Quickhull::build(box(d), "Qt");
    ASSERT_TRUE(hull) << d;
    std::vector<Eigen::Index> columns = hull->vertices();
    std::sort(columns.begin(), columns.end());
    EXPECT_EQ(static_cast<Eigen::Index>(columns.size()), Eigen::Index{1} << d);
    EXPECT_EQ(columns.front(), 1) << "the middle is no vertex";
    EXPECT_EQ(std::adjacent_find(columns.begin(), columns.end()), columns.end());
    EXPECT_NEAR(hull->volume(), 1.0, 1e-12);
    EXPECT_NEAR(hull->least_offset(), 0.25, 1e-12);
  }
}

TEST(Quickhull, AnOriginOutsideHasANegativeOffset) {
  const auto hull = Quickhull::build(box(3).array() + 1.0, "Qt");
  ASSERT_TRUE(hull);
  EXPECT_NEAR(hull->least_offset(), -0.75, 1e-12);
}

TEST(Quickhull, WhatIsFlatOrTooFewHasNone) {
  Eigen::MatrixXd flat = box(3);
  flat.row(2).setZero();
  EXPECT_FALSE(Quickhull::build(flat, "Qt"));
  EXPECT_FALSE(Quickhull::build(box(3).leftCols(3), "Qt"));
  EXPECT_FALSE(Quickhull::build(Eigen::MatrixXd(3, 0), "Qt"));
}

}  // namespace
}  // namespace opponens::robot
