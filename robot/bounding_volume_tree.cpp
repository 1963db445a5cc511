// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/bounding_volume_tree.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/require.hpp"

namespace opponens::robot {

namespace {

constexpr int kLeafTriangles = 4;
constexpr int kBins = 16;
constexpr std::size_t kStackSize = 192;  ///< of the traversal; build() keeps the tree shallower
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Bounds {
  Eigen::Array3d lower = Eigen::Array3d::Constant(kInfinity);
  Eigen::Array3d upper = Eigen::Array3d::Constant(-kInfinity);

  void add(const Eigen::Array3d& low, const Eigen::Array3d& high) {
    lower = lower.min(low);
    upper = upper.max(high);
  }
  double half_area() const {
    const Eigen::Array3d d = (upper - lower).max(0.0);
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

TrianglePoint nearest_on_edges(const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac,
                               const Eigen::Vector3d& p) {
  const std::array<Eigen::Vector3d, 4> corner{a, a + ab, a + ac, a};
  TrianglePoint best{a, TriangleFeature::vertex_0};
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d& from = corner[static_cast<std::size_t>(k)];
    const Eigen::Vector3d edge = corner[static_cast<std::size_t>(k) + 1] - from;
    const double length2 = edge.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp((p - from).dot(edge) / length2, 0.0, 1.0) : 0.0;
    const Eigen::Vector3d q = from + t * edge;
    if (k > 0 && (p - q).squaredNorm() >= (p - best.point).squaredNorm()) continue;
    const int feature = t == 0.0 ? k : (t == 1.0 ? (k + 1) % 3 : 3 + k);
    best = {q, static_cast<TriangleFeature>(feature)};
  }
  return best;
}

}  // namespace

TrianglePoint nearest_on_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac,
                                  const Eigen::Vector3d& p) {
  const Eigen::Vector3d ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {a, TriangleFeature::vertex_0};
  const Eigen::Vector3d bp = ap - ab;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {a + ab, TriangleFeature::vertex_1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3) return {a + ab * (d1 / (d1 - d3)), TriangleFeature::edge_01};
  const Eigen::Vector3d cp = ap - ac;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {a + ac, TriangleFeature::vertex_2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6) return {a + ac * (d2 / (d2 - d6)), TriangleFeature::edge_20};
  const double va = d3 * d6 - d5 * d4;
  const double along = d4 - d3;
  const double back = d5 - d6;
  if (va <= 0.0 && along >= 0.0 && back >= 0.0 && along + back > 0.0) {
    return {a + ab + (ac - ab) * (along / (along + back)), TriangleFeature::edge_12};
  }
  const double sum = va + vb + vc;
  // Written so that a NaN of a collapsed triangle fails the comparison as well.
  if (!(sum > 0.0)) return nearest_on_edges(a, ab, ac, p);
  return {a + ab * (vb / sum) + ac * (vc / sum), TriangleFeature::face};
}

BoundingVolumeTree::BoundingVolumeTree(const TriangleMesh& mesh) {
  require(mesh.triangles.cols() > 0, "BoundingVolumeTree: a mesh without triangles");
  std::vector<Item> items;
  items.reserve(static_cast<std::size_t>(mesh.triangles.cols()));
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, f));
    const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, f));
    const Eigen::Vector3d c = mesh.vertices.col(mesh.triangles(2, f));
    const Eigen::Vector3d lower = a.cwiseMin(b).cwiseMin(c);
    const Eigen::Vector3d upper = a.cwiseMax(b).cwiseMax(c);
    items.push_back({lower, upper, 0.5 * (lower + upper), static_cast<int>(f)});
  }
  nodes_.reserve(items.size());
  build(items, 0, static_cast<int>(items.size()));
  slots_.reserve(items.size());
  for (const Item& item : items) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, item.triangle));
    slots_.push_back({a, mesh.vertices.col(mesh.triangles(1, item.triangle)) - a,
                      mesh.vertices.col(mesh.triangles(2, item.triangle)) - a, item.triangle});
  }
}

namespace {

struct Split {
  double cost = kInfinity;
  int axis = -1;
  int bin = 0;
};

int bin_of(double center, double low, double extent) {
  return std::min(kBins - 1, static_cast<int>(kBins * ((center - low) / extent)));
}

/// Cheapest split by the surface area heuristic among kBins - 1 planes per axis.
template <typename Items>
Split best_split(const Items& items, int begin, int end, const Bounds& centers) {
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = centers.lower[axis];
    const double extent = centers.upper[axis] - low;
    if (!(extent > 0.0)) continue;
    std::array<Bounds, kBins> bounds;
    std::array<int, kBins> count{};
    for (int i = begin; i < end; ++i) {
      const auto& item = items[static_cast<std::size_t>(i)];
      const auto bin = static_cast<std::size_t>(bin_of(item.center[axis], low, extent));
      bounds[bin].add(item.lower.array(), item.upper.array());
      ++count[bin];
    }
    std::array<double, kBins> right_cost{};
    Bounds right;
    int right_count = 0;
    for (std::size_t bin = kBins - 1; bin > 0; --bin) {
      right.add(bounds[bin].lower, bounds[bin].upper);
      right_count += count[bin];
      right_cost[bin] = right_count == 0 ? kInfinity : right.half_area() * right_count;
    }
    Bounds left;
    int left_count = 0;
    for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
      left.add(bounds[bin].lower, bounds[bin].upper);
      left_count += count[bin];
      if (left_count == 0) continue;
      const double cost = left.half_area() * left_count + right_cost[bin + 1];
      if (cost < best.cost) best = {cost, axis, static_cast<int>(bin)};
    }
  }
  return best;
}

}  // namespace

int BoundingVolumeTree::build(std::vector<Item>& items, int begin, int end) {
  Bounds centers;
  for (int i = begin; i < end; ++i) {
    const Eigen::Array3d c = items[static_cast<std::size_t>(i)].center.array();
    centers.add(c, c);
  }
  int middle = begin + (end - begin) / 2;
  const Split split = best_split(items, begin, end, centers);
  if (split.axis >= 0) {
    const double low = centers.lower[split.axis];
    const double extent = centers.upper[split.axis] - low;
    const auto boundary = std::stable_partition(items.begin() + begin, items.begin() + end, [&](const Item& item) {
      return bin_of(item.center[split.axis], low, extent) <= split.bin;
    });
    // A lopsided split (less than 1/8) falls back to halves: depth stays below log(count) / log(8/7) plus a few, 140
    // for the largest mesh that load_mesh reads.
    const auto cut = static_cast<int>(boundary - items.begin());
    const int least = std::max(1, (end - begin) / 8);
    if (cut - begin >= least && end - cut >= least) middle = cut;
  }
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  const std::array<std::pair<int, int>, 2> ranges{{{begin, middle}, {middle, end}}};
  for (std::size_t child = 0; child < 2; ++child) {
    const auto [from, to] = ranges[child];
    Bounds bounds;
    for (int i = from; i < to; ++i) {
      bounds.add(items[static_cast<std::size_t>(i)].lower.array(), items[static_cast<std::size_t>(i)].upper.array());
    }
    const bool leaf = to - from <= kLeafTriangles;
    const int first = leaf ? from : build(items, from, to);
    Node& node = nodes_[static_cast<std::size_t>(index)];
    node.lower.row(static_cast<Eigen::Index>(child)) = bounds.lower.transpose();
    node.upper.row(static_cast<Eigen::Index>(child)) = bounds.upper.transpose();
    node.first[child] = first;
    node.count[child] = leaf ? to - from : 0;
    // An empty child (a mesh of one triangle) has an infinite distance and is never entered.
    if (leaf && to == from) node.count[child] = -1;
  }
  return index;
}

BoundingVolumeTree::Nearest BoundingVolumeTree::nearest(const Eigen::Vector3d& p, double within) const {
  Nearest best{within * within, p, -1, TriangleFeature::face};
  struct Entry {
    double squared_distance;
    int first;
    int count;
  };
  std::array<Entry, kStackSize> stack;  // NOLINT: filled before it is read
  std::size_t size = 0;
  stack[size++] = {0.0, 0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.squared_distance >= best.squared_distance) continue;
    if (entry.count > 0) {
      for (int i = entry.first; i < entry.first + entry.count; ++i) {
        const Slot& slot = slots_[static_cast<std::size_t>(i)];
        const TrianglePoint on = nearest_on_triangle(slot.a, slot.ab, slot.ac, p);
        const double d2 = (p - on.point).squaredNorm();
        if (d2 < best.squared_distance) best = {d2, on.point, slot.triangle, on.feature};
      }
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry.first)];
    Eigen::Array2d d2 = Eigen::Array2d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Array2d outside = (node.lower.col(axis) - p[axis]).max(p[axis] - node.upper.col(axis)).max(0.0);
      d2 += outside * outside;
    }
    const std::size_t near = d2[1] < d2[0] ? 1 : 0;
    for (const std::size_t child : {1 - near, near}) {
      const double distance = d2[static_cast<Eigen::Index>(child)];
      if (node.count[child] >= 0 && distance < best.squared_distance) {
        stack[size++] = {distance, node.first[child], node.count[child]};
      }
    }
  }
  return best;
}

double BoundingVolumeTree::least(const BoxBound& bound, const TriangleDistance& distance, double limit) const {
  struct Entry {
    double bound;
    int first;
    int count;
  };
  double best = limit;
  std::vector<Entry> stack{{0.0, 0, 0}};
  while (!stack.empty()) {
    const Entry entry = stack.back();
    stack.pop_back();
    if (entry.bound >= best) continue;
    if (entry.count > 0) {
      for (int i = entry.first; i < entry.first + entry.count; ++i) {
        const Slot& slot = slots_[static_cast<std::size_t>(i)];
        best = std::min(best, distance(slot.a, slot.ab, slot.ac));
      }
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry.first)];
    std::array<Entry, 2> children{};
    for (std::size_t child = 0; child < 2; ++child) {
      const Eigen::Vector3d lower = node.lower.row(static_cast<Eigen::Index>(child)).transpose();
      const Eigen::Vector3d upper = node.upper.row(static_cast<Eigen::Index>(child)).transpose();
      const bool empty = node.count[child] < 0;
      children[child] = {empty ? kInfinity : bound(0.5 * (lower + upper), 0.5 * (upper - lower)), node.first[child],
                         node.count[child]};
    }
    if (children[0].bound < children[1].bound) std::swap(children[0], children[1]);
    for (const Entry& child : children) {
      if (child.bound < best) stack.push_back(child);
    }
  }
  return best;
}

}  // namespace opponens::robot
