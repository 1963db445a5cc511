// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Numbers of kLanes configurations, or of kLanes pairs, side by side. Included by one .cpp for each instruction set.
// Everything here has internal linkage, so that no code made for one processor can be linked into a path for another.
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
[[gnu::always_inline]] inline V all(float value) { return V{} + value; }

[[gnu::always_inline]] inline const V& lanes_at(const float* numbers) { return *reinterpret_cast<const V*>(numbers); }

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
/// Lane by lane, for want of a vector square root that is the same everywhere.
[[gnu::always_inline]] inline V root(const V& v) {
  V r;
  for (int i = 0; i < kLanes; ++i) r[i] = __builtin_sqrtf(v[i]);
  return r;
}
}  // namespace
}  // namespace opponens::robot::wide
