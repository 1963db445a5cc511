// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The planner with our UR5 and Allegro hand in front of the bottle shelf.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <set>

#include "core/rng.hpp"
#include "motion/closing_segment.hpp"
#include "motion/edge_check.hpp"
#include "motion/goal_configurations.hpp"
#include "motion/grown_scene.hpp"
#include "motion/joint_metric.hpp"
#include "motion/pair_depth.hpp"
#include "motion/shortcut.hpp"
#include "motion/syn_planner.hpp"
#include "motion/time_optimal.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "robot/mesh_distance.hpp"

namespace opponens::motion {
namespace {

constexpr double kResolution = 0.02;  // rad
const std::filesystem::path kModels = std::filesystem::path(OPPONENS_SOURCE_DIR) / "models";

class RobotWorld : public ::testing::Test {
 protected:
  /// The hand's palm with its fingers' side towards the bottle from in front of the shelf, `back` m away from it.
  Eigen::Isometry3d palm(double back) const {
    Eigen::Isometry3d X_OH = Eigen::Isometry3d::Identity();
    X_OH.linear() = side_rotation_;
    X_OH.translation() = Eigen::Vector3d(-back, 0.0, 0.10);
    return X_OH;
  }
  Eigen::VectorXd start() const {
    Eigen::VectorXd q(robot.dof());
    for (std::size_t j = 0; j < scene.start_joints.size(); ++j) {
      const auto& names = robot.joint_names();
      const auto at = std::find(names.begin(), names.end(), scene.start_joints[j]) - names.begin();
      q[at] = scene.start[static_cast<Eigen::Index>(j)];
    }
    return q;
  }
  Eigen::VectorXd open_hand() const { return start().segment(robot.hand().first, robot.hand().count); }
  SynergyBox wide_box(double width) const {
    const int n = robot.hand().count;
    SynergyBox box;
    box.center = open_hand();
    box.axes = Eigen::MatrixXd::Zero(n, 4);
    for (int j = 0; j < 16; ++j) box.axes(j, j / 4) = 0.5;
    box.half_width = Eigen::VectorXd::Constant(4, width);
    box.scale = Eigen::VectorXd::Ones(n);
    return box;
  }
  /// A grasp without contacts: an open hand near the bottle, all fingers off it.
  Grasp hover(double back) const {
    Grasp grasp;
    grasp.q_grasp = open_hand();
    grasp.q_pregrasp = open_hand();
    grasp.X_OH = palm(back);
    grasp.X_OH_pregrasp = palm(back + 0.03);
    return grasp;
  }
  Eigen::Isometry3d X_RO() const { return scene.X_WR.inverse() * scene.body("bottle").X_WB; }

  robot::RobotModel robot{robot::load_robot(kModels / "ur5_allegro" / "ur5_allegro_right.yaml")};
  robot::Scene scene = robot::load_scene(kModels / "scenes" / "bottle_shelf.yaml");
  robot::CollisionChecker checker{robot, scene};
  robot::InverseKinematics kinematics = robot::make_inverse_kinematics(robot);
  Eigen::Matrix3d side_rotation_ = Eigen::Matrix3d::Identity();

  /// A palm pose in front of the bottle whose pre-grasp the arm reaches without collision: found by turning the palm in
  /// steps, so that the test does not depend on how the hand's frame is laid out.
  std::optional<Grasp> reachable() {
    for (const double back : {0.12, 0.16, 0.2, 0.25}) {
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
          for (int c = 0; c < 4; ++c) {
            side_rotation_ = (Eigen::AngleAxisd(a * std::numbers::pi / 2, Eigen::Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(b * std::numbers::pi / 2, Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(c * std::numbers::pi / 2, Eigen::Vector3d::UnitX()))
                                 .toRotationMatrix();
            Grasp grasp = hover(back);
            if (reach(grasp, robot, kinematics, X_RO(), checker, checker, 0.02).empty()) return grasp;
          }
        }
      }
    }
    return std::nullopt;
  }
};

TEST_F(RobotWorld, ReachGivesValidPairsOfBranches) {
  const auto grasp = reachable();
  ASSERT_TRUE(grasp);
  ASSERT_LE(grasp->arm_solutions.size(), static_cast<std::size_t>(kMaxArmSolutions));
  double last = 0.0;
  for (const ArmSolution& arm : grasp->arm_solutions) {
    const Eigen::VectorXd q_pregrasp = join(robot, arm.q_pregrasp, grasp->q_pregrasp);
    const Eigen::VectorXd q_grasp = join(robot, arm.q_grasp, grasp->q_grasp);
    EXPECT_TRUE(checker.free(q_pregrasp));
    EXPECT_TRUE(checker.free(q_grasp));
    for (const auto& [q, X_OH] : {std::pair(q_pregrasp, grasp->X_OH_pregrasp), std::pair(q_grasp, grasp->X_OH)}) {
      const Eigen::Isometry3d X_RH = robot.link_poses(q)[static_cast<std::size_t>(robot.palm())];
      EXPECT_TRUE(X_RH.isApprox(X_RO() * X_OH, 1e-6));
    }
    const double motion = distance(robot.weights(), q_pregrasp, q_grasp);
    EXPECT_GE(motion, last - 1e-9);
    EXPECT_LT(motion, 1.0) << "another branch";
    last = motion;
  }
}

TEST_F(RobotWorld, ReachSaysWhyNot) {
  auto grasp = reachable();
  ASSERT_TRUE(grasp);
  Grasp far = *grasp;
  far.X_OH.translation().x() -= 5.0;
  EXPECT_EQ(reach(far, robot, kinematics, X_RO(), checker, checker, 0.02), "no inverse kinematics");
  EXPECT_TRUE(far.arm_solutions.empty());
  Grasp inside = *grasp;  // the pre-grasp's palm in the bottle
  inside.X_OH_pregrasp.translation() = Eigen::Vector3d(0, 0, 0.1);
  inside.X_OH.translation() = Eigen::Vector3d(0, 0, 0.1);
  const std::string reason = reach(inside, robot, kinematics, X_RO(), checker, checker, 0.02);
  EXPECT_EQ(reason.rfind("pre-grasp in collision: ", 0), 0U) << reason;
  Grasp through = *grasp;  // from a free pre-grasp into the bottle
  through.X_OH.translation() = Eigen::Vector3d(0, 0, 0.1);
  // Towards the bottle's axis as far as it takes, with nothing but the bottle in the world.
  robot::Scene alone = scene;
  alone.bodies = {scene.body("bottle")};
  const robot::CollisionChecker all(robot, alone);
  const auto why = [&](const robot::CollisionChecker& closing, const ContactLimit& limit) {
    return reach(through, robot, kinematics, X_RO(), all, closing, 0.02, limit);
  };
  std::string closing;
  for (double share = 0.5; share <= 1.0 && closing.empty(); share += 0.05) {
    through.X_OH.translation() = (1.0 - share) * grasp->X_OH.translation() + share * Eigen::Vector3d(0, 0, 0.1);
    closing = why(all, {});
  }
  EXPECT_EQ(closing.rfind("closing segment in collision: ", 0), 0U) << closing;
  EXPECT_NE(closing.find("-bottle"), std::string::npos) << closing;
  EXPECT_TRUE(through.arm_solutions.empty());

  // Every link may touch: then a link without a contact is in the way, and with contacts all over the depth is.
  std::vector<robot::BodyPair> pairs;
  std::vector<std::string> links;
  for (const robot::Link& link : robot.links()) {
    links.push_back(link.name);
    pairs.emplace_back(link.name, "bottle");
  }
  const robot::CollisionChecker touching(robot, alone, pairs);
  const ContactDepth depth(robot, alone, "bottle", links, 0.01);
  const std::string no_contact = why(touching, {&depth});
  EXPECT_EQ(no_contact.rfind("closing segment in collision: ", 0), 0U) << no_contact;
  for (const std::string& link : links) through.contacts.push_back({link, {}, {}, 0.5});
  EXPECT_EQ(why(touching, {&depth}), "closing segment too deep in the object");
  EXPECT_EQ(why(touching, {&depth, 1.0}), "");  // a bound of 1 m
}

TEST_F(RobotWorld, ClosingWorldBoundsTheContactsOfTheGraspAlone) {
  // A small ball before a fingertip that it meets `deep` m deep; everything else is far away.
  const auto& tip = robot.description().tips.front();
  const robot::Link& link = robot.links()[static_cast<std::size_t>(tip.link)];
  const Eigen::VectorXd q = start();
  const Eigen::Isometry3d X_WL = scene.X_WR * robot.link_poses(q)[static_cast<std::size_t>(tip.link)];
  const auto valid = [&](double deep, const std::vector<std::string>& contact_links, bool bounded) -> bool {
    robot::Scene ball = scene;
    const Eigen::Vector3d center = X_WL * tip.p_L + (0.01 - deep) * (X_WL.linear() * tip.n_L);
    ball.bodies = {{"ball", Eigen::Isometry3d(Eigen::Translation3d(center)), {{robot::Sphere{0.01}, {}}}}};
    ball.bodies[0].geometry[0].X_BG.setIdentity();
    const robot::CollisionChecker all(robot, ball);
    const robot::CollisionChecker closing(robot, ball, {{link.name, "ball"}});
    const ContactDepth depth(robot, ball, "ball", {link.name}, 0.0005);
    std::vector<Contact> contacts;
    for (const std::string& name : contact_links) contacts.push_back({name, {}, {}, 0.5});
    std::int64_t checks = 0;
    EXPECT_EQ(all.free(q), deep < 0.0);
    const ContactLimit limit{bounded ? &depth : nullptr, 0.001};
    return closing_world(all, closing, robot, contacts, kResolution, limit).free(q.transpose(), checks).front();
  };
  EXPECT_TRUE(valid(-0.001, {}, true)) << "touches nothing";
  EXPECT_TRUE(valid(0.0005, {link.name}, true)) << "a contact, shallow";
  EXPECT_FALSE(valid(0.002, {link.name}, true)) << "a contact, too deep";
  EXPECT_TRUE(valid(0.002, {link.name}, false)) << "no bound asked for";
  EXPECT_FALSE(valid(0.0005, {}, true)) << "the link has no contact";
  EXPECT_FALSE(valid(0.0005, {"palm"}, true)) << "another link has";
}

TEST_F(RobotWorld, ContactDepthOfAFingertipInTheBottle) {
  auto grasp = reachable();
  ASSERT_TRUE(grasp);
  std::set<std::string> hand;
  for (const auto& point : robot.description().contact_points) {
    hand.insert(robot.links()[static_cast<std::size_t>(point.link)].name);
  }
  const ContactDepth depth(robot, scene, "bottle", {hand.begin(), hand.end()});
  const Eigen::VectorXd clear = join(robot, grasp->arm_solutions[0].q_grasp, grasp->q_grasp);
  EXPECT_EQ(depth(clear), 0.0);
  // The bottle moved so that its axis runs through a tip: the depth is what FCL's truth sees as a collision.
  robot::Scene moved = scene;
  const auto& tip = robot.description().tips.front();
  const Eigen::Vector3d p_W = scene.X_WR * robot.link_poses(clear)[static_cast<std::size_t>(tip.link)] * tip.p_L;
  moved.bodies.front().X_WB.translation() = p_W + Eigen::Vector3d(0.029, 0, -0.06);  // radius 32 mm
  ASSERT_EQ(moved.bodies.front().name, "bottle");
  const ContactDepth touching(robot, moved, "bottle", {robot.links()[static_cast<std::size_t>(tip.link)].name});
  EXPECT_GT(touching(clear), 0.002);
  EXPECT_FALSE(robot::CollisionChecker(robot, moved).free(clear));
}

TEST_F(RobotWorld, ContactDepthOfSeveralHandsIsOfEachWithItsOwnObject) {
  // A ball at each of two fingertips, of different depth there. The links stand for two hands.
  const Eigen::VectorXd q = start();
  robot::Scene balls = scene;
  balls.bodies.clear();
  std::vector<std::string> links;
  for (const auto& [tip, deep] : {std::pair{0U, 0.002}, {1U, 0.004}}) {
    const robot::SurfacePoint& point = robot.description().tips[tip];
    const Eigen::Isometry3d X_WL = scene.X_WR * robot.link_poses(q)[static_cast<std::size_t>(point.link)];
    const Eigen::Vector3d center = X_WL * point.p_L + (0.01 - deep) * (X_WL.linear() * point.n_L);
    balls.bodies.push_back({"ball " + std::to_string(tip), Eigen::Isometry3d(Eigen::Translation3d(center)), {}});
    balls.bodies.back().geometry.push_back({robot::Sphere{0.01}, Eigen::Isometry3d::Identity()});
    links.push_back(robot.links()[static_cast<std::size_t>(point.link)].name);
  }
  const double shallow = ContactDepth(robot, balls, "ball 0", {links[0]}, 0.0005)(q);
  const double deep = ContactDepth(robot, balls, "ball 1", {links[1]}, 0.0005)(q);
  EXPECT_NEAR(shallow, 0.002, 2e-4);
  EXPECT_NEAR(deep, 0.004, 2e-4);
  const auto both = [&](const std::string& first, const std::string& second) {
    return ContactDepth(robot, balls, {{first, {links[0]}}, {second, {links[1]}}}, 0.0005)(q);
  };
  EXPECT_EQ(both("ball 0", "ball 1"), deep);
  EXPECT_EQ(both("ball 0", "ball 0"), shallow);
  EXPECT_EQ(both("ball 1", "ball 0"), 0.0) << "the other's object counts for neither";
}

TEST_F(RobotWorld, ContactDepthIsThatOfTheDeepestSurfacePoint) {
  const auto& tip = robot.description().tips.front();
  const robot::Link& link = robot.links()[static_cast<std::size_t>(tip.link)];
  Rng rng = stream(11, "depth");
  int deep = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::VectorXd q = start() + 0.05 * Eigen::VectorXd::NullaryExpr(robot.dof(), [&] { return rng.normal(); });
    const Eigen::Isometry3d X_WL = scene.X_WR * robot.link_poses(q)[static_cast<std::size_t>(tip.link)];
    const Eigen::Vector3d aside(0.05 * rng.normal(), 0.05 * rng.normal(), 0.05 * rng.normal());
    robot::Scene ball = scene;
    ball.bodies = {
        {"ball", Eigen::Isometry3d(Eigen::Translation3d(X_WL * tip.p_L + aside)), {{robot::Sphere{0.04}, {}}}}};
    ball.bodies[0].geometry[0].X_BG.setIdentity();
    const auto mesh = std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Sphere{0.04}, 64));
    const robot::MeshDistance surface(mesh);
    double expected = 0.0;
    for (const auto& geometry : link.collision) {
      for (const Eigen::Vector3d& p_L : robot::surface_samples(geometry, 0.003)) {
        expected = std::max(expected, -surface.signed_distance(ball.bodies[0].X_WB.inverse() * X_WL * p_L));
      }
    }
    EXPECT_NEAR(ContactDepth(robot, ball, "ball", {link.name})(q), expected, 1e-12);
    deep += expected > 0.001 ? 1 : 0;
  }
  EXPECT_GT(deep, 5);
}

TEST_F(RobotWorld, FirstDeeperFindsWhatDenseSamplesFindAndProvesTheRest) {
  const auto& tip = robot.description().tips.front();
  const robot::Link& link = robot.links()[static_cast<std::size_t>(tip.link)];
  Rng rng = stream(12, "deeper");
  int deeper = 0;
  int shallow = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const auto near = [&] {
      return Eigen::VectorXd(start() + 0.02 * Eigen::VectorXd::NullaryExpr(robot.dof(), [&] { return rng.normal(); }));
    };
    const Eigen::VectorXd q_from = near();
    const Eigen::VectorXd q_to = near();
    // Its surface passes within some millimetres of the fingertip half way.
    const Eigen::VectorXd q_middle = 0.5 * (q_from + q_to);
    const Eigen::Isometry3d X_WL = scene.X_WR * robot.link_poses(q_middle)[static_cast<std::size_t>(tip.link)];
    const Eigen::Vector3d center = X_WL * tip.p_L + (0.03 - rng.uniform(-0.02, 0.006)) * (X_WL.linear() * tip.n_L);
    robot::Scene ball = scene;
    ball.bodies = {{"ball", Eigen::Isometry3d(Eigen::Translation3d(center)), {{robot::Sphere{0.03}, {}}}}};
    ball.bodies[0].geometry[0].X_BG.setIdentity();
    const ContactDepth depth(robot, ball, "ball", {link.name});
    const auto at = [&](double fraction) { return depth(q_from + fraction * (q_to - q_from)); };
    double deepest = 0.0;
    for (int i = 0; i <= 2000; ++i) deepest = std::max(deepest, at(i / 2000.0));
    std::int64_t checks = 0;
    const auto found = depth.first_deeper(q_from, q_to, 0.001, 1e-4, checks);
    if (found) {
      EXPECT_GT(at(*found), 0.001);
    } else {
      EXPECT_LE(deepest, 0.001 + 1e-6);
    }
    EXPECT_TRUE(found || deepest <= 0.00101) << deepest;
    EXPECT_TRUE(deepest >= 0.0005 || checks < 200) << deepest << " m, " << checks << " checks";
    deeper += found ? 1 : 0;
    shallow += !found && deepest > 0.0 ? 1 : 0;
  }
  EXPECT_GT(deeper, 3);
  EXPECT_GT(shallow, 1) << "some touch and are allowed to";
}

TEST(GrownScene, KeepsTheMarginFromEveryShapeButTheException) {
  robot::Scene scene;
  const auto mesh = std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Sphere{0.04}, 64));
  const std::vector<robot::Shape> shapes = {robot::Box{Eigen::Vector3d(0.1, 0.2, 0.3)}, robot::Sphere{0.04},
                                            robot::Cylinder{0.03, 0.2}, mesh};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    robot::SceneBody body;
    body.name = std::to_string(i);
    body.geometry.push_back({shapes[i], Eigen::Isometry3d::Identity()});
    scene.bodies.push_back(body);
  }
  const robot::Scene grown = grown_scene(scene, 0.001, {"2"});
  EXPECT_TRUE(
      std::get<robot::Box>(grown.bodies[0].geometry[0].shape).size.isApprox(Eigen::Vector3d(0.102, 0.202, 0.302)));
  EXPECT_DOUBLE_EQ(std::get<robot::Sphere>(grown.bodies[1].geometry[0].shape).radius, 0.041);
  EXPECT_EQ(std::get<robot::Cylinder>(grown.bodies[2].geometry[0].shape).radius, 0.03) << "excepted";
  const robot::Scene all = grown_scene(scene, 0.001);
  EXPECT_DOUBLE_EQ(std::get<robot::Cylinder>(all.bodies[2].geometry[0].shape).length, 0.202);
  const auto& ball = *std::get<std::shared_ptr<const robot::TriangleMesh>>(grown.bodies[3].geometry[0].shape);
  EXPECT_NEAR(ball.vertices.colwise().norm().minCoeff(), 0.041, 1e-5);
  EXPECT_NEAR(mesh->vertices.colwise().norm().maxCoeff(), 0.04, 1e-12) << "the original is left alone";
}

TEST_F(RobotWorld, APairIsAsDeepAsItOverlaps) {
  // A box into which the palm's link reaches by a known depth: its top side is moved through the link's lowest point.
  const Eigen::VectorXd q = start();
  const std::string link = robot.links()[static_cast<std::size_t>(robot.palm())].name;
  const auto& geometry = robot.links()[static_cast<std::size_t>(robot.palm())].collision;
  const Eigen::Isometry3d X_WL = scene.X_WR * robot.link_poses(q)[static_cast<std::size_t>(robot.palm())];
  double lowest = INFINITY;
  for (const auto& part : geometry) {
    for (const auto& p : robot::surface_samples(part, 0.001)) lowest = std::min(lowest, (X_WL * p).z());
  }
  for (const double depth : {0.002, 0.01}) {
    robot::Scene under = scene;
    under.bodies.clear();
    robot::SceneBody box;
    box.name = "slab";
    box.X_WB.translation() = Eigen::Vector3d(X_WL.translation().x(), X_WL.translation().y(), lowest + depth - 0.5);
    box.geometry.push_back({});
    box.geometry.back().shape = robot::Box{Eigen::Vector3d(1, 1, 1)};
    under.bodies.push_back(box);
    EXPECT_NEAR(pair_depth(robot, under, q, {link, "slab"}), depth, 0.0005);
    EXPECT_NEAR(pair_depth(robot, under, q, {"slab", link}), depth, 0.0005) << "whichever is named first";
    box.X_WB.translation().z() -= 0.1;
    under.bodies = {box};
    EXPECT_EQ(pair_depth(robot, under, q, {link, "slab"}), 0.0);
  }
}

class RobotPlan : public RobotWorld, public ::testing::WithParamInterface<Variant> {};
INSTANTIATE_TEST_SUITE_P(Variants, RobotPlan,
                         ::testing::Values(Variant::synergy, Variant::rrtconnect, Variant::synergy_sampling,
                                           Variant::pregrasp_box));

TEST_P(RobotPlan, ReachesTheShelf) {
  const auto grasp = reachable();
  ASSERT_TRUE(grasp);
  std::vector<GoalRoot> goals;
  for (const ArmSolution& arm : grasp->arm_solutions) {
    goals.push_back({join(robot, arm.q_pregrasp, grasp->q_pregrasp), wide_box(0.6), static_cast<int>(goals.size())});
  }
  PlannerSettings settings;
  settings.variant = GetParam();
  const World world = make_world(checker, robot, kResolution);
  const auto run = [&](std::uint64_t seed) {
    return plan(start(), wide_box(0.4), goals, robot.joint_names(), robot.hand(), robot.lower(), robot.upper(),
                robot.weights(), world, settings, seed);
  };
  const PlanResult result = run(1);
  ASSERT_EQ(result.status, PlanStatus::solved) << result.detail;
  EXPECT_EQ(run(1).path.waypoints, result.path.waypoints);
  const Shortcut shorter = shortcut(result.path, robot.weights(), world, {}, 1);
  EXPECT_LE(shorter.length, result.length);
  const auto goal = static_cast<std::size_t>(result.goal);
  const auto whole =
      append_closing_segment(shorter.path, join(robot, grasp->arm_solutions[goal].q_grasp, grasp->q_grasp),
                             robot.hand(), closing_world(checker, checker, robot, {}, kResolution));
  ASSERT_TRUE(whole);
  std::int64_t checks = 0;
  for (Eigen::Index i = 1; i < whole->waypoints.rows(); ++i) {
    const Eigen::VectorXd from = whole->waypoints.row(i - 1).transpose();
    EXPECT_FALSE(world.confirm(from, whole->waypoints.row(i).transpose(), checks));
  }
  const RateLimits limits{robot.velocity(), robot.acceleration()};
  const BlendedPath blended = blend_corners(shorter.path.waypoints, world, {});
  const Trajectory trajectory = time_optimal(blended, limits, {});
  const Eigen::Index last = trajectory.times.size() - 1;
  EXPECT_GT(trajectory.times[last], least_duration(trajectory.positions, limits));
  for (Eigen::Index i = 0; i < last; ++i) {
    EXPECT_TRUE(valid_motion(world, trajectory.positions.row(i).transpose(),
                             trajectory.positions.row(i + 1).transpose(), checks));
  }
  RecordProperty("iterations", static_cast<int>(result.iterations));
  RecordProperty("checks", static_cast<int>(result.collision_checks));
  RecordProperty("length_mrad", static_cast<int>(1000 * result.length));
  RecordProperty("length_shortcut_mrad", static_cast<int>(1000 * shorter.length));
}

}  // namespace
}  // namespace opponens::motion
