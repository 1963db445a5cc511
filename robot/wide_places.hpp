// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Where the parts of a robot are in one configuration: kinematics in double precision, rounded once. Included by one
// .cpp for each instruction set (wide_lanes.hpp).
#pragma once

#include "robot/wide_lanes.hpp"

namespace opponens::robot::wide {
namespace {

typedef double D4 __attribute__((vector_size(32)));  // x, y, z and nothing
typedef float F4 __attribute__((vector_size(16)));

/// A pose of one configuration: rotation by columns, translation.
struct ExactPose {
  D4 column[3];
  D4 p;
};
struct RoundedPose {
  F4 column[3];
  F4 p;
};

[[gnu::always_inline]] inline D4 rotated(const ExactPose& X, const double (&v)[3][4]) {
  const D4* const numbers = reinterpret_cast<const D4*>(v);
  return X.column[0] * numbers[0] + X.column[1] * numbers[1] + X.column[2] * numbers[2];
}
[[gnu::always_inline]] inline F4 rounded(const D4& v) { return __builtin_convertvector(v, F4); }
[[gnu::always_inline]] inline RoundedPose rounded(const ExactPose& X) {
  return {{rounded(X.column[0]), rounded(X.column[1]), rounded(X.column[2])}, rounded(X.p)};
}

/// Two vectors of four in one of eight.
[[gnu::always_inline]] inline V joined(const F4& a, const F4& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Sine and cosine to 1e-10 of angles up to 1e5: Taylor polynomials on [-pi/4, pi/4].
[[gnu::always_inline]] inline void sine_cosine(const D& angle, D& sine, D& cosine) {
  typedef long long Longs __attribute__((vector_size(8 * kLanes)));
  const double magic =
      6755399441055744.0;  // adding it rounds to an integer, which the lowest bits of the sum then hold
  const D shifted = angle * 0.63661977236758134308 + magic;
  const D r = angle - (shifted - magic) * 1.57079632679489661923;
  const D z = r * r;
  const D s = r + r * z * (-1.0 / 6 + z * (1.0 / 120 + z * (-1.0 / 5040 + z * (1.0 / 362880 - z * (1.0 / 39916800)))));
  const D c =
      1.0 +
      z * (-0.5 + z * (1.0 / 24 + z * (-1.0 / 720 + z * (1.0 / 40320 + z * (-1.0 / 3628800 + z * (1.0 / 479001600))))));
  const Longs quadrant = __builtin_bit_cast(Longs, shifted);
  const Longs odd = -(quadrant & 1);
  const Longs sine_bits = (__builtin_bit_cast(Longs, s) & ~odd) | (__builtin_bit_cast(Longs, c) & odd);
  const Longs cosine_bits = (__builtin_bit_cast(Longs, c) & ~odd) | (__builtin_bit_cast(Longs, s) & odd);
  sine = __builtin_bit_cast(D, sine_bits ^ ((quadrant & 2) << 62));
  cosine = __builtin_bit_cast(D, cosine_bits ^ (((quadrant + 1) & 2) << 62));
}

/// Positions of all joints, and their sines and cosines; [frames - kRoot - 1], in whole rows.
struct Turns {
  D* position;
  D* sine;
  D* cosine;
};
[[gnu::always_inline]] inline void place_joints(const Model& model, const double* q, const Turns& turns) {
  const int moving = model.frame_count - kRoot - 1;
  const Frame* frame = model.frames + kRoot + 1;
  double* const position = reinterpret_cast<double*>(turns.position);
  for (int i = 0; i < moving; ++i, ++frame) position[i] = frame->multiplier * q[frame->joint] + frame->offset;
  for (int row = 0; row * kLanes < moving; ++row) sine_cosine(turns.position[row], turns.sine[row], turns.cosine[row]);
}

[[gnu::always_inline]] inline void place_frames(const Model& model, const SingleQuery& query, const Turns& turns,
                                                ExactPose* X, RoundedPose* rounded_X) {
  const double* r = query.root;
  X[kWorld] = {{D4{1, 0, 0, 0}, D4{0, 1, 0, 0}, D4{0, 0, 1, 0}}, D4{0, 0, 0, 0}};
  X[kRoot] = {{D4{r[0], r[3], r[6], 0}, D4{r[1], r[4], r[7], 0}, D4{r[2], r[5], r[8], 0}}, D4{r[9], r[10], r[11], 0}};
  rounded_X[kWorld] = rounded(X[kWorld]);
  rounded_X[kRoot] = rounded(X[kRoot]);
  const double* position = reinterpret_cast<const double*>(turns.position);
  const double* sine = reinterpret_cast<const double*>(turns.sine);
  const double* cosine = reinterpret_cast<const double*>(turns.cosine);
  const int count = model.frame_count;
  const Frame* frame = model.frames + kRoot + 1;
  const SpreadFrame* numbers = model.spread_frames + kRoot + 1;
  for (int f = kRoot + 1; f < count; ++f, ++frame, ++numbers, ++position, ++sine, ++cosine) {
    const ExactPose& parent = X[frame->parent];
    const D4 a = rotated(parent, numbers->column[0]);
    const D4 b = rotated(parent, numbers->column[1]);
    const D4 axis = rotated(parent, numbers->column[2]);
    const D4 p = parent.p + rotated(parent, numbers->translation);
    ExactPose& own = X[f];
    if (frame->motion == Motion::turn) {
      own = {{a * *cosine + b * *sine, b * *cosine - a * *sine, axis}, p};
    } else {
      own = {{a, b, axis}, p + axis * *position};
    }
    rounded_X[f] = rounded(own);
  }
}

/// What is computed when it is first asked for. The model's arrays that this takes are named here once more: behind a
/// reference the compiler would look them up for each part.
struct SingleScratch {
  const Model& model;
  const RoundedPose* X;
  const SpreadPart* spread_parts;
  const PlacedPart* scene_parts;
  PlacedPart* parts;  ///< [robot parts]
  bool* placed;       ///< [robot parts]
  int robot_parts;
};

[[gnu::always_inline]] inline const PlacedPart& place(const SingleScratch& scratch, int index) {
  if (index >= scratch.robot_parts) return scratch.scene_parts[index - scratch.robot_parts];
  PlacedPart& placed = scratch.parts[index];
  if (scratch.placed[index]) return placed;
  scratch.placed[index] = true;
  const SpreadPart& part = scratch.spread_parts[index];
  const RoundedPose& X = scratch.X[part.frame];
  const V columns[3] = {joined(X.column[0], X.column[0]), joined(X.column[1], X.column[1]),
                        joined(X.column[2], X.column[2])};
  const auto two = [&](int k) {
    return columns[0] * lanes_at(part.box[k][0]) + columns[1] * lanes_at(part.box[k][1]) +
           columns[2] * lanes_at(part.box[k][2]) + lanes_at(part.rest[k]);
  };
  // Stored as they are loaded: a load from two stores would wait for both.
  V* const to = reinterpret_cast<V*>(&placed);
  to[0] = two(0) + joined(X.p, F4{});
  to[1] = two(1);
  return placed;
}

/// Rows of kLanes numbers become columns: halved three times.
[[gnu::always_inline]] inline void transpose(V (&v)[kLanes]) {
  V pairs[kLanes];
  for (int k = 0; k < 4; ++k) {
    pairs[2 * k] = __builtin_shufflevector(v[2 * k], v[2 * k + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pairs[2 * k + 1] = __builtin_shufflevector(v[2 * k], v[2 * k + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  V fours[kLanes];
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < 2; ++i) {
      const V& low = pairs[4 * k + i];
      const V& high = pairs[4 * k + 2 + i];
      fours[4 * k + 2 * i] = __builtin_shufflevector(low, high, 0, 1, 8, 9, 4, 5, 12, 13);
      fours[4 * k + 2 * i + 1] = __builtin_shufflevector(low, high, 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int i = 0; i < 4; ++i) {
    v[i] = __builtin_shufflevector(fours[i], fours[4 + i], 0, 1, 2, 3, 8, 9, 10, 11);
    v[4 + i] = __builtin_shufflevector(fours[i], fours[4 + i], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// The centers of the robot's balls, kLanes in a row. Places beyond the last part repeat it.
[[gnu::always_inline]] inline void place_balls(const RoundedPose* X, const SpreadPart* parts, int count, V3* rows) {
  if (count == 0) return;
  const SpreadPart* const last = parts + (count - 1);
  for (int first = 0; first < count; first += kLanes) {
    V centers[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      const RoundedPose& own = X[parts->frame];
      const F4* const at = reinterpret_cast<const F4*>(parts->ball_center);
      const F4 center = own.p + own.column[0] * at[0] + own.column[1] * at[1] + own.column[2] * at[2];
      centers[lane] = joined(center, center);
      if (parts != last) ++parts;
    }
    transpose(centers);
    *rows++ = {centers[0], centers[1], centers[2]};
  }
}

/// The center of one ball in all lanes.
[[gnu::always_inline]] inline V3 place_of(const V3* rows, int ball) {
  const unsigned index = static_cast<unsigned>(ball);
  const float* const own = reinterpret_cast<const float*>(rows + index / kLanes) + index % kLanes;
  return {all(own[0]), all(own[kLanes]), all(own[2 * kLanes])};
}

}  // namespace
}  // namespace opponens::robot::wide
