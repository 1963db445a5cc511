// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Boxes, and cylinders in boxes, in lanes: what keeps two apart, and a point in both. Included by one .cpp for each
// instruction set (wide_lanes.hpp).
#pragma once

#include "robot/wide_lanes.hpp"

namespace opponens::robot::wide {
namespace {

/// Added to the size of a cosine: more than its rounding, and than the axes of a chain of 40 joints are off a right
/// angle (2e-7 for each).
constexpr float kParallel = 1e-5F;

/// Where a box is: axes by columns.
struct LaneBox {
  V3 center;
  V3 axis[3];
};

/// A point's x and y drawn into the cross-section of a solid, and the lanes in which they were inside before.
struct Drawn {
  V x;
  V y;
  Bits inside;
};

[[gnu::always_inline]] inline V clamped(const V& v, const V& most) { return greater(lesser(v, most), -most); }

/// Into a rectangle made smaller by `inwards`; inside: one made smaller by half of that.
[[gnu::always_inline]] inline Drawn drawn_into_rectangle(const V& a, const V& b, float inwards, const V& x,
                                                         const V& y) {
  const float slack = 0.5F * inwards;
  return {clamped(x, a - inwards), clamped(y, b - inwards), (magnitude(x) <= a - slack) & (magnitude(y) <= b - slack)};
}

/// The same into a disc.
[[gnu::always_inline]] inline Drawn drawn_into_disc(const V& radius, float inwards, const V& x, const V& y) {
  const V across = x * x + y * y;
  const V within = radius - 0.5F * inwards;
  const V shrink = lesser(all(1), (radius - inwards) / greater(root(across), all(1e-12F)));
  return {x * shrink, y * shrink, across < within * within};
}

// What fills a box. extent(): how far it reaches along a direction with components x, y, z >= 0 in the box. drawn():
// its cross-section. half_at(): of the box.

/// All of it, in every lane the same.
struct Cuboid {
  static constexpr bool kMayBeRound = false;
  const float* half;

  V half_at(int axis) const { return all(half[axis]); }
  V extent(const V& x, const V& y, const V& z) const { return half[0] * x + half[1] * y + half[2] * z; }
  Drawn drawn(float inwards, const V& x, const V& y) const {
    return drawn_into_rectangle(all(half[0]), all(half[1]), inwards, x, y);
  }
};

/// The cylinder about its z axis, in every lane the same.
struct Drum {
  static constexpr bool kMayBeRound = true;
  const float* half;

  static Bits round() { return Bits{} - 1; }
  V half_at(int axis) const { return all(half[axis]); }
  V extent(const V& x, const V& y, const V& z) const { return half[0] * root(x * x + y * y) + half[2] * z; }
  Drawn drawn(float inwards, const V& x, const V& y) const { return drawn_into_disc(all(half[0]), inwards, x, y); }
};

/// All of it, in each lane another.
struct Cuboids {
  static constexpr bool kMayBeRound = false;
  const V* half;

  const V& half_at(int axis) const { return half[axis]; }
  V extent(const V& x, const V& y, const V& z) const { return half[0] * x + half[1] * y + half[2] * z; }
};

/// The cylinder in lanes that are round, else all of it, in each lane another.
struct Mixture {
  static constexpr bool kMayBeRound = true;
  const V* half;
  Bits round_lanes;

  const Bits& round() const { return round_lanes; }
  const V& half_at(int axis) const { return half[axis]; }
  V extent(const V& x, const V& y, const V& z) const {
    return (round_lanes ? half[0] * root(x * x + y * y) : half[0] * x + half[1] * y) + half[2] * z;
  }
  Drawn drawn(float inwards, const V& x, const V& y) const {
    const Drawn disc = drawn_into_disc(half[0], inwards, x, y);
    const Drawn rectangle = drawn_into_rectangle(half[0], half[1], inwards, x, y);
    return {round_lanes ? disc.x : rectangle.x, round_lanes ? disc.y : rectangle.y,
            round_lanes ? disc.inside : rectangle.inside};
  }
};

/// What use(filling) makes of what fills a part's box: all of it where the form is `other`.
template <typename Use>
[[gnu::always_inline]] inline unsigned with_filling(const Part& part, const Use& use) {
  return part.form == Form::cylinder ? use(Drum{part.half_extents}) : use(Cuboid{part.half_extents});
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

/// Whether a cylinder's radius ends before another shape on the way towards its center: (u, v) is that way in the
/// cylinder's x and y, whose components in the other's box are the rows `first` and `second`.
template <typename Own, typename Other>
[[gnu::always_inline]] inline Bits apart_across(const Own& own, const V& u, const V& v, const V3& first,
                                                const V3& second, const Other& other) {
  const V x = magnitude(u * first.x + v * second.x) + kParallel;
  const V y = magnitude(u * first.y + v * second.y) + kParallel;
  const V z = magnitude(u * first.z + v * second.z) + kParallel;
  const V across = u * u + v * v;
  return (across > own.half_at(0) * root(across) + other.extent(x, y, z)) & own.round();
}

/// Lanes in which none of these directions keeps the fillings of two boxes apart: the 15 axes of the separating axis
/// theorem (Gottschalk 1996), and for a cylinder that across its axis towards the other's center. Cross products that
/// nearly vanish say nothing wrong: both sides of the test shrink with them, but for what enlarges the shapes.
template <typename A, typename B>
[[gnu::noinline]] unsigned boxes_near(const LaneBox& a, const A& in_a, const LaneBox& b, const B& in_b,
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
  for (int i = 0; i < 3; ++i) apart |= magnitude(t[i]) > in_a.half_at(i) + in_b.extent(Q[i][0], Q[i][1], Q[i][2]);
  for (int j = 0; j < 3; ++j) apart |= magnitude(s[j]) > in_b.half_at(j) + in_a.extent(Q[0][j], Q[1][j], Q[2][j]);
  lanes &= ~lanes_of(apart);
  if (lanes == 0) return 0;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      V along_a[3];
      V along_b[3];
      along_a[i] = V{};
      along_a[i1] = Q[i2][j];
      along_a[i2] = Q[i1][j];
      along_b[j] = V{};
      along_b[j1] = Q[i][j2];
      along_b[j2] = Q[i][j1];
      apart |= magnitude(t[i2] * R[i1][j] - t[i1] * R[i2][j]) >
               in_a.extent(along_a[0], along_a[1], along_a[2]) + in_b.extent(along_b[0], along_b[1], along_b[2]);
    }
  }
  if constexpr (A::kMayBeRound) {
    apart |= apart_across(in_a, t[0], t[1], {R[0][0], R[0][1], R[0][2]}, {R[1][0], R[1][1], R[1][2]}, in_b);
  }
  if constexpr (B::kMayBeRound) {
    apart |= apart_across(in_b, s[0], s[1], {R[0][0], R[1][0], R[2][0]}, {R[0][1], R[1][1], R[2][1]}, in_a);
  }
  return lanes & ~lanes_of(apart);
}

/// Takes a point, given in the frame of a box, towards the nearest one of its filling made smaller by `inwards` (less
/// than any half extent). Returns the lanes in which it was within the filling made smaller by half of that.
template <typename Filling>
[[gnu::always_inline]] inline unsigned draw_into(const Filling& filling, float inwards, V3& p) {
  const V height = filling.half_at(2);
  const Bits inside = magnitude(p.z) <= height - 0.5F * inwards;
  const Drawn drawn = filling.drawn(inwards, p.x, p.y);
  p = {drawn.x, drawn.y, clamped(p.z, height - inwards)};
  return lanes_of(inside & drawn.inside);
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

/// Lanes in which alternating projections onto the fillings of two boxes found a point inside both.
template <typename A, typename B>
[[gnu::noinline]] unsigned boxes_touch(const LaneBox& a, const A& in_a, const LaneBox& b, const B& in_b, float inwards,
                                       unsigned lanes) {
  V3 from_a = into(a, b.center);
  draw_into(in_a, inwards, from_a);
  V3 p = out_of(a, from_a);
  unsigned touching = 0;
  for (int draw = 0; draw < kDraws && touching != lanes; ++draw) {
    V3 from_b = into(b, p);
    touching |= lanes & draw_into(in_b, inwards, from_b);  // p was drawn into a
    p = out_of(b, from_b);
    from_a = into(a, p);
    touching |= lanes & draw_into(in_a, inwards, from_a);
    p = out_of(a, from_a);
  }
  return touching;
}

}  // namespace
}  // namespace opponens::robot::wide
