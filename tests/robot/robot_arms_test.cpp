// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/robot_arms.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "robot/collision.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/load_robot.hpp"
#include "robot/scene.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

const std::string kDual = ours("dual_ur5_allegro/dual_ur5_allegro.yaml");

const RobotDescription& dual() {
  static const RobotDescription description = load_robot(kDual);
  return description;
}

Eigen::VectorXd random_dual_configuration(const RobotModel& model, Rng& rng) {
  Eigen::VectorXd q(model.dof());
  for (int i = 0; i < model.dof(); ++i) q[i] = rng.uniform(model.lower()[i], model.upper()[i]);
  return q;
}

Eigen::Isometry3d pose_of(const RobotModel& model, const Eigen::VectorXd& q, const std::string& link) {
  return model.link_poses(q)[static_cast<std::size_t>(model.link_index(link))];
}

/// Where the model file says that an arm stands.
Eigen::Isometry3d base_of(const std::string& arm) {
  const double side = arm == "right" ? 1.0 : -1.0;
  Eigen::Isometry3d X = at(side * 0.23963021891, 0, -0.01193808329);
  X.linear() = Eigen::AngleAxisd(side * 0.75 * M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return X;
}

double difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

std::set<BodyPair> between_arms(const std::vector<BodyPair>& pairs) {
  std::set<BodyPair> found;
  for (const BodyPair& pair : pairs) {
    if (pair.first.starts_with("left/") && pair.second.starts_with("right/")) found.insert(pair);
  }
  return found;
}

TEST(RobotArms, GroupsOfOneArmAndOfBoth) {
  const RobotModel right(dual());
  EXPECT_EQ(right.dof(), 22);
  EXPECT_EQ(right.joint_names().front(), "right/shoulder_pan_joint");
  ASSERT_EQ(right.arms().size(), 1u);
  EXPECT_EQ(right.arms()[0].name, "right");
  EXPECT_EQ(right.arms()[0].palm, right.link_index("right/palm_link"));

  const RobotModel both(drive_arms(dual(), "both"));
  EXPECT_EQ(both.dof(), 44);
  const std::vector<PlanningGroup> groups = both.groups();
  ASSERT_EQ(groups.size(), 4u);
  const std::vector<std::string> names{"right/arm", "left/arm", "right/hand", "left/hand"};
  const std::vector<int> firsts{0, 6, 12, 28};
  for (std::size_t g = 0; g < 4; ++g) {
    EXPECT_EQ(groups[g].name, names[g]);
    EXPECT_EQ(groups[g].first, firsts[g]);
    EXPECT_EQ(groups[g].count, g < 2 ? 6 : 16);
    for (int i = 0; i < groups[g].count; ++i) {
      EXPECT_EQ(groups[g].joint_names[static_cast<std::size_t>(i)],
                both.joint_names()[static_cast<std::size_t>(groups[g].first + i)]);
    }
  }
  EXPECT_EQ(both.arm().count, 12);
  EXPECT_EQ(both.hand().first, 12);
  EXPECT_EQ(both.hand().count, 32);
  EXPECT_EQ(both.palm(), both.link_index("right/palm_link"));
  EXPECT_EQ(both.arms()[1].palm, both.link_index("left/palm_link"));
  EXPECT_EQ(both.description().tips[4].name, "left/index");
  EXPECT_EQ(both.description().tips[4].finger, "left/index");

  const RobotModel one(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml")));
  ASSERT_EQ(one.arms().size(), 1u);
  EXPECT_EQ(one.arms()[0].name, "");
  ASSERT_EQ(one.groups().size(), 2u);
  EXPECT_EQ(one.groups()[1].name, "hand");
  EXPECT_THROW(drive_arms(dual(), "middle"), std::invalid_argument);
  EXPECT_THROW(drive_arms(one.description(), "right"), std::invalid_argument);
}

/// Each arm moves like the one-arm robot set onto its base, whichever arms are driven.
TEST(RobotArms, EachArmIsTheOneArmRobotMovedToItsBase) {
  const RobotModel single(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml")));
  RobotDescription left_hand = load_hand(ours("ur5_allegro/allegro_left.yaml"));
  const RobotModel left_fingers(left_hand);
  const RobotModel right(drive_arms(dual(), "right"));
  const RobotModel left(drive_arms(dual(), "left"));
  const RobotModel both(drive_arms(dual(), "both"));
  Rng rng(7);
  for (int sample = 0; sample < 50; ++sample) {
    const Eigen::VectorXd q_right = random_dual_configuration(single, rng);
    const Eigen::VectorXd q_left = random_dual_configuration(single, rng);
    Eigen::VectorXd q(44);
    q << q_right.head(6), q_left.head(6), q_right.tail(16), q_left.tail(16);
    for (const Link& link : single.links()) {
      const Eigen::Isometry3d expected = base_of("right") * pose_of(single, q_right, link.name);
      EXPECT_LT(difference(pose_of(right, q_right, "right/" + link.name), expected), 1e-12) << link.name;
      EXPECT_LT(difference(pose_of(both, q, "right/" + link.name), expected), 1e-12) << link.name;
    }
    const Eigen::Isometry3d X_palm = base_of("left") * pose_of(single, q_left, "palm_link");
    EXPECT_LT(difference(pose_of(left, q_left, "left/palm_link"), X_palm), 1e-12);
    for (const Link& link : left_fingers.links()) {
      const Eigen::Isometry3d expected = X_palm * pose_of(left_fingers, q_left.tail(16), link.name);
      EXPECT_LT(difference(pose_of(both, q, "left/" + link.name), expected), 1e-12) << link.name;
    }
  }
}

TEST(RobotArms, ArmThatIsNotDrivenStandsAtItsRest) {
  const RobotModel right(drive_arms(dual(), "right"));
  const RobotModel left(drive_arms(dual(), "left"));
  Rng rng(8);
  const Eigen::Isometry3d expected = pose_of(left, left.rest(), "left/link_3.0_tip");
  for (int sample = 0; sample < 5; ++sample) {
    EXPECT_LT(difference(pose_of(right, random_dual_configuration(right, rng), "left/link_3.0_tip"), expected), 1e-15);
  }
  EXPECT_NEAR(left.rest()[1], -1.9122, 1e-12) << "as the file says";
  EXPECT_NEAR(left.rest()[6 + 12], 0.263, 1e-12) << "not named: the limit nearest to zero";
}

/// Published: with the start configuration of its problem file, the laboratory's two hands point forward over the
/// table, palms facing each other; the file's numbers run through an independent script gave these palm places.
TEST(RobotArms, RestIsThePublishedStart) {
  const RobotModel both(drive_arms(dual(), "both"));
  const Eigen::Isometry3d X_right = pose_of(both, both.rest(), "right/palm_link");
  const Eigen::Isometry3d X_left = pose_of(both, both.rest(), "left/palm_link");
  EXPECT_LT((X_right.translation() - Eigen::Vector3d(0.229, 0.665, -0.450)).norm(), 2e-3) << X_right.translation();
  EXPECT_LT((X_left.translation() - Eigen::Vector3d(-0.322, 0.623, -0.487)).norm(), 2e-3) << X_left.translation();
  EXPECT_LT(X_right.linear()(0, 0), -0.9) << "the right palm looks to the left";
  EXPECT_GT(X_left.linear()(0, 0), 0.9);
  EXPECT_GT(X_right.linear()(1, 2), 0.95) << "fingers point forward";
  EXPECT_GT(X_left.linear()(1, 2), 0.95);
  EXPECT_TRUE(CollisionChecker(both, Scene{}).free(both.rest()));
}

/// Reflection in y = 0 of the palm. A pose is reflected on both sides, so that it stays a rotation.
TEST(RobotArms, LeftHandIsTheMirrorImageOfTheRight) {
  const RobotModel right(load_hand(ours("ur5_allegro/allegro_right.yaml")));
  const RobotModel left(load_hand(ours("ur5_allegro/allegro_left.yaml")));
  ASSERT_EQ(right.joint_names(), left.joint_names());
  EXPECT_EQ(right.lower(), left.lower());
  EXPECT_EQ(right.upper(), left.upper());
  const Eigen::Vector4d mirror(1, -1, 1, 1);
  const auto mirrored = [&](const Eigen::Isometry3d& X) {
    return Eigen::Isometry3d(Eigen::Matrix4d(mirror.asDiagonal() * X.matrix() * mirror.asDiagonal()));
  };
  Rng rng(9);
  for (int sample = 0; sample < 100; ++sample) {
    const Eigen::VectorXd q = random_dual_configuration(right, rng);
    const std::vector<Eigen::Isometry3d> X_right = right.link_poses(q);
    const std::vector<Eigen::Isometry3d> X_left = left.link_poses(q);
    for (std::size_t l = 0; l < right.links().size(); ++l) {
      ASSERT_EQ(right.links()[l].name, left.links()[l].name);
      EXPECT_LT(difference(X_left[l], mirrored(X_right[l])), 1e-12) << right.links()[l].name;
      const auto& shapes = right.links()[l].collision;
      for (std::size_t s = 0; s < shapes.size(); ++s) {  // boxes and spheres on the axes: their poses say it all
        EXPECT_LT(difference(left.links()[l].collision[s].X_BG, mirrored(shapes[s].X_BG)), 1e-12);
      }
    }
    EXPECT_EQ(CollisionChecker(right, Scene{}).free(q), CollisionChecker(left, Scene{}).free(q));
  }
  const auto& points = right.description().contact_points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& other = left.description().contact_points[i];
    EXPECT_LT((other.p_L - mirror.head<3>().cwiseProduct(points[i].p_L)).norm(), 1e-12) << points[i].name;
    EXPECT_LT((other.n_L - mirror.head<3>().cwiseProduct(points[i].n_L)).norm(), 1e-12) << points[i].name;
  }
}

/// The hands are driven into each other in front of the stand, by inverse kinematics of each arm.
TEST(RobotArms, HandsThatMeetCollide) {
  const RobotModel both(drive_arms(dual(), "both"));
  const RobotModel right(drive_arms(dual(), "right"));
  const RobotModel left(drive_arms(dual(), "left"));
  const CollisionChecker checker(both, Scene{});
  const auto reach = [](const RobotModel& arm, Eigen::Isometry3d X_RH, double x) {
    X_RH.translation().x() = x;
    const std::vector<Eigen::VectorXd> solutions =
        make_inverse_kinematics(arm)(X_RH, {}).value_or(std::vector<Eigen::VectorXd>());
    const auto near = std::min_element(solutions.begin(), solutions.end(), [&](const auto& a, const auto& b) {
      return (a - arm.rest().head(6)).norm() < (b - arm.rest().head(6)).norm();
    });
    return near == solutions.end() ? Eigen::VectorXd() : *near;
  };
  Eigen::VectorXd q = both.rest();
  const Eigen::Isometry3d X_right = pose_of(both, q, "right/palm_link");
  const Eigen::Isometry3d X_left = pose_of(both, q, "left/palm_link");
  bool met = false;
  for (const double gap : {0.20, 0.15, 0.10, 0.05, 0.0}) {
    const Eigen::VectorXd q_right = reach(right, X_right, gap);
    const Eigen::VectorXd q_left = reach(left, X_left, -gap);
    ASSERT_EQ(q_right.size(), 6) << gap;
    ASSERT_EQ(q_left.size(), 6) << gap;
    q.head(12) << q_right, q_left;
    const std::set<BodyPair> pairs = between_arms(checker.colliding_pairs(q));
    EXPECT_TRUE(gap < 0.20 || pairs.empty()) << "40 cm between the palms";
    EXPECT_TRUE(gap > 0.0 || pairs.contains({"left/palm_link", "right/palm_link"})) << "one palm in the other";
    met = met || !pairs.empty();
    EXPECT_EQ(met, !pairs.empty()) << "once they meet, they stay met: " << gap;
  }
  // The same with the left arm at rest: the right palm is driven to where the left one stands.
  const Eigen::VectorXd q_arm = reach(right, X_left, X_left.translation().x());
  ASSERT_EQ(q_arm.size(), 6);
  Eigen::VectorXd q_right = right.rest();
  q_right.head(6) = q_arm;
  const std::vector<BodyPair> pairs = CollisionChecker(right, Scene{}).colliding_pairs(q_right);
  EXPECT_TRUE(between_arms(pairs).contains({"left/palm_link", "right/palm_link"}));
}

TEST(RobotArms, ArmsCollideWithTheStand) {
  const RobotModel right(drive_arms(dual(), "right"));
  const CollisionChecker checker(right, Scene{});
  // The hand lowered onto the table: 0.1 m under its rest place, which is 0.16 m above the plate.
  Eigen::Isometry3d X = pose_of(right, right.rest(), "right/palm_link");
  X.translation().z() -= 0.15;
  Eigen::VectorXd q = right.rest();
  const std::vector<Eigen::VectorXd> solutions =
      make_inverse_kinematics(right)(X, {}).value_or(std::vector<Eigen::VectorXd>());
  ASSERT_FALSE(solutions.empty());
  q.head(6) = solutions[0];
  const std::vector<BodyPair> pairs = checker.colliding_pairs(q);
  EXPECT_TRUE(std::any_of(pairs.begin(), pairs.end(), [](const BodyPair& pair) {
    return pair.second == "stand/table" || pair.first == "stand/table";
  }));
}

TEST(RobotArms, NoPairAlwaysCollides) {
  const RobotModel both(drive_arms(dual(), "both"));
  const CollisionChecker checker(both, Scene{});
  Rng rng(31);
  std::map<BodyPair, int> count;
  const int samples = 300;
  for (int sample = 0; sample < samples; ++sample) {
    for (const BodyPair& pair : checker.colliding_pairs(random_dual_configuration(both, rng))) ++count[pair];
  }
  for (const auto& [pair, times] : count) EXPECT_LT(times, samples / 2) << pair.first << " " << pair.second;
}

/// Either arm, or both, can start from the scene's configuration.
TEST(RobotArms, BookshelfSceneIsForBoth) {
  const Scene scene = load_scene(ours("scenes/dual_bookshelf.yaml"));
  const RobotModel both(drive_arms(dual(), "both"));
  Eigen::VectorXd q(both.dof());
  for (int i = 0; i < both.dof(); ++i) {
    const auto found = std::find(scene.start_joints.begin(), scene.start_joints.end(),
                                 both.joint_names()[static_cast<std::size_t>(i)]);
    ASSERT_NE(found, scene.start_joints.end()) << both.joint_names()[static_cast<std::size_t>(i)];
    q[i] = scene.start[found - scene.start_joints.begin()];
  }
  EXPECT_TRUE(both.within_limits(q));
  EXPECT_TRUE(CollisionChecker(both, scene).free(q));
  EXPECT_EQ(q.head(12), both.rest().head(12)) << "what is not driven stands where it would start";
}

/// The hand of a driven arm has its hand.yaml's joint names, so that synergies fit it, and the robot's links.
TEST(RobotArms, HandOfADrivenArm) {
  const RobotDescription hand = hand_of(drive_arms(dual(), "left"));
  const RobotDescription own = load_hand(ours("ur5_allegro/allegro_left.yaml"));
  EXPECT_EQ(hand.hand_joints, own.hand_joints);
  ASSERT_EQ(hand.links.size(), own.links.size());
  EXPECT_EQ(hand.links[0].name, "left/palm_link");
  EXPECT_EQ(hand.allowed_collisions, own.allowed_collisions);
  const RobotModel a(hand);
  const RobotModel b(own);
  const Eigen::VectorXd q = 0.5 * (a.lower() + a.upper());
  for (std::size_t l = 0; l < own.links.size(); ++l)
    EXPECT_LT(difference(a.link_poses(q)[l], b.link_poses(q)[l]), 1e-15);
  EXPECT_THROW(hand_of(drive_arms(dual(), "both")), std::invalid_argument);
}

TEST(RobotArms, ScaledMovesRestingArmsToo) {
  const RobotModel one(dual());
  const RobotModel two(scaled(dual(), 2.0));
  EXPECT_LT((2.0 * pose_of(one, one.rest(), "left/palm_link").translation() -
             pose_of(two, two.rest(), "left/palm_link").translation())
                .norm(),
            1e-12);
  EXPECT_EQ(2.0 * one.description().arms[1].tips[0].p_L, two.description().arms[1].tips[0].p_L);
}

TEST(RobotArms, LaboratorysDualArmRobotLoads) {
  if (!std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) GTEST_SKIP() << "no " OPPONENS_SHARED_DATA;
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  const std::string folder = OPPONENS_SOURCE_DIR "/tests/data/robots/";
  const RobotModel ours_both(drive_arms(dual(), "both"));
  for (const std::string kind : {"urdf", "visual"}) {
    const RobotModel lab(load_robot(folder + "paper_lab_dual_ur5_allegro_" + kind + ".yaml", "both"));
    ASSERT_EQ(lab.dof(), 44);
    std::set<const TriangleMesh*> meshes;
    std::size_t uses = 0;
    for (const Link& link : lab.links()) {
      for (const Geometry& geometry : link.collision) {
        if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&geometry.shape)) {
          meshes.insert(mesh->get());
          ++uses;
        }
      }
    }
    EXPECT_TRUE(kind == "urdf" || meshes.size() + 20 < uses) << "the arms share their meshes";
    // Our model of it: the same palms at the same joint positions, half a turn of the pan joint apart.
    Rng rng(11);
    for (int sample = 0; sample < 20; ++sample) {
      Eigen::VectorXd q = 0.4 * Eigen::VectorXd::Random(44);
      q.head(12) += lab.rest().head(12);
      Eigen::VectorXd q_ours = q;
      q_ours[0] += M_PI;
      q_ours[6] += M_PI;
      for (const std::string arm : {"right", "left"}) {
        EXPECT_LT(difference(pose_of(lab, q, arm + "/Palm"), pose_of(ours_both, q_ours, arm + "/palm_link")), 1e-6);
      }
    }
    const std::vector<BodyPair> pairs = CollisionChecker(lab, Scene{}).colliding_pairs(lab.rest());
    EXPECT_TRUE(between_arms(pairs).empty());
    for (const BodyPair& pair : pairs) ADD_FAILURE() << kind << ": " << pair.first << " " << pair.second;
  }
}

}  // namespace
}  // namespace opponens::robot
