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
constexpr int kChain = 20;                  ///< moving joints in a row that this is enough for
constexpr double kFarthest = 1e6;           ///< m; beyond it squares of lengths come near what a float can hold
constexpr double kSlideSlack = 0.01;        ///< m, of sliding joints beyond their limits
constexpr double kGroupGrowth = 1.4;        ///< of the larger ball's radius, when two parts share one
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

/// A rotation that turns the z axis into the given one: orthonormal to rounding for every axis, as the quaternion from
/// two vectors is not when they are nearly opposite (by 5e-5 for an axis 1e-6 off -z).
Eigen::Matrix3d z_onto(const Vector3d& axis) {
  Eigen::Matrix3d R;
  R.col(2) = axis.normalized();
  R.col(0) = R.col(2).unitOrthogonal();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

Isometry3d turned(const Eigen::Matrix3d& R) {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = R;
  return X;
}

Form form_of(const CollisionShape& shape) {
  if (std::holds_alternative<Box>(shape.shape())) return Form::box;
  return std::holds_alternative<Cylinder>(shape.shape()) ? Form::cylinder : Form::other;
}

SphereTree::Node bounding_ball(const CollisionShape& shape) {
  if (form_of(shape) == Form::other) return shape.cover().nodes[0];
  return {shape.center(), shape.radius(), 0, 0};
}

/// A ball that grows around others.
struct Ball {
  Vector3d center = Vector3d::Zero();
  double radius = -1.0;  ///< m; negative: nothing yet

  void add(const Ball& other) {
    if (radius < 0.0) {
      *this = other;
      return;
    }
    const double apart = (other.center - center).norm();
    if (apart + other.radius <= radius) return;
    if (!(apart + radius > other.radius)) {
      *this = other;
      return;
    }
    const double joined = 0.5 * (apart + radius + other.radius);
    if (apart > 0.0 && std::isfinite(joined)) center += (joined - radius) / apart * (other.center - center);
    radius = joined;
  }
};

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
      largest = std::max(largest, reach.center.norm() + reach.radius + largest_coordinate(part, X_FL_[link]));
    }
  }
  // A robot that flies may be as far away again (contains).
  largest_ = fixed_root ? largest : 2.0 * largest;
  const int chain = *std::max_element(depth_.begin(), depth_.end());
  margin_ = kMargin * largest_ * std::max(1.0, static_cast<double>(chain) / kChain);
  usable_ = margin_ <= kMargin * kFarthest;
  add_parts(world);
  add_groups();
  add_checks(world, fixed_root);
}

/// Links joined by joints that do not move share a frame. A joint's frame has its axis as z.
void World::add_frames(const RobotModel& robot) {
  const Frame still{kWorld, Motion::none, -1, 1.0, 0.0, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
  frames_ = {still, still};
  reach_ = {{Vector3d::Zero(), 0.0}, {Vector3d::Zero(), 0.0}};
  depth_ = {0, 0};
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
    const Isometry3d X_PF = X_FL_[parent_link] * joint.X_PJ * turned(Q);
    Frame frame = still;
    frame.parent = parent;
    frame.motion = joint.type == JointType::revolute ? Motion::turn : Motion::slide;
    frame.joint = drive.index;
    frame.multiplier = drive.multiplier;
    frame.offset = drive.offset;
    store_rotation(X_PF.linear(), frame.rotation);
    store(X_PF.translation(), frame.translation);
    const Reach before = reach_[static_cast<std::size_t>(parent)];
    Reach reach = parent == kRoot ? Reach{X_PF.translation(), 0.0}
                                  : Reach{before.center, before.radius + X_PF.translation().norm()};
    if (frame.motion == Motion::slide) {
      const Slide slide{frame.joint, robot.lower()[frame.joint] - kSlideSlack,
                        robot.upper()[frame.joint] + kSlideSlack};
      slides_.push_back(slide);
      reach.radius += std::max(std::abs(frame.multiplier * slide.lower + frame.offset),
                               std::abs(frame.multiplier * slide.upper + frame.offset));
    }
    reach_.push_back(reach);
    depth_.push_back(depth_[static_cast<std::size_t>(parent)] + 1);
    frame_of_link_.push_back(static_cast<int>(frames_.size()));
    X_FL_.push_back(turned(Q.transpose()));
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

/// Successive parts of a frame share a ball unless that makes it much larger than theirs.
void World::add_groups() {
  for (int i = 0; i < robot_parts_; ++i) {
    const Part& part = parts_[static_cast<std::size_t>(i)];
    const Ball own{Eigen::Map<const Eigen::Vector3f>(part.ball_center).cast<double>(), part.ball_radius};
    if (!groups_.empty() && groups_.back().frame == part.frame) {
      Group& last = groups_.back();
      Ball joined{Eigen::Map<const Eigen::Vector3f>(last.center).cast<double>(), last.radius};
      const double larger = std::max(joined.radius, own.radius);
      joined.add(own);
      if (joined.radius <= kGroupGrowth * larger) {
        store(joined.center, last.center);
        last.radius = enlarged(joined.radius, 0.01 * margin_);  // the center is rounded
        group_of_.push_back(group_of_.back());
        continue;
      }
    }
    group_of_.push_back(static_cast<int>(groups_.size()));
    Group group{part.frame, {}, part.ball_radius};
    std::copy_n(part.ball_center, 3, group.center);
    groups_.push_back(group);
  }
}

int World::group_rows() const { return (static_cast<int>(groups_.size()) + kLanes - 1) / kLanes; }

void World::add_checks(const CollisionWorld& world, bool fixed_root) {
  const int scene_parts = static_cast<int>(parts_.size()) - robot_parts_;
  for (int j = 0; j < scene_parts; ++j) add_scene_box(parts_[static_cast<std::size_t>(robot_parts_ + j)]);
  for (int row = 0; row * kLanes < scene_parts; ++row) add_scene_row(row);
  std::vector<std::vector<PartPair>> pairs(groups_.size());
  for (int i = 0; i < robot_parts_; ++i) {
    const Part& part = parts_[static_cast<std::size_t>(i)];
    for (const int j : world.partners[static_cast<std::size_t>(i)]) {
      const Part& other = parts_[static_cast<std::size_t>(j)];
      const float reach = part.ball_radius + other.ball_radius;
      if (part.frame == other.frame || (fixed_root && part.frame == kRoot && other.frame == kWorld)) {
        constant_pairs_.emplace_back(i, j);
      } else {
        pairs[static_cast<std::size_t>(group_of_[static_cast<std::size_t>(i)])].push_back({i, j, reach * reach});
      }
    }
  }
  for (int group = 0; group < static_cast<int>(groups_.size()); ++group) {
    add_checks_of(group, pairs[static_cast<std::size_t>(group)], fixed_root);
  }
}

/// pairs: of the parts of one group, each with later parts.
void World::add_checks_of(int group, const std::vector<PartPair>& pairs, bool fixed_root) {
  const int rows = group_rows() + static_cast<int>(scene_rows_.size());
  const float radius = groups_[static_cast<std::size_t>(group)].radius;
  for (int row = 0; row < rows; ++row) {
    unsigned char wanted = 0;
    for (int place = 0; place < kLanes; ++place) {
      const int begin = static_cast<int>(part_pairs_.size());
      const bool scene = row >= group_rows();
      const int partner = (scene ? row - group_rows() : row) * kLanes + place;
      float reach = radius;
      for (const PartPair& pair : pairs) {
        const bool of_scene = pair.b >= robot_parts_;
        const int own = of_scene ? pair.b - robot_parts_ : group_of_[static_cast<std::size_t>(pair.b)];
        if (of_scene != scene || own != partner) continue;
        if (scene && fixed_root && out_of_reach(group, parts_[static_cast<std::size_t>(pair.b)])) continue;
        if (!scene) reach = radius + groups_[static_cast<std::size_t>(partner)].radius;
        part_pairs_.push_back(pair);
      }
      const int end = static_cast<int>(part_pairs_.size());
      if (end > begin) wanted = static_cast<unsigned char>(wanted | 1U << place);
      pairs_.push_back({reach * reach, begin, end});
    }
    wanted_.push_back(wanted);
  }
}

/// Boxes with the root's axes around kLanes parts of the scene.
void World::add_scene_row(int row) {
  BoxRow boxes;
  for (int place = 0; place < kLanes; ++place) {
    const std::size_t index = static_cast<std::size_t>(robot_parts_ + row * kLanes + place);
    for (int axis = 0; axis < 3; ++axis) {
      float half = -std::numeric_limits<float>::max();  // overlaps nothing
      if (index < parts_.size()) {
        const Part& part = parts_[index];
        half = 0.0F;
        for (int k = 0; k < 3; ++k) half += std::abs(part.box_axes[3 * axis + k]) * part.half_extents[k];
        half *= 1.0F + kRadiusRounding;
        boxes.center[axis][place] = part.box_center[axis];
      } else {
        boxes.center[axis][place] = 0.0F;
      }
      boxes.half[axis][place] = half;
    }
  }
  scene_rows_.push_back(boxes);
}

void World::add_scene_box(const Part& part) {
  SceneBox box;
  const auto fill = [](float* lanes, float value) { std::fill_n(lanes, kLanes, value); };
  for (int k = 0; k < 3; ++k) {
    fill(box.center[k], part.box_center[k]);
    fill(box.half[k], part.half_extents[k]);
  }
  for (int k = 0; k < 9; ++k) fill(box.axes[k], part.box_axes[k]);
  const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> axes(part.box_axes);
  box.aligned = axes.isIdentity(0.0F);
  scene_boxes_.push_back(box);
}

/// Whether a group of the robot never meets a part of the scene, wherever the joints turn.
bool World::out_of_reach(int group, const Part& other) const {
  const Group& own = groups_[static_cast<std::size_t>(group)];
  const Reach& reach = reach_[static_cast<std::size_t>(own.frame)];
  const OrientedBox box{Eigen::Map<const Eigen::Vector3f>(other.box_center).cast<double>(),
                        Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(other.box_axes).cast<double>(),
                        Eigen::Map<const Eigen::Vector3f>(other.half_extents).cast<double>()};
  const double around = Eigen::Map<const Eigen::Vector3f>(own.center).cast<double>().norm() + own.radius;
  return point_box_distance(reach.center, box) > reach.radius + around + margin_;
}

Model World::model() const {
  const auto size = [](const auto& list) { return static_cast<int>(list.size()); };
  Model model;
  model.margin = static_cast<float>(margin_);
  model.frames = frames_.data();
  model.frame_count = size(frames_);
  model.parts = parts_.data();
  model.robot_part_count = robot_parts_;
  model.part_count = size(parts_);
  model.nodes = nodes_.data();
  model.groups = groups_.data();
  model.group_count = size(groups_);
  model.group_rows = group_rows();
  model.scene_boxes = scene_boxes_.data();
  model.scene_rows = scene_rows_.data();
  model.scene_row_count = size(scene_rows_);
  model.wanted = wanted_.data();
  model.pairs = pairs_.data();
  model.part_pairs = part_pairs_.data();
  return model;
}

bool World::holds(const double* q, int dof) const {
  const double largest = Eigen::Map<const Eigen::VectorXd>(q, dof).lpNorm<Eigen::Infinity>();
  return usable_ && largest <= kLargestPosition && std::all_of(slides_.begin(), slides_.end(), [&](const Slide& slide) {
           return q[slide.joint] >= slide.lower && q[slide.joint] <= slide.upper;
         });
}

int World::sweep(const Query& query, Buffers& buffers, bool portable) const {
  const Model arrays = model();
  const std::size_t size = static_cast<std::size_t>(workspace_size(arrays)) + kAlignment / sizeof(float);
  if (buffers.memory.size() < size) buffers.memory.resize(size);
  if (buffers.found.size() < part_pairs_.size()) buffers.found.resize(part_pairs_.size());
  const auto address = reinterpret_cast<std::uintptr_t>(buffers.memory.data());
  float* const workspace = buffers.memory.data() + (kAlignment - address % kAlignment) % kAlignment / sizeof(float);
#if defined(OPPONENS_AVX2)
  static const bool fast = has_avx2();
  if (fast && !portable) return sweep_avx2(arrays, query, workspace, buffers.found.data());
#endif
  (void)portable;
  return wide::sweep(arrays, query, workspace, buffers.found.data());
}

}  // namespace opponens::robot::wide
