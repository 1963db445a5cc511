// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/motion_bound.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "robot_test.hpp"
#include "tests/support/sample_count.hpp"

namespace opponens::robot {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d random_vector(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

/// A tree of up to 12 links with revolute, prismatic, fixed and mimicking joints and shapes of every kind.
RobotDescription random_tree(Rng& rng) {
  RobotDescription d;
  d.name = "random tree";
  const int links = 3 + static_cast<int>(rng.index(10));
  for (int l = 0; l < links; ++l) {
    Link link{"link" + std::to_string(l), l - 1, {}};
    const Shape shapes[] = {Box{random_vector(rng, 0.1).cwiseAbs() + Vector3d::Constant(0.01)}, Sphere{0.05},
                            Cylinder{0.03, 0.2},
                            std::make_shared<const TriangleMesh>(triangulate(Cylinder{0.02, 0.3}, 9))};
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = random_vector(rng, 0.2);
    X.linear() = Eigen::AngleAxisd(rng.uniform(0, 3), random_vector(rng, 1).normalized()).toRotationMatrix();
    for (std::uint64_t k = rng.index(3); k > 0; --k) link.collision.push_back({shapes[rng.index(4)], X});
    d.links.push_back(link);
    if (l == 0) continue;
    Joint joint;
    joint.name = "joint" + std::to_string(l);
    const auto kind = rng.index(8);
    joint.type = kind == 0 ? JointType::fixed : kind < 3 ? JointType::prismatic : JointType::revolute;
    joint.parent = std::max(0, l - 1 - static_cast<int>(rng.index(3)));
    joint.child = l;
    joint.axis = random_vector(rng, 1).normalized();
    joint.X_PJ = X;
    joint.lower = -3.0;
    joint.upper = 3.0;
    if (kind == 7 && !d.hand_joints.empty()) {
      joint.mimic = Mimic{d.hand_joints[rng.index(d.hand_joints.size())], rng.uniform(-2, 2), 0.1};
      joint.lower = joint.upper = 0.0;  // no limits of its own
    } else if (kind > 0) {
      d.hand_joints.push_back(joint.name);
    }
    d.joints.push_back(joint);
  }
  return d;
}

/// Points of a link's surface, m, in the link.
std::vector<Eigen::Matrix3Xd> surface_points(const RobotModel& robot, Rng& rng) {
  std::vector<Eigen::Matrix3Xd> result;
  for (const Link& link : robot.links()) {
    std::vector<Vector3d> points;
    for (const Geometry& g : link.collision) {
      const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&g.shape);
      const TriangleMesh triangles = mesh != nullptr ? **mesh : triangulate(g.shape, 24);
      for (int i = 0; i < 60; ++i) {
        const auto v = static_cast<Eigen::Index>(rng.index(static_cast<std::uint64_t>(triangles.vertices.cols())));
        points.push_back(g.X_BG * Vector3d(triangles.vertices.col(v)));
      }
    }
    if (points.empty()) points.push_back(Vector3d::Zero());
    Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = points[i];
    result.push_back(columns);
  }
  return result;
}

struct Travelled {
  VectorXd link;         ///< [links] m, longest way of a point, by chords
  Eigen::MatrixXd pair;  ///< [links x links] m, largest change of a distance between two points of the two links
};

/// By 60 steps along the straight line. A chord is shorter than its arc, so this is never too large.
Travelled sampled(const RobotModel& robot, const std::vector<Eigen::Matrix3Xd>& points, const VectorXd& q_a,
                  const VectorXd& q_b) {
  const auto links = static_cast<Eigen::Index>(points.size());
  Travelled result{VectorXd::Zero(links), Eigen::MatrixXd::Zero(links, links)};
  std::vector<Eigen::Matrix3Xd> at(points.size());
  std::vector<VectorXd> way(points.size());
  Eigen::MatrixXd least = Eigen::MatrixXd::Constant(links, links, 1e9);
  Eigen::MatrixXd most = Eigen::MatrixXd::Constant(links, links, -1e9);
  constexpr int kSteps = 60;
  for (int k = 0; k <= kSteps; ++k) {
    const auto X_RL = robot.link_poses(q_a + (q_b - q_a) * k / kSteps);
    for (std::size_t l = 0; l < points.size(); ++l) {
      const Eigen::Matrix3Xd now = (X_RL[l].linear() * points[l]).colwise() + X_RL[l].translation();
      if (k == 0) way[l] = VectorXd::Zero(now.cols());
      if (k > 0) way[l] += (now - at[l]).colwise().norm().transpose();
      at[l] = now;
    }
    for (Eigen::Index a = 0; a < links; ++a) {
      for (Eigen::Index b = 0; b < links; ++b) {
        const auto& p = at[static_cast<std::size_t>(a)];
        const auto& other = at[static_cast<std::size_t>(b)];
        const double d = (p.col(0) - other.col(other.cols() - 1)).norm();
        least(a, b) = std::min(least(a, b), d);
        most(a, b) = std::max(most(a, b), d);
      }
    }
  }
  for (std::size_t l = 0; l < points.size(); ++l) result.link[static_cast<Eigen::Index>(l)] = way[l].maxCoeff();
  result.pair = most - least;
  return result;
}

VectorXd within(const RobotModel& robot, Rng& rng) {
  VectorXd q(robot.dof());
  for (int i = 0; i < robot.dof(); ++i) q[i] = rng.uniform(robot.lower()[i], robot.upper()[i]);
  return q;
}

/// Bounds of random motions of every length against samples; returns bound / sampled of every moving link.
std::vector<double> compare(const RobotModel& robot, int motions, double shortest, double longest, Rng& rng) {
  const auto points = surface_points(robot, rng);
  const MotionBound bound(robot);
  std::vector<double> ratios;
  for (int trial = 0; trial < motions; ++trial) {
    const VectorXd q_a = within(robot, rng);
    VectorXd q_b = within(robot, rng);
    const double length = shortest * std::pow(longest / shortest, rng.uniform());
    q_b = q_a + (q_b - q_a) * (length / std::max(1e-9, (q_b - q_a).norm()));
    const LinkTravel travel =
        bound.travel(robot.link_poses(0.5 * (q_a + q_b)), robot.joint_positions(q_b) - robot.joint_positions(q_a));
    const Travelled found = sampled(robot, points, q_a, q_b);
    for (int a = 0; a < static_cast<int>(points.size()); ++a) {
      const double of_link = bound.of_link(travel, a);
      EXPECT_GE(of_link, found.link[a] - 1e-12)
          << robot.links()[static_cast<std::size_t>(a)].name << ", q " << q_a.transpose() << " to " << q_b.transpose();
      if (found.link[a] > 1e-9) ratios.push_back(of_link / found.link[a]);
      for (int b = 0; b < static_cast<int>(points.size()); ++b) {
        EXPECT_GE(bound.between(travel, a, b), found.pair(a, b) - 1e-12) << a << " " << b << " " << q_a.transpose();
      }
    }
  }
  return ratios;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST(MotionBound, OneJointByHand) {
  RobotDescription d;
  d.name = "one";
  d.links = {{"base", -1, {}}, {"arm", 0, {{Sphere{0.1}, at(0.5, 0, 0)}}}};
  Joint joint;
  joint.name = "turn";
  joint.type = JointType::revolute;
  joint.parent = 0;
  joint.child = 1;
  joint.axis = Vector3d::UnitZ();
  joint.lower = -3;
  joint.upper = 3;
  d.joints = {joint};
  d.hand_joints = {"turn"};
  const RobotModel robot(d);
  const auto moved = link_displacements(robot, VectorXd::Constant(1, -0.4), VectorXd::Constant(1, 0.6));
  EXPECT_EQ(moved[0], 0.0);
  EXPECT_NEAR(moved[1], 0.6, 1e-15);  // 1 rad at 0.5 + 0.1 m from the axis
}

TEST(MotionBound, LinksOfAFingerMoveLittleAgainstEachOther) {
  const RobotModel robot(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml")));
  const MotionBound bound(robot);
  VectorXd step = VectorXd::Zero(robot.dof());
  step[0] = 1.0;  // the arm turns as a whole
  const auto travel = bound.travel(robot.link_poses(VectorXd::Zero(robot.dof())),
                                   robot.joint_positions(step) - robot.joint_positions(0 * step));
  const int tip = static_cast<int>(robot.links().size()) - 1;
  EXPECT_GT(bound.of_link(travel, tip), 0.3);
  EXPECT_EQ(bound.between(travel, tip, robot.palm()), 0.0);
}

TEST(MotionBound, NeverSmallerThanSampledOnRandomTrees) {
  Rng rng = stream(1, "test/motion_bound/trees");
  std::vector<double> ratios;
  const int trees = sample_count(150);
  for (int tree = 0; tree < trees; ++tree) {
    RobotDescription d = random_tree(rng);
    if (d.hand_joints.empty()) continue;
    const auto found = compare(RobotModel(d), 10, 0.01, 3.0, rng);
    ratios.insert(ratios.end(), found.begin(), found.end());
    ASSERT_FALSE(HasFailure());
  }
  ASSERT_GT(ratios.size(), 20U * static_cast<unsigned>(trees));
  // The same comparison notices a bound that is half as large.
  EXPECT_LT(*std::min_element(ratios.begin(), ratios.end()), 2.0);
  std::cout << "random trees: median of bound / sampled " << median(ratios) << " of " << ratios.size() << "\n";
}

TEST(MotionBound, NeverSmallerThanSampledOnRealRobots) {
  std::vector<RobotDescription> robots = {load_robot(ours("ur5_allegro/ur5_allegro_right.yaml"))};
  const bool shared = std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots");
  if (shared) {
    setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
    setenv("DEX_URDF", OPPONENS_SHARED_DATA "/data/robots/dex-urdf", 1);
    robots.push_back(load_robot(OPPONENS_SOURCE_DIR "/tests/data/robots/paper_lab_ur5_allegro_right_visual.yaml"));
    robots.push_back(load_hand(ours("shadow_hand/shadow_right.yaml")));
  }
  Rng rng = stream(2, "test/motion_bound/robots");
  for (const auto& description : robots) {
    const RobotModel robot(description);
    for (const auto& [shortest, longest] : {std::pair(0.003, 0.03), std::pair(0.3, 3.0)}) {
      const auto ratios = compare(robot, 60, shortest, longest, rng);
      ASSERT_FALSE(HasFailure());
      EXPECT_LT(*std::min_element(ratios.begin(), ratios.end()), 2.0);
      std::cout << description.name << ", motions of " << shortest << " to " << longest
                << " rad: median of bound / sampled " << median(ratios) << " of " << ratios.size() << "\n";
    }
  }
  if (!shared) GTEST_SKIP() << "no shared data: the laboratory's robot and the Shadow hand were left out";
}

}  // namespace
}  // namespace opponens::robot
