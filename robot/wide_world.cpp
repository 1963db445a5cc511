// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/wide_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace opponens::robot::wide {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kMargin = 2e-5;            ///< of the largest coordinate
constexpr float kRadiusRounding = 1.0e-6F;  ///< share by which a radius grows when it becomes a float
constexpr std::size_t kAlignment = 64;      ///< bytes

void store_rotation(const Eigen::Matrix3d& R, float* to) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) to[3 * i + j] = static_cast<float>(R(i, j));
  }
}
void store(const Vector3d& v, float* to) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(v[i]);
}

float enlarged(double length, double margin) { return static_cast<float>(length + margin) * (1.0F + kRadiusRounding); }

/// Turns the z axis into the given one.
Eigen::Matrix3d z_onto(const Vector3d& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis).toRotationMatrix();
}

Form form_of(const CollisionShape& shape) {
  if (std::holds_alternative<Box>(shape.shape())) return Form::box;
  return std::holds_alternative<Cylinder>(shape.shape()) ? Form::cylinder : Form::other;
}

SphereTree::Node bounding_ball(const CollisionShape& shape) {
  if (form_of(shape) == Form::other) return shape.cover().nodes[0];
  return {shape.center(), shape.radius(), 0, 0};
}

double largest_coordinate(const CollisionPart& part, const Isometry3d& X) {
  return (X * part.X_BG * part.shape.center()).norm() + part.shape.half_extents().norm();
}

}  // namespace

bool has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

int farthest(const float* xyz, int count, const float* n) {
#if defined(OPPONENS_AVX2)
  static const bool fast = has_avx2();
  if (fast) return farthest_avx2(xyz, count, n);
#endif
  return farthest_portable(xyz, count, n);
}

World::World(const CollisionWorld& world, bool fixed_root) : robot_parts_(world.robot_parts) {
  add_frames(world.robot);
  double largest = 1.0;
  for (std::size_t i = 0; i < world.parts.size(); ++i) {
    const CollisionPart& part = world.parts[i];
    if (world.of_scene(static_cast<int>(i))) {
      largest = std::max(largest, largest_coordinate(part, world.X_WR.inverse()));
    } else {
      const auto link = static_cast<std::size_t>(part.body);
      const Reach& reach = reach_[static_cast<std::size_t>(frame_of_link_[link])];
      const double offset = std::isfinite(reach.radius) ? reach.center.norm() + reach.radius : 0.0;
      largest = std::max(largest, offset + largest_coordinate(part, X_FL_[link]));
    }
  }
  // A robot that flies may be as far away again (contains).
  largest_ = fixed_root ? largest : 2.0 * largest;
  margin_ = kMargin * largest_;
  add_parts(world);
  add_pairs(world, fixed_root);
  add_clusters();
}

/// Links joined by joints that do not move share a frame. A joint's frame has its axis as z.
void World::add_frames(const RobotModel& robot) {
  const Frame still{kWorld, Motion::none, -1, 1.0, 0.0, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
  frames_ = {still, still};
  reach_ = {{kRoot, Vector3d::Zero(), 0.0}, {kRoot, Vector3d::Zero(), 0.0}};
  frame_of_link_ = {kRoot};
  X_FL_ = {Isometry3d::Identity()};
  const std::vector<Joint>& joints = robot.description().joints;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(robot.dof());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    const RobotModel::Drive& drive = robot.drives()[i];
    const auto parent_link = static_cast<std::size_t>(joint.parent);
    const int parent = frame_of_link_[parent_link];
    if (joint.type == JointType::fixed || drive.index < 0) {
      Isometry3d X_FC;
      robot.place_child(i, zero, X_FL_[parent_link], X_FC);
      frame_of_link_.push_back(parent);
      X_FL_.push_back(X_FC);
      continue;
    }
    const Eigen::Matrix3d Q = z_onto(joint.axis);
    const Isometry3d X_PF = X_FL_[parent_link] * joint.X_PJ * Isometry3d(Eigen::Quaterniond(Q));
    Frame frame = still;
    frame.parent = parent;
    frame.motion = joint.type == JointType::revolute ? Motion::turn : Motion::slide;
    frame.joint = drive.index;
    frame.multiplier = drive.multiplier;
    frame.offset = drive.offset;
    store_rotation(X_PF.linear(), frame.rotation);
    store(X_PF.translation(), frame.translation);
    const Reach& before = reach_[static_cast<std::size_t>(parent)];
    const double infinity = std::numeric_limits<double>::infinity();
    const double radius = frame.motion == Motion::slide ? infinity : before.radius + X_PF.translation().norm();
    reach_.push_back(parent == kRoot && frame.motion == Motion::turn ? Reach{kRoot, X_PF.translation(), 0.0}
                                                                     : Reach{kRoot, before.center, radius});
    frame_of_link_.push_back(static_cast<int>(frames_.size()));
    X_FL_.emplace_back(Eigen::Quaterniond(Q).inverse());
    frames_.push_back(frame);
  }
}

void World::add_parts(const CollisionWorld& world) {
  const Isometry3d X_RW = world.X_WR.inverse();
  for (std::size_t i = 0; i < world.parts.size(); ++i) {
    const CollisionPart& source = world.parts[i];
    const auto body = static_cast<std::size_t>(source.body);
    const bool fixed = world.of_scene(static_cast<int>(i));
    const Isometry3d X_FG = (fixed ? X_RW : X_FL_[body]) * source.X_BG;
    const SphereTree::Node ball = bounding_ball(source.shape);
    Part part;
    part.frame = fixed ? kWorld : frame_of_link_[body];
    store(X_FG * ball.center, part.ball_center);
    part.ball_radius = enlarged(ball.radius, margin_);
    store(X_FG * source.shape.center(), part.box_center);
    store_rotation(X_FG.linear(), part.box_axes);
    for (int k = 0; k < 3; ++k) part.half_extents[k] = enlarged(source.shape.half_extents()[k], margin_);
    part.form = form_of(source.shape);
    part.root = part.form == Form::other ? add_tree(source.shape.cover(), X_FG) : -1;
    parts_.push_back(part);
  }
}

int World::add_tree(const SphereTree& tree, const Isometry3d& X_FG) {
  const int root = static_cast<int>(nodes_.size());
  for (const SphereTree::Node& source : tree.nodes) {
    Node node;
    store(X_FG * source.center, node.center);
    node.radius = enlarged(source.radius, margin_);
    node.first_child = root + source.first_child;
    node.children = source.children;
    nodes_.push_back(node);
  }
  return root;
}

/// Whether a part of the robot never meets a part of the scene, wherever its joints turn.
bool World::out_of_reach(int part, int other) const {
  const Part& a = parts_[static_cast<std::size_t>(part)];
  const Part& b = parts_[static_cast<std::size_t>(other)];
  const Reach& reach = reach_[static_cast<std::size_t>(a.frame)];
  const OrientedBox box{Eigen::Map<const Eigen::Vector3f>(b.box_center).cast<double>(),
                        Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(b.box_axes).cast<double>(),
                        Eigen::Map<const Eigen::Vector3f>(b.half_extents).cast<double>()};
  const double around = Eigen::Map<const Eigen::Vector3f>(a.ball_center).cast<double>().norm() + a.ball_radius;
  return point_box_distance(reach.center, box) > reach.radius + around + margin_;
}

void World::add_pairs(const CollisionWorld& world, bool fixed_root) {
  for (int i = 0; i < robot_parts_; ++i) {
    const int frame = parts_[static_cast<std::size_t>(i)].frame;
    const int begin = static_cast<int>(partners_.size());
    for (const int j : world.partners[static_cast<std::size_t>(i)]) {
      const int other = parts_[static_cast<std::size_t>(j)].frame;
      if (frame == other || (fixed_root && frame == kRoot && other == kWorld)) {
        constant_pairs_.emplace_back(i, j);
      } else if (!fixed_root || other != kWorld || !out_of_reach(i, j)) {
        partners_.push_back(j);
      }
    }
    ranges_.push_back({begin, static_cast<int>(partners_.size())});
  }
}

/// What hangs on the first branching of each chain: a hand, whose many parts are far from most others together.
void World::add_clusters() {
  const int count = static_cast<int>(frames_.size());
  std::vector<int> children(frames_.size(), 0);
  for (int f = kRoot + 1; f < count; ++f)
    ++children[static_cast<std::size_t>(frames_[static_cast<std::size_t>(f)].parent)];
  std::vector<int> cluster_of(frames_.size(), -1);
  std::vector<double> reach(frames_.size(), 0.0);  // of the frame's origin from the cluster's
  for (int f = kRoot + 1; f < count; ++f) {
    const auto index = static_cast<std::size_t>(f);
    const Frame& frame = frames_[index];
    const auto parent = static_cast<std::size_t>(frame.parent);
    if (cluster_of[parent] >= 0) {
      cluster_of[index] = cluster_of[parent];
      const double step = Eigen::Map<const Eigen::Vector3f>(frame.translation).norm();
      reach[index] = reach[parent] + (frame.motion == Motion::slide ? std::numeric_limits<double>::infinity() : step);
    } else if (children[index] > 1) {
      cluster_of[index] = f;
    }
  }
  for (int f = kRoot + 1; f < count; ++f) {
    if (cluster_of[static_cast<std::size_t>(f)] != f) continue;
    Cluster cluster{f, {0, 0, 0}, 0.0F, robot_parts_, 0};
    double radius = 0.0;
    int members = 0;
    for (int i = 0; i < robot_parts_; ++i) {
      const Part& part = parts_[static_cast<std::size_t>(i)];
      if (cluster_of[static_cast<std::size_t>(part.frame)] != f) continue;
      const double around = Eigen::Map<const Eigen::Vector3f>(part.ball_center).norm() + part.ball_radius;
      radius = std::max(radius, reach[static_cast<std::size_t>(part.frame)] + around);
      cluster.begin = std::min(cluster.begin, i);
      cluster.end = i + 1;
      ++members;
    }
    cluster.radius = enlarged(radius, margin_);
    // Links may be listed in another order than branch by branch; then there is no range of parts.
    if (members == cluster.end - cluster.begin && members > 0 && std::isfinite(radius)) clusters_.push_back(cluster);
  }
}

Model World::model() const {
  return {frames_.data(),
          static_cast<int>(frames_.size()),
          parts_.data(),
          robot_parts_,
          static_cast<int>(parts_.size()),
          nodes_.data(),
          ranges_.data(),
          partners_.data(),
          clusters_.data(),
          static_cast<int>(clusters_.size())};
}

void World::sweep(const Query& query, std::vector<Unknown>& found, bool portable) const {
  thread_local std::vector<float> memory;
  const Model arrays = model();
  memory.resize(static_cast<std::size_t>(workspace_size(arrays)) + kAlignment / sizeof(float));
  const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
  float* const workspace = memory.data() + (kAlignment - address % kAlignment) % kAlignment / sizeof(float);
  static const bool fast = has_avx2();
  found.resize(partners_.size());
#if defined(OPPONENS_AVX2)
  const int count = fast && !portable ? sweep_avx2(arrays, query, workspace, found.data())
                                      : wide::sweep(arrays, query, workspace, found.data());
#else
  (void)portable;
  const int count = wide::sweep(arrays, query, workspace, found.data());
#endif
  found.resize(static_cast<std::size_t>(count));
}

}  // namespace opponens::robot::wide
