// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The wide sweep's source, included by one .cpp for each instruction set. Everything here has internal linkage, so that
// no code made for one processor can be linked into a path for another.
#pragma once

#include "robot/wide_model.hpp"

namespace opponens::robot::wide {
namespace {

typedef float V __attribute__((vector_size(4 * kLanes)));
typedef int Bits __attribute__((vector_size(4 * kLanes)));
typedef double D __attribute__((vector_size(8 * kLanes)));

struct V3 {
  V x, y, z;
};

/// A pose: rotation by columns, translation.
struct Pose {
  V3 column[3];
  V3 p;
};

/// Added to the size of a cosine: more than its rounding, and than the axes of a chain of 40 joints are off a right
/// angle (2e-7 for each).
constexpr float kParallel = 1e-5F;

/// A box with lanes: axes by columns.
struct LaneBox {
  V3 center;
  V3 axis[3];
};

[[gnu::always_inline]] inline V all(float value) { return V{} + value; }

[[gnu::always_inline]] inline unsigned lanes_of(const Bits& condition) {
#if defined(__AVX__)
  return static_cast<unsigned>(__builtin_ia32_movmskps256(__builtin_bit_cast(V, condition)));
#elif defined(__SSE__)
  typedef float Half __attribute__((vector_size(2 * kLanes), may_alias));
  const Half* const half = reinterpret_cast<const Half*>(&condition);
  return static_cast<unsigned>(__builtin_ia32_movmskps(half[0]) | (__builtin_ia32_movmskps(half[1]) << 4));
#else
  unsigned lanes = 0;
  for (int i = 0; i < kLanes; ++i) lanes |= (condition[i] < 0 ? 1U : 0U) << i;
  return lanes;
#endif
}

[[gnu::always_inline]] inline V magnitude(const V& v) {
  const Bits bits = __builtin_bit_cast(Bits, v) & 0x7fffffff;
  return __builtin_bit_cast(V, bits);
}
[[gnu::always_inline]] inline V positive(const V& v) { return v > 0.0F ? v : V{}; }

[[gnu::always_inline]] inline V lesser(const V& a, const V& b) { return a < b ? a : b; }
[[gnu::always_inline]] inline V greater(const V& a, const V& b) { return a > b ? a : b; }

[[gnu::always_inline]] inline V dot(const V3& a, const V3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[gnu::always_inline]] inline V3 minus(const V3& a, const V3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

[[gnu::always_inline]] inline V3 rotated(const Pose& X, const float* v) {
  return {X.column[0].x * v[0] + X.column[1].x * v[1] + X.column[2].x * v[2],
          X.column[0].y * v[0] + X.column[1].y * v[1] + X.column[2].y * v[2],
          X.column[0].z * v[0] + X.column[1].z * v[1] + X.column[2].z * v[2]};
}
[[gnu::always_inline]] inline V3 moved(const Pose& X, const float* p) {
  const V3 r = rotated(X, p);
  return {r.x + X.p.x, r.y + X.p.y, r.z + X.p.z};
}

/// Sine and cosine of angles within a turn, to 1e-7 (polynomials on [-pi/4, pi/4]: Cephes' sinf and cosf).
[[gnu::always_inline]] inline void sine_cosine(const V& angle, V& sine, V& cosine) {
  const V magic = all(12582912.0F);  // adding it rounds to an integer
  const V quadrant = (angle * 0.636619772F + magic) - magic;
  const V r =
      ((angle - quadrant * 1.5703125F) - quadrant * 4.837512969970703125e-4F) - quadrant * 7.549789948768648e-8F;
  const V z = r * r;
  const V s = r + r * z * (-1.6666654611e-1F + z * (8.3321608736e-3F - z * 1.9515295891e-4F));
  const V c =
      1.0F - 0.5F * z + z * z * (4.166664568298827e-2F + z * (-1.388731625493765e-3F + z * 2.443315711809948e-5F));
  const Bits k = __builtin_convertvector(quadrant, Bits);
  const Bits odd = (k & 1) != 0;
  const V sine_magnitude = odd ? c : s;
  const V cosine_magnitude = odd ? s : c;
  const Bits sine_sign = (k & 2) << 30;
  const Bits cosine_sign = ((k + 1) & 2) << 30;
  const Bits sine_bits = __builtin_bit_cast(Bits, sine_magnitude) ^ sine_sign;
  const Bits cosine_bits = __builtin_bit_cast(Bits, cosine_magnitude) ^ cosine_sign;
  sine = __builtin_bit_cast(V, sine_bits);
  cosine = __builtin_bit_cast(V, cosine_bits);
}

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

/// Lanes in which a ball may meet a box.
[[gnu::always_inline]] inline unsigned near_box(const V3& center, const V& radius, const LaneBox& box,
                                                const float* half) {
  const V3 d = minus(center, box.center);
  const V x = positive(magnitude(dot(d, box.axis[0])) - half[0]);
  const V y = positive(magnitude(dot(d, box.axis[1])) - half[1]);
  const V z = positive(magnitude(dot(d, box.axis[2])) - half[2]);
  return lanes_of(x * x + y * y + z * z <= radius * radius);
}

/// Lane by lane, for want of a vector square root that is the same everywhere.
[[gnu::always_inline]] inline V root(const V& v) {
  V r;
  for (int i = 0; i < kLanes; ++i) r[i] = __builtin_sqrtf(v[i]);
  return r;
}

/// How far a box, or the cylinder about its z axis, reaches along a direction with components x, y, z >= 0 in it.
template <bool Round>
[[gnu::always_inline]] inline V extent(const float* h, const V& x, const V& y, const V& z) {
  return Round ? V(h[0] * root(x * x + y * y) + h[2] * z) : V(h[0] * x + h[1] * y + h[2] * z);
}

/// Lanes in which none of these directions keeps two boxes, or the cylinders in them, apart: the 15 axes of the
/// separating axis theorem (Gottschalk 1996), and for a cylinder that across its axis towards the other's center. Cross
/// products that nearly vanish say nothing wrong: both sides of the test shrink with them, but for what enlarges the
/// shapes.
template <bool RoundA, bool RoundB>
[[gnu::noinline]] unsigned boxes_near(const LaneBox& a, const float* h, const LaneBox& b, const float* g,
                                      unsigned lanes) {
  const V3 d = minus(b.center, a.center);
  V R[3][3];
  V Q[3][3];
  V t[3];
  V s[3];
  for (int i = 0; i < 3; ++i) {
    t[i] = dot(d, a.axis[i]);
    s[i] = dot(d, b.axis[i]);
    for (int j = 0; j < 3; ++j) {
      R[i][j] = dot(a.axis[i], b.axis[j]);
      Q[i][j] = magnitude(R[i][j]) + kParallel;
    }
  }
  Bits apart{};
  for (int i = 0; i < 3; ++i) apart |= magnitude(t[i]) > h[i] + extent<RoundB>(g, Q[i][0], Q[i][1], Q[i][2]);
  for (int j = 0; j < 3; ++j) apart |= magnitude(s[j]) > g[j] + extent<RoundA>(h, Q[0][j], Q[1][j], Q[2][j]);
  lanes &= ~lanes_of(apart);
  if (lanes == 0) return 0;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      V in_a[3];
      V in_b[3];
      in_a[i] = V{};
      in_a[i1] = Q[i2][j];
      in_a[i2] = Q[i1][j];
      in_b[j] = V{};
      in_b[j1] = Q[i][j2];
      in_b[j2] = Q[i][j1];
      apart |= magnitude(t[i2] * R[i1][j] - t[i1] * R[i2][j]) >
               extent<RoundA>(h, in_a[0], in_a[1], in_a[2]) + extent<RoundB>(g, in_b[0], in_b[1], in_b[2]);
    }
  }
  if (RoundA) {  // t[0] A_x + t[1] A_y
    const V x = magnitude(t[0] * R[0][0] + t[1] * R[1][0]) + kParallel;
    const V y = magnitude(t[0] * R[0][1] + t[1] * R[1][1]) + kParallel;
    const V z = magnitude(t[0] * R[0][2] + t[1] * R[1][2]) + kParallel;
    const V across = t[0] * t[0] + t[1] * t[1];
    apart |= across > h[0] * root(across) + extent<RoundB>(g, x, y, z);
  }
  if (RoundB) {  // s[0] B_x + s[1] B_y
    const V x = magnitude(s[0] * R[0][0] + s[1] * R[0][1]) + kParallel;
    const V y = magnitude(s[0] * R[1][0] + s[1] * R[1][1]) + kParallel;
    const V z = magnitude(s[0] * R[2][0] + s[1] * R[2][1]) + kParallel;
    const V across = s[0] * s[0] + s[1] * s[1];
    apart |= across > g[0] * root(across) + extent<RoundA>(h, x, y, z);
  }
  return lanes & ~lanes_of(apart);
}

constexpr int kStack = 256;  ///< entries of a descent; wider trees end it with "unknown"

/// Lanes in which a leaf of the tree may meet the box.
[[gnu::noinline]] unsigned tree_near_box(const Node* nodes, int root, const Pose& X, const LaneBox& box,
                                         const float* half, unsigned lanes) {
  struct Entry {
    int node;
    unsigned lanes;
  };
  Entry stack[kStack];
  int size = 0;
  stack[size++] = {root, lanes};
  unsigned unknown = 0;
  while (size > 0) {
    const Entry entry = stack[--size];
    const Node& node = nodes[entry.node];
    const unsigned asked = entry.lanes & ~unknown;
    if (asked == 0) continue;
    const unsigned near = asked & near_box(moved(X, node.center), all(node.radius), box, half);
    if (near == 0) continue;
    if (node.children == 0 || size + node.children > kStack) {
      unknown |= near;
      if (unknown == lanes) break;
    } else {
      for (int child = 0; child < node.children; ++child) stack[size++] = {node.first_child + child, near};
    }
  }
  return unknown;
}

/// Lanes in which leaves of two trees may meet.
[[gnu::noinline]] unsigned trees_near(const Node* nodes, int root_a, const Pose& X_a, int root_b, const Pose& X_b,
                                      unsigned lanes) {
  struct Entry {
    int a;
    int b;
    unsigned lanes;
  };
  Entry stack[kStack];
  int size = 0;
  stack[size++] = {root_a, root_b, lanes};
  unsigned unknown = 0;
  while (size > 0) {
    const Entry entry = stack[--size];
    const Node& a = nodes[entry.a];
    const Node& b = nodes[entry.b];
    const unsigned asked = entry.lanes & ~unknown;
    if (asked == 0) continue;
    const V3 d = minus(moved(X_a, a.center), moved(X_b, b.center));
    const V reach = all(a.radius + b.radius);
    const unsigned near = asked & lanes_of(dot(d, d) <= reach * reach);
    if (near == 0) continue;
    const bool divide_a = b.children == 0 || (a.children > 0 && a.radius >= b.radius);
    const int children = divide_a ? a.children : b.children;
    if (children == 0 || size + children > kStack) {
      unknown |= near;
      if (unknown == lanes) break;
      continue;
    }
    for (int child = 0; child < children; ++child) {
      stack[size++] =
          divide_a ? Entry{a.first_child + child, entry.b, near} : Entry{entry.a, b.first_child + child, near};
    }
  }
  return unknown;
}

/// Lanes in which two parts whose balls meet may touch: boxes and cylinders, then trees.
[[gnu::always_inline]] inline unsigned parts_near(const Scratch& scratch, int i, int j, unsigned lanes) {
  const Model& model = scratch.model;
  const Part& a = model.parts[i];
  const Part& b = model.parts[j];
  const LaneBox& box_a = box_of(scratch, i);
  const LaneBox& box_b = box_of(scratch, j);
  const float* h = a.half_extents;
  const float* g = b.half_extents;
  if (a.form == Form::cylinder) {
    lanes = b.form == Form::cylinder ? boxes_near<true, true>(box_a, h, box_b, g, lanes)
                                     : boxes_near<true, false>(box_a, h, box_b, g, lanes);
  } else {
    lanes = b.form == Form::cylinder ? boxes_near<false, true>(box_a, h, box_b, g, lanes)
                                     : boxes_near<false, false>(box_a, h, box_b, g, lanes);
  }
  if (lanes == 0 || (a.form != Form::other && b.form != Form::other)) return lanes;
  const Pose& X_a = scratch.X[a.frame];
  const Pose& X_b = scratch.X[b.frame];
  if (a.form != Form::other) return tree_near_box(model.nodes, b.root, X_b, box_a, h, lanes);
  if (b.form != Form::other) return tree_near_box(model.nodes, a.root, X_a, box_b, g, lanes);
  return trees_near(model.nodes, a.root, X_a, b.root, X_b, lanes);
}

/// Takes a point, given in the frame of a box or the cylinder in it, towards the nearest one of its solid made smaller
/// by `inwards` (less than any half extent). Returns the lanes in which it was within the solid made smaller by half of
/// that.
template <bool Round>
[[gnu::always_inline]] inline unsigned draw_into(const float* half, float inwards, V3& p) {
  const auto clamp = [](const V& v, float most) { return greater(lesser(v, all(most)), all(-most)); };
  const float slack = 0.5F * inwards;
  Bits inside = magnitude(p.z) <= half[2] - slack;
  if (Round) {
    const V across = p.x * p.x + p.y * p.y;
    const float within = half[0] - slack;
    const V radius = root(across);
    inside &= across < within * within;
    const V shrink = lesser(all(1), (half[0] - inwards) / greater(radius, all(1e-12F)));
    p.x = p.x * shrink;
    p.y = p.y * shrink;
  } else {
    inside &= magnitude(p.x) <= half[0] - slack;
    inside &= magnitude(p.y) <= half[1] - slack;
    p.x = clamp(p.x, half[0] - inwards);
    p.y = clamp(p.y, half[1] - inwards);
  }
  p.z = clamp(p.z, half[2] - inwards);
  return lanes_of(inside);
}

[[gnu::always_inline]] inline V3 into(const LaneBox& box, const V3& p) {
  const V3 d = minus(p, box.center);
  return {dot(d, box.axis[0]), dot(d, box.axis[1]), dot(d, box.axis[2])};
}
[[gnu::always_inline]] inline V3 out_of(const LaneBox& box, const V3& p) {
  return {box.center.x + box.axis[0].x * p.x + box.axis[1].x * p.y + box.axis[2].x * p.z,
          box.center.y + box.axis[0].y * p.x + box.axis[1].y * p.y + box.axis[2].y * p.z,
          box.center.z + box.axis[0].z * p.x + box.axis[1].z * p.y + box.axis[2].z * p.z};
}

constexpr int kDraws = 5;
/// Share of the margin. Sizes are enlarged by one of it; a point within half of this is deeper than the rest, and its
/// place is known to far less.
constexpr float kInwards = 5.0F;

/// Lanes in which alternating projections onto two boxes, or the cylinders in them, found a point inside both.
template <bool RoundA, bool RoundB>
[[gnu::noinline]] unsigned boxes_touch(const LaneBox& a, const float* h, const LaneBox& b, const float* g,
                                       float inwards, unsigned lanes) {
  V3 in_a = into(a, b.center);
  draw_into<RoundA>(h, inwards, in_a);
  V3 p = out_of(a, in_a);
  unsigned touching = 0;
  for (int draw = 0; draw < kDraws && touching != lanes; ++draw) {
    V3 in_b = into(b, p);
    touching |= lanes & draw_into<RoundB>(g, inwards, in_b);  // p was drawn into a
    p = out_of(b, in_b);
    in_a = into(a, p);
    touching |= lanes & draw_into<RoundA>(h, inwards, in_a);
    p = out_of(a, in_a);
  }
  return touching;
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
  if (a.form == Form::cylinder) {
    return b.form == Form::cylinder ? boxes_touch<true, true>(box_a, h, box_b, g, inwards, lanes)
                                    : boxes_touch<true, false>(box_a, h, box_b, g, inwards, lanes);
  }
  return b.form == Form::cylinder ? boxes_touch<false, true>(box_a, h, box_b, g, inwards, lanes)
                                  : boxes_touch<false, false>(box_a, h, box_b, g, inwards, lanes);
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

[[gnu::always_inline]] inline const V& lanes_at(const float* numbers) { return *reinterpret_cast<const V*>(numbers); }

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

/// The parts of two groups whose balls meet in some lanes.
[[gnu::noinline]] void check_parts(const Scratch& scratch, int begin, int end, unsigned lanes, Output& output) {
  for (int k = begin; k < end; ++k) {
    const PartPair& pair = scratch.model.part_pairs[k];
    const V3 d = minus(scratch.balls[pair.a], scratch.balls[pair.b]);
    unsigned near = lanes & output.open & lanes_of(dot(d, d) <= all(pair.squared_reach));
    if (near != 0) near = parts_near(scratch, pair.a, pair.b, near);
    if (near == 0) continue;
    output.add(pair.a, pair.b, near, parts_touch(scratch, pair.a, pair.b, near));
    if (output.open == 0) return;
  }
}

/// The least lane of each of kLanes numbers, side by side: halved three times.
[[gnu::always_inline]] inline V least_of_each(const V (&v)[kLanes]) {
  V pairs[4];
  for (int k = 0; k < 4; ++k) {
    pairs[k] = lesser(__builtin_shuffle(v[2 * k], v[2 * k + 1], Bits{0, 8, 2, 10, 4, 12, 6, 14}),
                      __builtin_shuffle(v[2 * k], v[2 * k + 1], Bits{1, 9, 3, 11, 5, 13, 7, 15}));
  }
  V fours[2];
  for (int k = 0; k < 2; ++k) {
    fours[k] = lesser(__builtin_shuffle(pairs[2 * k], pairs[2 * k + 1], Bits{0, 1, 8, 9, 4, 5, 12, 13}),
                      __builtin_shuffle(pairs[2 * k], pairs[2 * k + 1], Bits{2, 3, 10, 11, 6, 7, 14, 15}));
  }
  return lesser(__builtin_shuffle(fours[0], fours[1], Bits{0, 1, 2, 3, 8, 9, 10, 11}),
                __builtin_shuffle(fours[0], fours[1], Bits{4, 5, 6, 7, 12, 13, 14, 15}));
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

/// Which boxes of a row overlap the given one, as bits.
[[gnu::always_inline]] inline unsigned overlapping(const BoxRow& row, const float (&center)[3],
                                                   const float (&half)[3]) {
  Bits overlap = magnitude(lanes_at(row.center[0]) - center[0]) <= lanes_at(row.half[0]) + half[0];
  overlap &= magnitude(lanes_at(row.center[1]) - center[1]) <= lanes_at(row.half[1]) + half[1];
  overlap &= magnitude(lanes_at(row.center[2]) - center[2]) <= lanes_at(row.half[2]) + half[2];
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
  const int row_count = model.group_rows + model.scene_row_count;
  for (int g = 0; g < model.group_count; ++g) {
    const BoxRow& own = rows[g / kLanes];
    const float center[3] = {own.center[0][g % kLanes], own.center[1][g % kLanes], own.center[2][g % kLanes]};
    const float half[3] = {own.half[0][g % kLanes], own.half[1][g % kLanes], own.half[2][g % kLanes]};
    for (int r = 0; r < row_count; ++r) {
      const bool scene = r >= model.group_rows;
      unsigned bits = model.wanted[g * row_count + r];
      if (bits == 0) continue;
      bits &= overlapping(scene ? model.scene_rows[r - model.group_rows] : rows[r], center, half);
      for (; bits != 0; bits &= bits - 1) {
        const int place = __builtin_ctz(bits);
        const GroupPair& pair = model.pairs[(g * row_count + r) * kLanes + place];
        unsigned near = output.open;
        if (scene) {
          const SceneBox& box = model.scene_boxes[(r - model.group_rows) * kLanes + place];
          near &= lanes_of(near_scene_box(centers[g], all(pair.squared_reach), box));
        } else {
          const V3 d = minus(centers[g], centers[r * kLanes + place]);
          near &= lanes_of(dot(d, d) <= all(pair.squared_reach));
        }
        if (near == 0) continue;
        check_parts(scratch, pair.begin, pair.end, near, output);
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
