// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The sweep over kLanes configurations. Included by one .cpp for each instruction set (wide_lanes.hpp).
#pragma once

#include "robot/wide_trees.hpp"

namespace opponens::robot::wide {
namespace {

/// The positions of a frame's joint, angles brought into a turn in double precision.
[[gnu::always_inline]] inline V positions_of(const Frame& frame, const Query& query) {
  D q;
  for (int lane = 0; lane < kLanes; ++lane) q[lane] = query.q[lane][frame.joint];
  D position = q * frame.multiplier + frame.offset;
  if (frame.motion == Motion::turn) {
    const double magic = 6755399441055744.0;  // adding it rounds to an integer
    const D turns = (position * 0.15915494309189533577 + magic) - magic;
    position = position - turns * 6.28318530717958647693;
  }
  return __builtin_convertvector(position, V);
}

[[gnu::always_inline]] inline void place_frames(const Model& model, const Query& query, Pose* X) {
  X[kWorld] = {{{all(1), V{}, V{}}, {V{}, all(1), V{}}, {V{}, V{}, all(1)}}, {V{}, V{}, V{}}};
  const float* r = query.root;
  X[kRoot] = {{{all(r[0]), all(r[3]), all(r[6])}, {all(r[1]), all(r[4]), all(r[7])}, {all(r[2]), all(r[5]), all(r[8])}},
              {all(r[9]), all(r[10]), all(r[11])}};
  for (int f = kRoot + 1; f < model.frame_count; ++f) {
    const Frame& frame = model.frames[f];
    const Pose& parent = X[frame.parent];
    const float* c = frame.rotation;
    const float first[3] = {c[0], c[3], c[6]};
    const float second[3] = {c[1], c[4], c[7]};
    const float third[3] = {c[2], c[5], c[8]};
    const V3 a = rotated(parent, first);
    const V3 b = rotated(parent, second);
    Pose& own = X[f];
    own.column[2] = rotated(parent, third);
    own.p = moved(parent, frame.translation);
    const V position = positions_of(frame, query);
    if (frame.motion == Motion::turn) {
      V s;
      V k;
      sine_cosine(position, s, k);
      own.column[0] = {a.x * k + b.x * s, a.y * k + b.y * s, a.z * k + b.z * s};
      own.column[1] = {b.x * k - a.x * s, b.y * k - a.y * s, b.z * k - a.z * s};
    } else {
      own.column[0] = a;
      own.column[1] = b;
      const V3& axis = own.column[2];
      own.p = {own.p.x + axis.x * position, own.p.y + axis.y * position, own.p.z + axis.z * position};
    }
  }
}

/// What is computed when it is first asked for.
struct Scratch {
  const Model& model;
  const Pose* X;
  const V3* balls;  ///< [parts] centers
  LaneBox* boxes;   ///< [parts]
  bool* placed;     ///< [parts] boxes
};

[[gnu::always_inline]] inline const LaneBox& box_of(const Scratch& scratch, int index) {
  LaneBox& box = scratch.boxes[index];
  if (scratch.placed[index]) return box;
  scratch.placed[index] = true;
  const Part& part = scratch.model.parts[index];
  const Pose& X = scratch.X[part.frame];
  const float* a = part.box_axes;
  const float first[3] = {a[0], a[3], a[6]};
  const float second[3] = {a[1], a[4], a[7]};
  const float third[3] = {a[2], a[5], a[8]};
  box = {moved(X, part.box_center), {rotated(X, first), rotated(X, second), rotated(X, third)}};
  return box;
}
/// Lanes in which two parts whose balls meet may touch: boxes and cylinders, then trees.
[[gnu::always_inline]] inline unsigned parts_near(const Scratch& scratch, int i, int j, unsigned lanes) {
  const Model& model = scratch.model;
  const Part& a = model.parts[i];
  const Part& b = model.parts[j];
  const LaneBox& box_a = box_of(scratch, i);
  const LaneBox& box_b = box_of(scratch, j);
  lanes = with_filling(a, [&](const auto& in_a) {
    return with_filling(b, [&](const auto& in_b) { return boxes_near(box_a, in_a, box_b, in_b, lanes); });
  });
  if (lanes == 0 || (a.form != Form::other && b.form != Form::other)) return lanes;
  const Pose& X_a = scratch.X[a.frame];
  const Pose& X_b = scratch.X[b.frame];
  if (a.form != Form::other) return tree_near_box(model.nodes, b.root, X_b, box_a, a.half_extents, lanes);
  if (b.form != Form::other) return tree_near_box(model.nodes, a.root, X_a, box_b, b.half_extents, lanes);
  return trees_near(model.nodes, a.root, X_a, b.root, X_b, lanes);
}
/// Lanes of those given in which two parts touch for certain; none where one is known by its balls only.
[[gnu::always_inline]] inline unsigned parts_touch(const Scratch& scratch, int i, int j, unsigned lanes) {
  const Part& a = scratch.model.parts[i];
  const Part& b = scratch.model.parts[j];
  if (a.form == Form::other || b.form == Form::other) return 0;
  const LaneBox& box_a = scratch.boxes[i];
  const LaneBox& box_b = scratch.boxes[j];
  const float* h = a.half_extents;
  const float* g = b.half_extents;
  const float inwards = kInwards * scratch.model.margin;
  for (int k = 0; k < 3; ++k) {
    if (h[k] <= inwards || g[k] <= inwards) return 0;
  }
  return with_filling(a, [&](const auto& in_a) {
    return with_filling(b, [&](const auto& in_b) { return boxes_touch(box_a, in_a, box_b, in_b, inwards, lanes); });
  });
}

/// Where the parts of the workspace begin, in floats.
struct Layout {
  int poses = 0;
  int balls;
  int centers;
  int rows;
  int boxes;
  int flags;
  int size;
};
[[gnu::always_inline]] inline Layout layout_of(const Model& model) {
  Layout layout{};
  layout.balls = layout.poses + model.frame_count * static_cast<int>(sizeof(Pose) / sizeof(float));
  layout.centers = layout.balls + model.part_count * static_cast<int>(sizeof(V3) / sizeof(float));
  layout.rows = layout.centers + model.group_count * static_cast<int>(sizeof(V3) / sizeof(float));
  layout.boxes = layout.rows + model.group_rows * static_cast<int>(sizeof(BoxRow) / sizeof(float));
  layout.flags = layout.boxes + model.part_count * static_cast<int>(sizeof(LaneBox) / sizeof(float));
  layout.size = layout.flags + (model.part_count + 3) / 4;
  return layout;
}

/// Whether a ball may meet a box of the scene, by lane.
[[gnu::always_inline]] inline Bits near_scene_box(const V3& center, const V& squared_radius, const SceneBox& box) {
  V3 d{center.x - lanes_at(box.center[0]), center.y - lanes_at(box.center[1]), center.z - lanes_at(box.center[2])};
  if (!box.aligned) {
    d = {d.x * lanes_at(box.axes[0]) + d.y * lanes_at(box.axes[3]) + d.z * lanes_at(box.axes[6]),
         d.x * lanes_at(box.axes[1]) + d.y * lanes_at(box.axes[4]) + d.z * lanes_at(box.axes[7]),
         d.x * lanes_at(box.axes[2]) + d.y * lanes_at(box.axes[5]) + d.z * lanes_at(box.axes[8])};
  }
  const V x = positive(magnitude(d.x) - lanes_at(box.half[0]));
  const V y = positive(magnitude(d.y) - lanes_at(box.half[1]));
  const V z = positive(magnitude(d.z) - lanes_at(box.half[2]));
  return x * x + y * y + z * z <= squared_radius;
}

/// Where the pairs that may touch are written.
struct Output {
  Unknown* found;
  int count;
  unsigned open;  ///< lanes still to be decided
  bool first_only;

  void add(int a, int b, unsigned near, unsigned touching) {
    found[count++] = {a, b, near, touching};
    open &= ~touching;
    if (first_only && touching != 0) open &= (touching & (0U - touching)) - 1U;
  }
};

/// Two parts whose balls meet in some lanes.
[[gnu::always_inline]] inline void check_pair(const Scratch& scratch, const PartPair& pair, unsigned lanes,
                                              Output& output) {
  const unsigned near = parts_near(scratch, pair.a, pair.b, lanes);
  if (near != 0) output.add(pair.a, pair.b, near, parts_touch(scratch, pair.a, pair.b, near));
}

/// The parts of two groups that meet in some lanes.
[[gnu::noinline]] void check_parts(const Scratch& scratch, const GroupPair& pairs, unsigned lanes, Output& output) {
  const PartPair* pair = scratch.model.part_pairs + pairs.begin;
  if (pairs.end - pairs.begin == 1) {  // what was asked of the groups says nearly all of their parts' balls
    check_pair(scratch, *pair, lanes, output);
    return;
  }
  const V3* const balls = scratch.balls;
  for (const PartPair* const last = scratch.model.part_pairs + pairs.end; pair != last; ++pair) {
    const V3 d = minus(balls[pair->a], balls[pair->b]);
    const unsigned near = lanes & lanes_of(dot(d, d) <= all(pair->squared_reach));
    if (near == 0) continue;
    check_pair(scratch, *pair, near, output);
    lanes &= output.open;
    if (lanes == 0) return;
  }
}

/// The least lane of each of kLanes numbers, side by side: halved three times.
[[gnu::always_inline]] inline V least_of_each(const V (&v)[kLanes]) {
  V pairs[4];
  for (int k = 0; k < 4; ++k) {
    pairs[k] = lesser(__builtin_shufflevector(v[2 * k], v[2 * k + 1], 0, 8, 2, 10, 4, 12, 6, 14),
                      __builtin_shufflevector(v[2 * k], v[2 * k + 1], 1, 9, 3, 11, 5, 13, 7, 15));
  }
  V fours[2];
  for (int k = 0; k < 2; ++k) {
    fours[k] = lesser(__builtin_shufflevector(pairs[2 * k], pairs[2 * k + 1], 0, 1, 8, 9, 4, 5, 12, 13),
                      __builtin_shufflevector(pairs[2 * k], pairs[2 * k + 1], 2, 3, 10, 11, 6, 7, 14, 15));
  }
  return lesser(__builtin_shufflevector(fours[0], fours[1], 0, 1, 2, 3, 8, 9, 10, 11),
                __builtin_shufflevector(fours[0], fours[1], 4, 5, 6, 7, 12, 13, 14, 15));
}

[[gnu::always_inline]] inline const V& coordinate(const V3& p, int axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// The boxes around a row of groups' balls of all lanes. Places beyond the last group repeat it.
[[gnu::always_inline]] inline void enclose(const Model& model, const V3* centers, int first, BoxRow& row) {
  typedef float Stored __attribute__((vector_size(4 * kLanes), may_alias));
  int group[kLanes];
  V radius;
  for (int place = 0; place < kLanes; ++place) {
    group[place] = first + place < model.group_count ? first + place : model.group_count - 1;
    radius[place] = model.groups[group[place]].radius;
  }
  for (int axis = 0; axis < 3; ++axis) {
    V v[kLanes];
    for (int place = 0; place < kLanes; ++place) v[place] = coordinate(centers[group[place]], axis);
    const V low = least_of_each(v);
    for (V& number : v) number = -number;
    const V high = -least_of_each(v);
    *reinterpret_cast<Stored*>(row.center[axis]) = 0.5F * (low + high);
    *reinterpret_cast<Stored*>(row.half[axis]) = 0.5F * (high - low) + radius;
  }
}

/// One box of a row in all lanes.
struct SpreadBox {
  V center[3];
  V half[3];
};
[[gnu::always_inline]] inline SpreadBox spread(const BoxRow* rows, int index) {
  const unsigned i = static_cast<unsigned>(index);
  const BoxRow& own = rows[i / kLanes];
  const auto lanes = [i](const float(&numbers)[kLanes]) { return all(numbers[i % kLanes]); };
  return {{lanes(own.center[0]), lanes(own.center[1]), lanes(own.center[2])},
          {lanes(own.half[0]), lanes(own.half[1]), lanes(own.half[2])}};
}

/// Which boxes of a row overlap the given one, as bits.
[[gnu::always_inline]] inline unsigned overlapping(const BoxRow& row, const SpreadBox& box) {
  Bits overlap = magnitude(lanes_at(row.center[0]) - box.center[0]) <= lanes_at(row.half[0]) + box.half[0];
  overlap &= magnitude(lanes_at(row.center[1]) - box.center[1]) <= lanes_at(row.half[1]) + box.half[1];
  overlap &= magnitude(lanes_at(row.center[2]) - box.center[2]) <= lanes_at(row.half[2]) + box.half[2];
  return lanes_of(overlap);
}

[[gnu::always_inline]] inline int run_sweep(const Model& model, const Query& query, float* workspace, Unknown* found) {
  const Layout layout = layout_of(model);
  Pose* const X = reinterpret_cast<Pose*>(workspace + layout.poses);
  V3* const balls = reinterpret_cast<V3*>(workspace + layout.balls);
  V3* const centers = reinterpret_cast<V3*>(workspace + layout.centers);
  BoxRow* const rows = reinterpret_cast<BoxRow*>(workspace + layout.rows);
  const Scratch scratch{model, X, balls, reinterpret_cast<LaneBox*>(workspace + layout.boxes),
                        reinterpret_cast<bool*>(workspace + layout.flags)};
  for (int i = 0; i < model.part_count; ++i) scratch.placed[i] = false;
  place_frames(model, query, X);
  for (int i = 0; i < model.robot_part_count; ++i)
    balls[i] = moved(X[model.parts[i].frame], model.parts[i].ball_center);
  for (int i = model.robot_part_count; i < model.part_count; ++i) {
    const float* c = model.parts[i].ball_center;
    balls[i] = {all(c[0]), all(c[1]), all(c[2])};
  }
  for (int g = 0; g < model.group_count; ++g) centers[g] = moved(X[model.groups[g].frame], model.groups[g].center);
  for (int r = 0; r < model.group_rows; ++r) enclose(model, centers, r * kLanes, rows[r]);
  Output output{found, 0, query.lanes, query.first_only};
  const GroupRow* partners = model.group_partners;
  const RowRange* range = model.group_ranges;
  for (int g = 0; g < model.group_count; ++g, ++range) {
    const SpreadBox own = spread(rows, g);
    for (const GroupRow* const end = partners + range->of_robot; partners != end; ++partners) {
      unsigned bits = partners->wanted & overlapping(rows[partners->row], own);
      for (; bits != 0; bits &= bits - 1) {
        const int place = __builtin_ctz(bits);
        const GroupPair& pair = model.pairs[partners->pairs + place];
        const V3 d = minus(centers[g], centers[partners->row * kLanes + place]);
        const unsigned near = output.open & lanes_of(dot(d, d) <= all(pair.squared_reach));
        if (near == 0) continue;
        check_parts(scratch, pair, near, output);
        if (output.open == 0) return output.count;
      }
    }
    for (const GroupRow* const end = partners + range->of_scene; partners != end; ++partners) {
      unsigned bits = partners->wanted & overlapping(model.scene_rows[partners->row], own);
      for (; bits != 0; bits &= bits - 1) {
        const int place = __builtin_ctz(bits);
        const GroupPair& pair = model.pairs[partners->pairs + place];
        const SceneBox& box = model.scene_boxes[partners->row * kLanes + place];
        const unsigned near = output.open & lanes_of(near_scene_box(centers[g], all(pair.squared_reach), box));
        if (near == 0) continue;
        check_parts(scratch, pair, near, output);
        if (output.open == 0) return output.count;
      }
    }
  }
  return output.count;
}

[[gnu::always_inline]] inline int farthest_point(const float* xyz, int count, const float* n) {
  typedef float Unaligned __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
  V best = all(-3e38F);
  Bits at{};
  Bits index{0, 1, 2, 3, 4, 5, 6, 7};
  for (int i = 0; i < count; i += kLanes) {
    const V x = *reinterpret_cast<const Unaligned*>(xyz + i);
    const V y = *reinterpret_cast<const Unaligned*>(xyz + count + i);
    const V z = *reinterpret_cast<const Unaligned*>(xyz + 2 * count + i);
    const V along = x * n[0] + y * n[1] + z * n[2];
    const Bits better = along > best;
    best = better ? along : best;
    at = better ? index : at;
    index += kLanes;
  }
  int lane = 0;
  for (int i = 1; i < kLanes; ++i) {
    if (best[i] > best[lane]) lane = i;
  }
  return at[lane];
}

}  // namespace
}  // namespace opponens::robot::wide
