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

constexpr double kMargin = 2e-5;        ///< of the largest coordinate
constexpr int kChain = 20;              ///< moving joints in a row that this is enough for
constexpr double kFarthest = 1e6;       ///< m; beyond it squares of lengths come near what a float can hold
constexpr double kGroupGrowth = 1.4;    ///< of the larger ball's radius, when two parts share one
constexpr std::size_t kAlignment = 64;  ///< bytes

float enlarged(double length, double margin) { return static_cast<float>(length + margin) * (1.0F + kRadiusRounding); }

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

PlacedPart placed(const CollisionShape& shape, const Isometry3d& X, double margin) {
  PlacedPart part;
  store(X * shape.center(), part.center);
  for (int k = 0; k < 3; ++k) store(X.linear().col(k), part.axis[k]);
  part.center[3] = enlarged(shape.half_extents()[0], margin);
  part.axis[0][3] = enlarged(shape.half_extents()[1], margin);
  part.axis[1][3] = enlarged(shape.half_extents()[2], margin);
  part.axis[2][3] = static_cast<float>(form_of(shape));
  return part;
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
    add_spread_part(source.shape, part.frame, ball.center, X_FG);
  }
}

/// Parts of the scene, whose frame is the world, are placed once and for all.
void World::add_spread_part(const CollisionShape& shape, int frame, const Vector3d& ball_center,
                            const Isometry3d& X_FG) {
  const PlacedPart at_frame = placed(shape, X_FG, single_margin());
  if (frame == kWorld) {
    scene_parts_.push_back(at_frame);
    return;
  }
  SpreadPart part{};
  part.frame = frame;
  for (int k = 0; k < 3; ++k) {
    for (int vector = 0; vector < 4; ++vector) {
      std::fill_n(part.box[vector / 2][k] + 4 * (vector % 2), 4,
                  vector == 0 ? at_frame.center[k] : at_frame.axis[vector - 1][k]);
      part.rest[vector / 2][4 * (vector % 2) + 3] = vector == 0 ? at_frame.center[3] : at_frame.axis[vector - 1][3];
    }
    std::fill_n(part.ball_center[k], 4, static_cast<float>((X_FG * ball_center)[k]));
  }
  spread_parts_.push_back(part);
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

Model World::model() const {
  const auto size = [](const auto& list) { return static_cast<int>(list.size()); };
  Model model;
  model.margin = static_cast<float>(margin_);
  model.single_margin = static_cast<float>(single_margin());
  model.frames = frames_.data();
  model.spread_frames = spread_frames_.data();
  model.frame_count = size(frames_);
  model.parts = parts_.data();
  model.spread_parts = spread_parts_.data();
  model.robot_part_count = robot_parts_;
  model.part_count = size(parts_);
  model.nodes = nodes_.data();
  model.groups = groups_.data();
  model.group_count = size(groups_);
  model.group_rows = group_rows();
  model.scene_boxes = scene_boxes_.data();
  model.scene_rows = scene_rows_.data();
  model.scene_row_count = size(scene_rows_);
  model.group_ranges = group_ranges_.data();
  model.group_partners = group_partners_.data();
  model.pairs = pairs_.data();
  model.part_pairs = part_pairs_.data();
  model.scene_parts = scene_parts_.data();
  model.part_rows = part_rows();
  model.partner_ranges = partner_ranges_.data();
  model.partners = partners_.data();
  return model;
}

bool World::holds(const double* q, int dof) const {
  const double largest = Eigen::Map<const Eigen::VectorXd>(q, dof).lpNorm<Eigen::Infinity>();
  return usable_ && largest <= kLargestPosition && std::all_of(slides_.begin(), slides_.end(), [&](const Slide& slide) {
           return q[slide.joint] >= slide.lower && q[slide.joint] <= slide.upper;
         });
}

/// Memory for a sweep; buffers.found holds every pair as well.
float* World::workspace(Buffers& buffers, const Model& model) const {
  const std::size_t size = static_cast<std::size_t>(workspace_size(model)) + kAlignment / sizeof(float);
  if (buffers.memory.size() < size) buffers.memory.resize(size);
  if (buffers.found.size() < part_pairs_.size()) buffers.found.resize(part_pairs_.size());
  const auto address = reinterpret_cast<std::uintptr_t>(buffers.memory.data());
  return buffers.memory.data() + (kAlignment - address % kAlignment) % kAlignment / sizeof(float);
}

template <typename AnyQuery>
int World::sweep(const AnyQuery& query, Buffers& buffers, bool portable) const {
  const Model arrays = model();
  float* const memory = workspace(buffers, arrays);
#if defined(OPPONENS_AVX2)
  static const bool fast = has_avx2();
  if (fast && !portable) return sweep_avx2(arrays, query, memory, buffers.found.data());
#endif
  (void)portable;
  return wide::sweep(arrays, query, memory, buffers.found.data());
}
template int World::sweep(const Query& query, Buffers& buffers, bool portable) const;
template int World::sweep(const SingleQuery& query, Buffers& buffers, bool portable) const;

}  // namespace opponens::robot::wide
