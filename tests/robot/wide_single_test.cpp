// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The sweep over one configuration, from its source: what its margin has to make up for, and lanes that are pairs.
#include "robot/wide_single.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
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

Vector3d first_three(const float* v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// The sweep's own places of a robot's parts, beside RobotModel's.
class Places {
 public:
  Places(const RobotModel& robot, bool fixed_root)
      : exact_(robot, {}, {}), world_(exact_, fixed_root), model_(world_.model()) {
    frames_.resize(static_cast<std::size_t>(model_.frame_count));
    rounded_.resize(frames_.size());
    joints_.resize(3 * frames_.size());
    parts_.resize(static_cast<std::size_t>(model_.robot_part_count));
    placed_ = std::make_unique<bool[]>(parts_.size());
  }

  const wide::World& world() const { return world_; }

  /// The largest error of a box's corner over all shapes, m.
  double worst_error(const VectorXd& q, const Isometry3d& X_WR) {
    double root[12];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) root[3 * i + j] = X_WR.linear()(i, j);
      root[9 + i] = X_WR.translation()[i];
    }
    const std::size_t rows = frames_.size();
    const wide::Turns turns{joints_.data(), joints_.data() + rows, joints_.data() + 2 * rows};
    wide::place_joints(model_, q.data(), turns);
    wide::place_frames(model_, {q.data(), root}, turns, frames_.data(), rounded_.data());
    std::fill_n(placed_.get(), parts_.size(), false);
    const wide::SingleScratch scratch{model_,        rounded_.data(), model_.spread_parts,    model_.scene_parts,
                                      parts_.data(), placed_.get(),   model_.robot_part_count};
    const std::vector<Isometry3d> X_RL = exact_.robot.link_poses(q);
    double worst = 0.0;
    for (int i = 0; i < model_.robot_part_count; ++i) {
      const CollisionPart& part = exact_.parts[static_cast<std::size_t>(i)];
      const Isometry3d X_WG = X_WR * X_RL[static_cast<std::size_t>(part.body)] * part.X_BG;
      worst = std::max(worst, error_of(part.shape, X_WG, wide::place(scratch, i)));
    }
    return worst;
  }

 private:
  static double error_of(const CollisionShape& shape, const Isometry3d& X_WG, const wide::PlacedPart& placed) {
    double worst = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const Vector3d offset = sign.cwiseProduct(shape.half_extents());
      Vector3d found = first_three(placed.center);
      for (int k = 0; k < 3; ++k) found += offset[k] * first_three(placed.axis[k]);
      worst = std::max(worst, (found - X_WG * (shape.center() + offset)).norm());
    }
    return worst;
  }

  CollisionWorld exact_;
  wide::World world_;
  wide::Model model_;
  std::vector<wide::ExactPose> frames_;
  std::vector<wide::RoundedPose> rounded_;
  std::vector<wide::D> joints_;
  std::vector<wide::PlacedPart> parts_;
  std::unique_ptr<bool[]> placed_;
};

/// Turns go to 10,000 rad every second time; what slides, or mimics something that turns, stays within its limits.
VectorXd configuration(const RobotModel& robot, bool far, Rng& rng) {
  VectorXd q(robot.dof());
  for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = far ? rng.uniform(-1e4, 1e4) : 0.0;
  for (std::size_t j = 0; j < robot.drives().size(); ++j) {
    const int index = robot.drives()[j].index;
    if (index < 0 || (far && robot.description().joints[j].type == JointType::revolute)) continue;
    q[index] = rng.uniform(robot.lower()[index], robot.upper()[index]);
  }
  return q;
}

void expect_small_errors(const RobotModel& robot, const std::string& name, Rng& rng) {
  Places fixed(robot, true);
  Places flying(robot, false);
  const auto allowed = [](const Places& places) { return 0.25 * (places.world().single_margin() - 1e-6); };
  for (int i = 0; i < 200; ++i) {
    const VectorXd q = configuration(robot, i % 2 == 1, rng);
    if (!fixed.world().holds(q.data(), robot.dof())) continue;
    EXPECT_LE(fixed.worst_error(q, Isometry3d::Identity()), allowed(fixed)) << name;
    Isometry3d X_WR = random_pose(1.0, rng);
    while (flying.world().reaches(X_WR)) X_WR.translation() *= 1.01;
    X_WR.translation() /= 1.02;  // nearly as far out as the sweep takes it
    EXPECT_LE(flying.worst_error(q, X_WR), allowed(flying)) << name;
  }
}

TEST(WideSingle, PlacesAreWithinAQuarterOfTheMargin) {
  Rng rng(1);
  expect_small_errors(RobotModel(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml"))), "ours", rng);
  for (int i = 0; i < 40; ++i) {
    const double length = std::pow(10.0, rng.uniform(-2, 1));
    const RobotModel robot = random_robot(3 + static_cast<int>(rng.index(15)), length, rng);
    expect_small_errors(robot, "random " + std::to_string(i), rng);
  }
}

TEST(WideSingle, SineAndCosine) {
  Rng rng(2);
  for (int i = 0; i < sample_count(20000); ++i) {
    wide::D angle;
    for (int lane = 0; lane < wide::kLanes; ++lane) {
      const double special = 0.25 * static_cast<double>(static_cast<int>(rng.index(9)) - 4) * 3.14159265358979;
      angle[lane] = lane < 2 ? special + rng.uniform(-1e-9, 1e-9) : rng.uniform(-3e4, 3e4);
    }
    wide::D s;
    wide::D c;
    wide::sine_cosine(angle, s, c);
    for (int lane = 0; lane < wide::kLanes; ++lane) {
      EXPECT_NEAR(s[lane], std::sin(angle[lane]), 1e-10) << angle[lane];
      EXPECT_NEAR(c[lane], std::cos(angle[lane]), 1e-10) << angle[lane];
    }
  }
}

TEST(WideSingle, TransposesRows) {
  wide::V rows[wide::kLanes];
  for (int i = 0; i < wide::kLanes; ++i) {
    for (int j = 0; j < wide::kLanes; ++j) rows[i][j] = static_cast<float>(10 * i + j);
  }
  wide::transpose(rows);
  for (int i = 0; i < wide::kLanes; ++i) {
    for (int j = 0; j < wide::kLanes; ++j) EXPECT_EQ(rows[i][j], static_cast<float>(10 * j + i));
  }
}

wide::PlacedPart random_part(Rng& rng) {
  const Isometry3d X = random_pose(0.15, rng);
  const bool round = rng.index(2) == 0;
  wide::PlacedPart part;
  for (int k = 0; k < 3; ++k) {
    part.center[k] = static_cast<float>(X.translation()[k]);
    for (int axis = 0; axis < 3; ++axis) part.axis[axis][k] = static_cast<float>(X.linear()(k, axis));
  }
  part.center[3] = static_cast<float>(rng.uniform(0.02, 0.1));
  part.axis[0][3] = round ? part.center[3] : static_cast<float>(rng.uniform(0.02, 0.1));
  part.axis[1][3] = static_cast<float>(rng.uniform(0.02, 0.1));
  part.axis[2][3] = static_cast<float>(round ? wide::Form::cylinder : wide::Form::box);
  return part;
}

/// The part with another size, as a batch takes it: in every lane the same.
wide::Part shared_part(const wide::PlacedPart& placed, float scale) {
  wide::Part part{};
  part.half_extents[0] = scale * placed.center[3];
  part.half_extents[1] = scale * placed.axis[0][3];
  part.half_extents[2] = scale * placed.axis[1][3];
  part.form = static_cast<wide::Form>(static_cast<int>(placed.axis[2][3]));
  return part;
}

bool near_in_a_batch(const wide::PlacedPart& a, const wide::PlacedPart& b, float scale) {
  const wide::Part part_a = shared_part(a, scale);
  const wide::Part part_b = shared_part(b, scale);
  return wide::with_filling(part_a, [&](const auto& in_a) {
           return wide::with_filling(part_b, [&](const auto& in_b) {
             return wide::boxes_near(wide::spread(a), in_a, wide::spread(b), in_b, 1U);
           });
         }) != 0;
}
bool touch_in_a_batch(const wide::PlacedPart& a, const wide::PlacedPart& b, float scale) {
  const wide::Part part_a = shared_part(a, scale);
  const wide::Part part_b = shared_part(b, scale);
  return wide::with_filling(part_a, [&](const auto& in_a) {
           return wide::with_filling(part_b, [&](const auto& in_b) {
             return wide::boxes_touch(wide::spread(a), in_a, wide::spread(b), in_b, 1e-4F, 1U);
           });
         }) != 0;
}

TEST(WideSingle, LanesOfPairsAreWhatEachPairIsAlone) {
  Rng rng(3);
  int counts[2][2] = {};
  for (int i = 0; i < 2000; ++i) {
    wide::PlacedPart a[wide::kLanes];
    wide::PlacedPart b[wide::kLanes];
    wide::PairLanes pairs;
    for (int lane = 0; lane < wide::kLanes; ++lane) {
      a[lane] = random_part(rng);
      b[lane] = random_part(rng);
      pairs.add(lane, a[lane], lane, b[lane]);
    }
    const wide::SideLanes side_a = wide::gather(pairs.placed_a);
    const wide::SideLanes side_b = wide::gather(pairs.placed_b);
    const auto round = static_cast<float>(wide::Form::cylinder);
    const wide::Mixture in_a{side_a.half, side_a.form == round};
    const wide::Mixture in_b{side_b.half, side_b.form == round};
    const unsigned near = wide::boxes_near(side_a.box, in_a, side_b.box, in_b, 255U);
    const unsigned touching = wide::boxes_touch(side_a.box, in_a, side_b.box, in_b, 1e-4F, 255U);
    const unsigned near_as_boxes =
        wide::boxes_near(side_a.box, wide::Cuboids{side_a.half}, side_b.box, wide::Cuboids{side_b.half}, 255U);
    EXPECT_EQ(near & ~near_as_boxes, 0U);
    EXPECT_EQ(touching & ~near, 0U);
    for (int lane = 0; lane < wide::kLanes; ++lane) {
      const bool is_near = (near >> lane & 1U) != 0;
      const bool touches = (touching >> lane & 1U) != 0;
      ++counts[is_near ? 1 : 0][touches ? 1 : 0];
      EXPECT_FALSE(is_near ? !near_in_a_batch(a[lane], b[lane], 1.0001F) : near_in_a_batch(a[lane], b[lane], 0.9999F));
      if (touches) {
        EXPECT_TRUE(touch_in_a_batch(a[lane], b[lane], 1.001F));
      }
    }
  }
  for (const auto& [is_near, touches] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1)}) {
    EXPECT_GT(counts[is_near][touches], 100) << is_near << touches;
  }
}

}  // namespace
}  // namespace opponens::robot
