// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/origin_ball.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.hpp"
#include "grasp/min_norm_point.hpp"
#include "grasp/quality.hpp"
#include "grasp/wrench_hull.hpp"
#include "random_contacts.hpp"

namespace opponens::grasp {
namespace {

Matrix6Xd cube() {
  Matrix6Xd w(6, 64);
  for (int j = 0; j < 64; ++j) {
    for (int i = 0; i < 6; ++i) w(i, j) = (j >> i) & 1 ? 1.0 : -1.0;
  }
  return w;
}

OriginBall l1_ball(const Matrix6Xd& w) { return largest_origin_ball(WrenchSpace(w, 1, WrenchNorm::l1)); }

TEST(OriginBall, CrossPolytopeByHand) {
  const OriginBall ball = l1_ball(test::cross_polytope());
  EXPECT_TRUE(ball.inside);
  EXPECT_NEAR(ball.radius, 1.0 / std::sqrt(6.0), 1e-14);
  EXPECT_TRUE(ball.converged);
}

TEST(OriginBall, CubeWithSixteenPointsOnEachFacet) {
  // Twelve facets with 32 coplanar vertices each, and every vertex three times.
  Matrix6Xd w(6, 192);
  w << cube(), cube(), cube();
  const OriginBall ball = l1_ball(w);
  EXPECT_TRUE(ball.inside && ball.converged);
  EXPECT_NEAR(ball.radius, 1.0, 1e-13);
  EXPECT_NEAR(ball.direction.cwiseAbs().maxCoeff(), 1.0, 1e-13);
}

TEST(OriginBall, MinkowskiSumOfSegmentsIsTheCube) {
  const OriginBall ball = largest_origin_ball(WrenchSpace(test::cross_polytope(), 1, WrenchNorm::linf));
  EXPECT_TRUE(ball.inside);
  EXPECT_NEAR(ball.radius, 1.0, 1e-13);
}

TEST(OriginBall, OutsideIsMinusTheDistanceWithTheSeparatingDirection) {
  Matrix6Xd w = test::cross_polytope();
  w.row(2).array() += 2.5;  // nearest point: 1.5 along axis 2
  const OriginBall ball = l1_ball(w);
  EXPECT_FALSE(ball.inside);
  EXPECT_NEAR(ball.radius, -1.5, 1e-12);
  EXPECT_NEAR((ball.direction + Vector6d::Unit(2)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((ball.direction.transpose() * w).maxCoeff(), ball.radius, 1e-12);
}

TEST(OriginBall, OriginOnTheBoundaryIsNotInside) {
  for (const double shift : {1.0, -1.0}) {
    Matrix6Xd vertex = test::cross_polytope();
    vertex.row(4).array() += shift;
    EXPECT_FALSE(l1_ball(vertex).inside);
    EXPECT_NEAR(l1_ball(vertex).radius, 0.0, 1e-12);
    Matrix6Xd facet = cube();
    facet.row(1).array() += shift;
    EXPECT_FALSE(l1_ball(facet).inside);
    EXPECT_NEAR(l1_ball(facet).radius, 0.0, 1e-12);
  }
}

TEST(OriginBall, MinNormPointOfASegment) {
  Matrix6Xd w = Matrix6Xd::Zero(6, 2);
  w.col(0) << 1, 1, 0, 0, 0, 0;
  w.col(1) << 1, -3, 0, 0, 0, 0;
  const MinNormPoint nearest = min_norm_point(WrenchSpace(w, 1, WrenchNorm::l1));
  EXPECT_NEAR((nearest.point - Vector6d::Unit(0)).norm(), 0.0, 1e-14);
  EXPECT_EQ(nearest.corral.cols(), 2);
}

// Property: rotating all wrenches changes nothing.
TEST(OriginBall, InvariantUnderRotationOfTheObject) {
  Rng rng = stream(11, "rotation");
  for (int i = 0; i < 200; ++i) {
    QualityConvention convention;
    const Matrix6Xd w = contact_wrenches(test::random_contacts(5, 0.3, rng), convention);
    const Eigen::Matrix3d R = Eigen::AngleAxisd(rng.uniform(0, 3), test::random_unit(rng)).toRotationMatrix();
    Matrix6Xd turned(6, w.cols());
    turned << R * w.topRows(3), R * w.bottomRows(3);
    EXPECT_NEAR(l1_ball(w).radius, l1_ball(turned).radius, 1e-12) << "set " << i;
  }
}

// An incumbent ends the search exactly when it is better, and mostly long before the radius is known.
TEST(OriginBall, GivesUpBelowAnIncumbent) {
  Rng rng = stream(14, "incumbent");
  int inside = 0;
  std::int64_t facets = 0;
  std::int64_t facets_until_given_up = 0;
  for (int i = 0; i < 200; ++i) {
    const WrenchNorm norm = i % 10 == 0 ? WrenchNorm::linf : WrenchNorm::l1;
    const WrenchSpace space(contact_wrenches(test::random_contacts(5, 0.3, rng), {}), 8, norm);
    const OriginBall ball = largest_origin_ball(space);
    if (!ball.inside) continue;
    ++inside;
    const OriginBall better = largest_origin_ball(space, {.at_least = 0.999 * ball.radius});
    EXPECT_FALSE(better.below);
    EXPECT_EQ(better.radius, ball.radius) << "set " << i;
    const OriginBall worse = largest_origin_ball(space, {.at_least = 1.2 * ball.radius});
    EXPECT_TRUE(worse.below);
    EXPECT_FALSE(worse.inside);
    EXPECT_LT(worse.upper, 1.2 * ball.radius);
    EXPECT_NEAR(worse.direction.dot(space.support(worse.direction)), worse.upper, 1e-9) << "set " << i;
    facets += ball.facets;
    facets_until_given_up += worse.facets;
  }
  EXPECT_GT(inside, 50);
  EXPECT_LT(3 * facets_until_given_up, facets);
}

// Two methods agree: the growing polytope against qhull's whole hull.
TEST(OriginBall, EqualsQhullOnRandomForceClosureSets) {
  Rng rng = stream(12, "qhull");
  int closures = 0;
  double largest = 0.0;
  while (closures < 300) {
    QualityConvention convention;
    convention.edges = 3 + static_cast<int>(rng.index(6));
    const Matrix6Xd w =
        contact_wrenches(test::random_contacts(3 + static_cast<int>(rng.index(4)), 0.4, rng), convention);
    const OriginBall ball = l1_ball(w);
    ASSERT_TRUE(ball.converged);
    if (!ball.inside) continue;
    ++closures;
    const auto hull = wrench_hull(w);
    ASSERT_TRUE(hull.has_value());
    EXPECT_NEAR(ball.radius, hull->least_offset, 1e-9);
    EXPECT_NEAR((ball.direction.transpose() * w).maxCoeff(), ball.radius, 1e-9);
    largest = std::max(largest, ball.radius);
  }
  EXPECT_GT(largest, 0.1);  // not all trivially small
}

// The same for sums of contacts, and for tangled symmetric sets.
TEST(OriginBall, EqualsQhullOnMinkowskiSumsAndSymmetricSets) {
  Rng rng = stream(13, "minkowski");
  for (int i = 0; i < 20; ++i) {
    QualityConvention convention;
    convention.edges = 4;
    const Matrix6Xd w = contact_wrenches(test::random_contacts(3, 0.2, rng), convention);
    const WrenchSpace space(w, 4, WrenchNorm::linf);
    const OriginBall ball = largest_origin_ball(space);
    const auto hull = wrench_hull(space.points(1000));
    ASSERT_TRUE(hull.has_value());
    if (ball.inside) {
      EXPECT_NEAR(ball.radius, hull->least_offset, 1e-9);
    }
  }
  for (int contacts = 3; contacts <= 12; ++contacts) {
    std::vector<Contact> ring;
    for (int i = 0; i < contacts; ++i) {
      const double angle = 2.0 * M_PI * i / contacts;
      const Eigen::Vector3d p(std::cos(angle), std::sin(angle), 0.0);
      ring.push_back({"ring", p, -p, 0.5});
    }
    const Matrix6Xd w = contact_wrenches(ring, {});
    EXPECT_NEAR(l1_ball(w).radius, wrench_hull(w)->least_offset, 1e-9) << contacts;
  }
}

}  // namespace
}  // namespace opponens::grasp
