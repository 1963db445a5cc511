// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Descents in sphere trees, in lanes. Included by one .cpp for each instruction set (wide_lanes.hpp).
#pragma once

#include "robot/wide_boxes.hpp"

namespace opponens::robot::wide {
namespace {

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
}  // namespace
}  // namespace opponens::robot::wide
