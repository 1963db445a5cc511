// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/close_hand.hpp"

#include <gtest/gtest.h>

#include <set>

#include "allegro.hpp"
#include "analysis/synergy_box.hpp"
#include "grasp/grasp_check.hpp"
#include "recheck.hpp"

namespace opponens::grasp {
namespace {

struct Workbench {
  explicit Workbench(const robot::Scene& given)
      : scene(given),
        target(make_target(scene, "object", 2)),
        surface(hand_surface(test::allegro(), synergies.group.box.center)),
        direction(closing_direction(synergies.group.box, synergies.pre_grasp)),
        closing{test::allegro(), surface, target, synergies.group.box, direction} {}

  robot::Scene scene;
  test::Synergies synergies = test::power_synergies();
  GraspTarget target;
  HandSurface surface;
  Eigen::VectorXd direction;
  ClosingScene closing;
};

/// The object's origin in front of the root of the fingers, these half closed.
HandPose before_the_object(const Workbench& bench, double distance) {
  HandPose pose;
  pose.q = test::allegro().clip(bench.synergies.group.box.center - 0.2 * bench.direction);
  pose.X_OH.translation() =
      -(bench.surface.palm_center + Eigen::Vector3d(0.0, 0.0, 0.04) + distance * bench.surface.approach);
  return pose;
}

TEST(ClosingDirection, PointsFromPreGraspToGraspWithUnitLargestJoint) {
  const test::Synergies synergies = test::power_synergies();
  const Eigen::VectorXd v = closing_direction(synergies.group.box, synergies.pre_grasp);
  EXPECT_NEAR(v.cwiseAbs().maxCoeff(), 1.0, 1e-12);
  EXPECT_GT(v.dot(synergies.group.box.center - synergies.pre_grasp.center), 0.0);
  EXPECT_EQ(closing_direction(synergies.group.box, synergies.group.box).norm(), 0.0);
}

TEST(CloseHand, FingersAndPalmTouchABallWithoutEnteringIt) {
  const Workbench bench(test::scene_of(robot::Sphere{0.04}));
  const auto closed = close_hand(bench.closing, before_the_object(bench, 0.045));
  ASSERT_TRUE(closed.has_value());
  EXPECT_TRUE(test::allegro().within_limits(closed->q));
  const std::vector<Contact> contacts = find_contacts(bench.closing, *closed, 0.001, 0.5);
  std::set<std::string> links;
  for (const Contact& contact : contacts) links.insert(contact.link);
  EXPECT_TRUE(links.contains("palm_link"));
  EXPECT_GE(links.size(), 4u);
  for (std::size_t link = 0; link < test::allegro().links().size(); ++link) {
    EXPECT_GT(test::least_distance(test::allegro(), closed->X_OH, closed->q, link, *bench.target.distance), -0.001);
  }
}

TEST(CloseHand, DrawsBackAndOpensWhenItStartsInsideTheObject) {
  const Workbench bench(test::scene_of(robot::Sphere{0.04}));
  HandPose start = before_the_object(bench, 0.03);  // 1 cm too near
  start.q += 0.3 * bench.direction;
  const auto closed = close_hand(bench.closing, start);
  ASSERT_TRUE(closed.has_value());
  const Eigen::Vector3d moved = closed->X_OH.translation() - start.X_OH.translation();
  EXPECT_LT(moved.dot(bench.surface.approach), -0.008);
  const HandPose buried = before_the_object(bench, 0.0);
  EXPECT_FALSE(close_hand(bench.closing, buried).has_value());  // deeper than it may draw back
}

TEST(CloseHand, AFingerThatStartsBesideAnotherStillCloses) {
  const Workbench bench(test::scene_of(robot::Sphere{0.04}));
  HandPose start = before_the_object(bench, 0.06);
  // Index and middle finger lean against each other, nearer than the margin between fingers.
  double lean = 0.0;
  while (lean < 0.4 && self_distance(bench.closing, start, 0.01) > 0.0008) {
    lean += 0.002;
    start.q[0] = lean;
    start.q[4] = -lean;
  }
  if (self_distance(bench.closing, start, 0.01) > 0.0008) {
    lean = 0.0;
    while (lean < 0.4 && self_distance(bench.closing, start, 0.01) > 0.0008) {
      lean += 0.002;
      start.q[0] = -lean;
      start.q[4] = lean;
    }
  }
  ASSERT_LT(self_distance(bench.closing, start, 0.01), 0.0008);
  ASSERT_GT(self_distance(bench.closing, start, 0.01), 0.0);
  const auto closed = close_hand(bench.closing, start);
  ASSERT_TRUE(closed.has_value());
  std::set<std::string> links;
  for (const Contact& contact : find_contacts(bench.closing, *closed, 0.001, 0.5)) links.insert(contact.link);
  EXPECT_GE(links.size(), 3u);
  EXPECT_GT(self_distance(bench.closing, *closed, 0.01), 0.0);
}

TEST(CloseHand, FingersStopShortOfObstacles) {
  // A plate between the fingers and the ball.
  robot::Scene scene = test::scene_of(robot::Sphere{0.04});
  const Workbench free(scene);
  const HandPose start = before_the_object(free, 0.045);
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.translation() = Eigen::Vector3d(0.03, 0.0, 0.0);
  scene.bodies.push_back(
      {"plate", X_WB, {{robot::Box{Eigen::Vector3d(0.004, 0.2, 0.05)}, Eigen::Isometry3d::Identity()}}});
  const Workbench blocked(scene);
  ASSERT_GT(obstacle_distance(blocked.closing, start, 0.01), 0.003);
  const auto touching = close_hand(free.closing, start);
  const auto stopped = close_hand(blocked.closing, start);
  ASSERT_TRUE(touching.has_value() && stopped.has_value());
  EXPECT_LT(obstacle_distance(blocked.closing, *touching, 0.01), 0.0);  // without the plate they go through its place
  EXPECT_GT(obstacle_distance(blocked.closing, *stopped, 0.01), 0.0);
}

TEST(GraspCheck, NamesTheFault) {
  const Workbench bench(test::with_table(test::scene_of(robot::Sphere{0.04}), -0.3));
  const HandCheckers checkers = hand_checkers(test::allegro(), bench.scene, "object");
  const HandPose clear = before_the_object(bench, 0.2);
  GraspLimits limits{std::vector<bool>(test::allegro().links().size(), true), 0.001, 0.01};
  EXPECT_EQ(posture_fault(bench.closing, checkers, clear, limits), "");
  EXPECT_EQ(posture_fault(bench.closing, checkers, before_the_object(bench, 0.03), limits), "penetrates the object");
  HandPose low = clear;
  low.X_OH.translation().z() = -0.29;
  EXPECT_EQ(posture_fault(bench.closing, checkers, low, limits), "too near to an obstacle: table");
  HandPose fist = clear;
  fist.q = test::allegro().upper();
  EXPECT_EQ(posture_fault(bench.closing, checkers, fist, limits).rfind("hand in collision: link_", 0), 0U);
  // A link may touch only when it has a contact.
  const auto touch = close_hand(bench.closing, before_the_object(bench, 0.045));
  ASSERT_TRUE(touch.has_value());
  EXPECT_EQ(posture_fault(bench.closing, checkers, *touch, limits), "");
  limits.touching.assign(limits.touching.size(), false);
  EXPECT_EQ(posture_fault(bench.closing, checkers, *touch, limits), "penetrates the object");
}

TEST(GraspCheck, ObjectEdgesBetweenHandSamplesAreSeen) {
  // A thin blade pressed 3 mm into the palm: few of the hand's own points are inside it.
  const Workbench bench(test::scene_of(robot::Box{Eigen::Vector3d(0.08, 0.0008, 0.0008)}));
  HandPose pose = before_the_object(bench, 0.0);
  pose.X_OH.translation() = -(bench.surface.palm_center + (0.04 - 0.003) * bench.surface.approach);
  pose.X_OH.translation().y() += 0.0011;
  const std::vector<double> distances = object_link_distances(bench.closing, pose, 0.01);
  EXPECT_NEAR(*std::min_element(distances.begin(), distances.end()), -0.003, 0.0003);
}

}  // namespace
}  // namespace opponens::grasp
