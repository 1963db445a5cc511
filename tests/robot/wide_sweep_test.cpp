// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The wide sweep's own arithmetic, from its source: what its margin has to make up for.
#include "robot/wide_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "made_robots.hpp"
#include "robot/load_robot.hpp"
#include "robot/wide_world.hpp"
#include "robot_test.hpp"
#include "tests/support/sample_count.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d lane_of(const wide::V3& v, int lane) {
  return {static_cast<double>(v.x[lane]), static_cast<double>(v.y[lane]), static_cast<double>(v.z[lane])};
}

/// Eight configurations at a time: kinematics in floats beside RobotModel's.
class Kinematics {
 public:
  Kinematics(const RobotModel& robot, bool fixed_root)
      : exact_(robot, {}, {}), world_(exact_, fixed_root), model_(world_.model()) {}

  double margin() const { return world_.margin(); }
  const wide::World& world() const { return world_; }

  /// The largest error of a box's corner over all shapes of the robot, m.
  double worst_error(const std::vector<VectorXd>& q, const Isometry3d& X_WR) const {
    std::array<float, 12> root;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) root[static_cast<std::size_t>(3 * i + j)] = static_cast<float>(X_WR.linear()(i, j));
      root[static_cast<std::size_t>(9 + i)] = static_cast<float>(X_WR.translation()[i]);
    }
    wide::Query query{{}, 255, root.data()};
    for (int lane = 0; lane < wide::kLanes; ++lane) query.q[lane] = q[static_cast<std::size_t>(lane)].data();
    std::vector<wide::Pose> X(static_cast<std::size_t>(model_.frame_count));
    wide::place_frames(model_, query, X.data());
    double worst = 0.0;
    for (int lane = 0; lane < wide::kLanes; ++lane) {
      const std::vector<Isometry3d> X_RL = exact_.robot.link_poses(q[static_cast<std::size_t>(lane)]);
      for (int i = 0; i < model_.robot_part_count; ++i) {
        const CollisionPart& part = exact_.parts[static_cast<std::size_t>(i)];
        worst = std::max(worst, error_of(part, X_WR * X_RL[static_cast<std::size_t>(part.body)] * part.X_BG,
                                         model_.parts[i], X[static_cast<std::size_t>(model_.parts[i].frame)], lane));
      }
    }
    return worst;
  }

 private:
  static double error_of(const CollisionPart& part, const Isometry3d& X_WG, const wide::Part& wide_part,
                         const wide::Pose& X, int lane) {
    double worst = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const Vector3d offset = sign.cwiseProduct(part.shape.half_extents());
      Vector3d found = lane_of(wide::moved(X, wide_part.box_center), lane);
      for (int k = 0; k < 3; ++k) {
        const float axis[3] = {wide_part.box_axes[k], wide_part.box_axes[3 + k], wide_part.box_axes[6 + k]};
        found += offset[k] * lane_of(wide::rotated(X, axis), lane);
      }
      worst = std::max(worst, (found - X_WG * (part.shape.center() + offset)).norm());
    }
    return worst;
  }

  CollisionWorld exact_;
  wide::World world_;
  wide::Model model_;
};

/// Eight configurations within the limits, turns beyond them by up to `excess` rad.
std::vector<VectorXd> eight(const RobotModel& robot, double excess, Rng& rng) {
  std::vector<VectorXd> all;
  for (int lane = 0; lane < wide::kLanes; ++lane) {
    VectorXd q(robot.dof());
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = rng.uniform(robot.lower()[i], robot.upper()[i]);
    for (std::size_t j = 0; j < robot.drives().size() && excess > 0.0; ++j) {
      const RobotModel::Drive& drive = robot.drives()[j];
      if (drive.index >= 0 && robot.description().joints[j].type == JointType::revolute) {
        q[drive.index] = rng.uniform(-excess, excess);
      }
    }
    for (std::size_t j = 0; j < robot.drives().size(); ++j) {  // a slide that mimics a turn keeps its place
      const RobotModel::Drive& drive = robot.drives()[j];
      if (drive.index < 0 || robot.description().joints[j].type != JointType::prismatic) continue;
      q[drive.index] = rng.uniform(robot.lower()[drive.index], robot.upper()[drive.index]);
    }
    all.push_back(q);
  }
  return all;
}

void expect_within_a_quarter(const RobotModel& robot, const std::string& name, Rng& rng) {
  const Kinematics fixed(robot, true);
  const Kinematics flying(robot, false);
  for (int i = 0; i < 100; ++i) {
    const std::vector<VectorXd> q = eight(robot, i % 2 == 0 ? 0.0 : 1e4, rng);
    for (const VectorXd& one : q) ASSERT_TRUE(fixed.world().holds(one.data(), robot.dof())) << name;
    EXPECT_LE(fixed.worst_error(q, Isometry3d::Identity()), 0.25 * fixed.margin()) << name;
    Isometry3d X_WR = random_pose(1.0, rng);
    while (flying.world().reaches(X_WR)) X_WR.translation() *= 1.01;
    X_WR.translation() /= 1.02;  // nearly as far out as the sweep takes it
    EXPECT_LE(flying.worst_error(q, X_WR), 0.25 * flying.margin()) << name;
  }
}

TEST(WideSweep, PosesAreWithinAQuarterOfTheMargin) {
  Rng rng(1);
  expect_within_a_quarter(RobotModel(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml"))), "ours", rng);
  for (int i = 0; i < 40; ++i) {
    const double length = std::pow(10.0, rng.uniform(-2, 1));
    const RobotModel robot = random_robot(3 + static_cast<int>(rng.index(15)), length, rng);
    expect_within_a_quarter(robot, "random " + std::to_string(i), rng);
  }
  if (!std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) GTEST_SKIP() << "no " OPPONENS_SHARED_DATA;
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  const std::string robots = OPPONENS_SOURCE_DIR "/tests/data/robots/";
  for (const char* name : {"paper_lab_ur5_allegro_right_urdf.yaml", "example_ur5_allegro_right.yaml"}) {
    expect_within_a_quarter(RobotModel(load_robot(robots + name)), name, rng);
  }
}

TEST(WideSweep, LongChainsAndAxesNearlyOppositeToZ) {
  Rng rng(2);
  for (const double tilt : {0.0, 1e-12, 1e-9, 1.5e-6, 1e-5, 1e-3}) {
    for (const int joints : {6, 150}) {
      RobotBuilder builder({{Sphere{0.05}}});
      for (int i = 0; i < joints; ++i) {
        builder.add(i, JointType::revolute, Vector3d(tilt, 0.0, i % 2 == 0 ? -1.0 : 1.0).normalized(),
                    random_pose(0.3, rng), {{Box{{0.1, 0.02, 0.02}}}});
      }
      expect_within_a_quarter(builder.model(), std::to_string(joints) + " " + std::to_string(tilt), rng);
    }
  }
}

TEST(WideSweep, LongSlidesWidenTheMargin) {
  const auto gantry = [](double travel) {
    RobotBuilder builder({{Sphere{0.05}}});
    Joint& slide = builder.add(0, JointType::prismatic, Vector3d::UnitX(), at(0, 0, 1), {{Box{{0.1, 0.1, 0.1}}}});
    slide.lower = -travel;
    slide.upper = travel;
    builder.add(1, JointType::revolute, Vector3d(1, 2, 3).normalized(), at(0, 0, 0.1), {{Box{{0.1, 0.3, 0.1}}}});
    return builder.model();
  };
  Rng rng(3);
  for (const double travel : {0.1, 10.0, 1000.0}) {
    const RobotModel robot = gantry(travel);
    expect_within_a_quarter(robot, "gantry", rng);
    const Kinematics kinematics(robot, true);
    EXPECT_GT(kinematics.margin(), 2e-5 * travel);
    EXPECT_FALSE(kinematics.world().holds(Eigen::Vector2d(travel + 0.1, 0).data(), 2));
    EXPECT_FALSE(kinematics.world().holds(Eigen::Vector2d(0, 1.1e4).data(), 2));
  }
}

TEST(WideSweep, SineAndCosine) {
  Rng rng(4);
  for (int i = 0; i < sample_count(20000); ++i) {
    wide::V angle;
    for (int lane = 0; lane < wide::kLanes; ++lane) {
      const double special = 0.25 * static_cast<double>(static_cast<int>(rng.index(9)) - 4) * 3.14159265358979;
      angle[lane] = static_cast<float>(lane < 2 ? special + rng.uniform(-1e-6, 1e-6) : rng.uniform(-3.1416, 3.1416));
    }
    wide::V s;
    wide::V c;
    wide::sine_cosine(angle, s, c);
    for (int lane = 0; lane < wide::kLanes; ++lane) {
      const double exact = static_cast<double>(angle[lane]);
      EXPECT_NEAR(static_cast<double>(s[lane]), std::sin(exact), 1.2e-7) << exact;
      EXPECT_NEAR(static_cast<double>(c[lane]), std::cos(exact), 1.2e-7) << exact;
    }
  }
}

/// Two boxes, in every lane.
wide::LaneBox lane_box(const Isometry3d& X) {
  wide::LaneBox box;
  const auto spread = [](const Vector3d& v) {
    return wide::V3{wide::all(static_cast<float>(v.x())), wide::all(static_cast<float>(v.y())),
                    wide::all(static_cast<float>(v.z()))};
  };
  box.center = spread(X.translation());
  for (int k = 0; k < 3; ++k) box.axis[k] = spread(X.linear().col(k));
  return box;
}

TEST(WideSweep, NearlyParallelBoxesThatOverlapAreNeverApart) {
  // No margin here: what is left is the arithmetic of axes whose cross products nearly vanish.
  Rng rng(5);
  for (int i = 0; i < sample_count(20000); ++i) {
    Vector3d h(rng.uniform(0.01, 0.02), rng.uniform(0.01, 0.02), rng.uniform(0.5, 1.0));
    Vector3d g(rng.uniform(0.01, 0.02), rng.uniform(0.5, 1.0), rng.uniform(0.01, 0.02));
    const Isometry3d X_WA = random_pose(1.0, rng);
    Isometry3d X_AB = Isometry3d::Identity();
    X_AB.rotate(Eigen::AngleAxisd(std::pow(10.0, rng.uniform(-9, -3)), random_direction(rng)));
    if (rng.index(2) == 0) X_AB.rotate(Eigen::AngleAxisd(1.5707963267948966, Vector3d::UnitX()));
    // A corner of B a millimetre inside of A.
    const Vector3d corner = g.cwiseProduct(Vector3d(1, rng.index(2) == 0 ? 1 : -1, 1));
    const Vector3d inside = (h.array() - 1e-3).matrix().cwiseProduct(Vector3d(-1, 1, rng.index(2) == 0 ? 1 : -1));
    X_AB.translation() = inside - X_AB.linear() * corner;
    const Eigen::Vector3f hf = h.cast<float>();
    const Eigen::Vector3f gf = g.cast<float>();
    const wide::LaneBox a = lane_box(X_WA);
    const wide::LaneBox b = lane_box(X_WA * X_AB);
    EXPECT_EQ(wide::boxes_near(a, wide::Cuboid{hf.data()}, b, wide::Cuboid{gf.data()}, 255U), 255U) << i;
    EXPECT_EQ(wide::boxes_near(b, wide::Cuboid{gf.data()}, a, wide::Cuboid{hf.data()}, 255U), 255U) << i;
  }
}

}  // namespace
}  // namespace opponens::robot
