// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The sweep over one configuration, whose lanes are partners and pairs. Included by one .cpp for each instruction set
// (wide_lanes.hpp).
#pragma once

#include "robot/wide_places.hpp"
#include "robot/wide_trees.hpp"

namespace opponens::robot::wide {
namespace {

/// kLanes pairs of placed parts, or fewer that repeat the first.
struct PairLanes {
  int a[kLanes];
  int b[kLanes];
  const PlacedPart* placed_a[kLanes];
  const PlacedPart* placed_b[kLanes];
  int count = 0;

  void add(int i, const PlacedPart& at_i, int j, const PlacedPart& at_j) { set(count++, i, at_i, j, at_j); }
  void repeat_first() {
    for (int lane = count; lane < kLanes; ++lane) set(lane, a[0], *placed_a[0], b[0], *placed_b[0]);
  }

 private:
  void set(int lane, int i, const PlacedPart& at_i, int j, const PlacedPart& at_j) {
    a[lane] = i;
    b[lane] = j;
    placed_a[lane] = &at_i;
    placed_b[lane] = &at_j;
  }
};

/// One side of the pairs.
struct SideLanes {
  LaneBox box;
  V half[3];
  V form;
};
[[gnu::always_inline]] inline SideLanes gather(const PlacedPart* const (&parts)[kLanes]) {
  V first[kLanes];
  V second[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    first[lane] = lanes_at(parts[lane]->center);
    second[lane] = lanes_at(parts[lane]->axis[1]);
  }
  transpose(first);
  transpose(second);
  return {{{first[0], first[1], first[2]},
           {{first[4], first[5], first[6]}, {second[0], second[1], second[2]}, {second[4], second[5], second[6]}}},
          {first[3], first[7], second[3]},
          second[7]};
}

[[gnu::always_inline]] inline V3 spread(const F4& v) { return {all(v[0]), all(v[1]), all(v[2])}; }
[[gnu::always_inline]] inline V3 spread(const float (&v)[4]) { return {all(v[0]), all(v[1]), all(v[2])}; }
[[gnu::always_inline]] inline LaneBox spread(const PlacedPart& part) {
  return {spread(part.center), {spread(part.axis[0]), spread(part.axis[1]), spread(part.axis[2])}};
}
[[gnu::always_inline]] inline Pose spread(const RoundedPose& X) {
  return {{spread(X.column[0]), spread(X.column[1]), spread(X.column[2])}, spread(X.p)};
}

/// Whether two parts, of which one is known by its sphere tree, may touch.
[[gnu::noinline]] bool trees_may_touch(const SingleScratch& scratch, int i, int j) {
  const Model& model = scratch.model;
  const Part& a = model.parts[i];
  const Part& b = model.parts[j];
  const Pose X_a = spread(scratch.X[a.frame]);
  const Pose X_b = spread(scratch.X[b.frame]);
  if (a.form != Form::other) {
    return tree_near_box(model.nodes, b.root, X_b, spread(place(scratch, i)), a.half_extents, 1U) != 0;
  }
  if (b.form != Form::other) {
    return tree_near_box(model.nodes, a.root, X_a, spread(place(scratch, j)), b.half_extents, 1U) != 0;
  }
  return trees_near(model.nodes, a.root, X_a, b.root, X_b, 1U) != 0;
}

/// Writes the pairs that may touch to found. Returns whether one touches for certain, which is then the last.
[[gnu::noinline]] bool decide(const SingleScratch& scratch, PairLanes& pairs, Unknown* found, int& count) {
  const unsigned asked = (1U << pairs.count) - 1U;
  pairs.repeat_first();
  pairs.count = 0;
  const SideLanes a = gather(pairs.placed_a);
  const SideLanes b = gather(pairs.placed_b);
  unsigned near = boxes_near(a.box, Cuboids{a.half}, b.box, Cuboids{b.half}, asked);
  if (near == 0) return false;
  const Mixture in_a{a.half, a.form == static_cast<float>(Form::cylinder)};
  const Mixture in_b{b.half, b.form == static_cast<float>(Form::cylinder)};
  if ((near & lanes_of(in_a.round_lanes | in_b.round_lanes)) != 0) near = boxes_near(a.box, in_a, b.box, in_b, near);
  const float other = static_cast<float>(Form::other);
  const unsigned trees = near & lanes_of((a.form == other) | (b.form == other));
  const float inwards = kInwards * scratch.model.single_margin;
  const V least =
      lesser(lesser(lesser(a.half[0], a.half[1]), lesser(b.half[0], b.half[1])), lesser(a.half[2], b.half[2]));
  const unsigned solid = near & ~trees & lanes_of(least > inwards);
  const unsigned touching = solid != 0 ? boxes_touch(a.box, in_a, b.box, in_b, inwards, solid) : 0;
  if (touching != 0) near = touching;
  for (; near != 0; near &= near - 1) {
    const int lane = __builtin_ctz(near);
    if ((trees >> lane & 1U) != 0 && !trees_may_touch(scratch, pairs.a[lane], pairs.b[lane])) continue;
    found[count++] = {pairs.a[lane], pairs.b[lane], 1U, touching >> lane & 1U};
  }
  return touching != 0;
}

/// Where the parts of the workspace begin, in floats.
struct SingleLayout {
  int poses = 0;
  int rounded;
  int joints;
  int joint_rows;
  int parts;
  int balls;
  int flags;
  int size;
};
[[gnu::always_inline]] inline SingleLayout single_layout_of(const Model& model) {
  const auto floats = [](auto bytes) { return static_cast<int>(bytes / sizeof(float)); };
  SingleLayout layout{};
  layout.joint_rows = (model.frame_count - kRoot - 1 + kLanes - 1) / kLanes;
  layout.rounded = layout.poses + model.frame_count * floats(sizeof(ExactPose));
  layout.joints = layout.rounded + model.frame_count * floats(sizeof(RoundedPose));
  layout.parts = layout.joints + 3 * layout.joint_rows * floats(sizeof(D));
  layout.balls = layout.parts + model.robot_part_count * floats(sizeof(PlacedPart));
  layout.flags = layout.balls + model.part_rows * floats(sizeof(V3));
  layout.size = layout.flags + (model.robot_part_count + 3) / 4;
  return layout;
}

/// Partners in a row of balls that one about the center meets.
[[gnu::always_inline]] inline unsigned meeting(const PartnerRow& partners, const V3& balls, const V3& center) {
  const V3 d = minus(balls, center);
  return partners.wanted & lanes_of(dot(d, d) <= lanes_at(partners.squared_reach));
}

/// The same in a row of boxes of the scene.
[[gnu::always_inline]] inline unsigned meeting(const PartnerRow& partners, const BoxRow& boxes, const V3& center) {
  const V x = positive(magnitude(lanes_at(boxes.center[0]) - center.x) - lanes_at(boxes.half[0]));
  const V y = positive(magnitude(lanes_at(boxes.center[1]) - center.y) - lanes_at(boxes.half[1]));
  const V z = positive(magnitude(lanes_at(boxes.center[2]) - center.z) - lanes_at(boxes.half[2]));
  return partners.wanted & lanes_of(x * x + y * y + z * z <= lanes_at(partners.squared_reach));
}

/// Pairs that are collected until all lanes are taken, and what was found of those before.
struct Pending {
  const SingleScratch scratch;
  Unknown* found;
  int count = 0;
  PairLanes pairs;

  /// Adds part i and those of the partners' bits, of which the first is `first`. Returns whether a pair touches.
  [[gnu::noinline]] bool add(int i, int first, unsigned bits) {
    const PlacedPart& own = place(scratch, i);
    for (; bits != 0; bits &= bits - 1) {
      const int j = first + __builtin_ctz(bits);
      pairs.add(i, own, j, place(scratch, j));
      if (pairs.count == kLanes && decide(scratch, pairs, found, count)) return true;
    }
    return false;
  }
};

[[gnu::always_inline]] inline int run_single(const Model& model, const SingleQuery& query, float* workspace,
                                             Unknown* found) {
  const SingleLayout layout = single_layout_of(model);
  D* const joints = reinterpret_cast<D*>(workspace + layout.joints);
  const Turns turns{joints, joints + layout.joint_rows, joints + 2 * layout.joint_rows};
  RoundedPose* const X = reinterpret_cast<RoundedPose*>(workspace + layout.rounded);
  V3* const balls = reinterpret_cast<V3*>(workspace + layout.balls);
  const int robot_parts = model.robot_part_count;
  const SingleScratch scratch{model,
                              X,
                              model.spread_parts,
                              model.scene_parts,
                              reinterpret_cast<PlacedPart*>(workspace + layout.parts),
                              reinterpret_cast<bool*>(workspace + layout.flags),
                              robot_parts};
  for (int i = 0; i < robot_parts; ++i) scratch.placed[i] = false;
  place_joints(model, query.q, turns);
  place_frames(model, query, turns, reinterpret_cast<ExactPose*>(workspace + layout.poses), X);
  place_balls(X, model.spread_parts, robot_parts, balls);
  Pending pending{scratch, found, 0, {}};
  const PartnerRow* partners = model.partners;
  const RowRange* range = model.partner_ranges;
  const BoxRow* const scene_rows = model.scene_rows;
  for (int i = 0; i < robot_parts; ++i, ++range) {
    const V3 center = place_of(balls, i);
    for (const PartnerRow* const end = partners + range->of_robot; partners != end; ++partners) {
      const unsigned bits = meeting(*partners, balls[partners->row], center);
      if (bits != 0 && pending.add(i, partners->row * kLanes, bits)) return pending.count;
    }
    for (const PartnerRow* const end = partners + range->of_scene; partners != end; ++partners) {
      const unsigned bits = meeting(*partners, scene_rows[partners->row], center);
      if (bits != 0 && pending.add(i, robot_parts + partners->row * kLanes, bits)) return pending.count;
    }
  }
  if (pending.pairs.count > 0) decide(scratch, pending.pairs, found, pending.count);
  return pending.count;
}

}  // namespace
}  // namespace opponens::robot::wide
