// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/sphere_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/smallest_ball.hpp"
#include "robot/solid_region.hpp"

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

/// Radii are enlarged by this share, far above the rounding of distances in double precision.
constexpr double kRounding = 1e-12;
constexpr int kBranching = 4;         ///< children per node wanted
constexpr double kSliceLength = 0.5;  ///< of a cylinder's slices at most, in radii

/// A convex piece of a triangle: its corners, in the cell's list of them.
struct Piece {
  int first;
  int count;
};

/// The part of the surface in a cell.
struct Cell {
  Eigen::AlignedBox3d box;
  std::vector<Vector3d> points;  ///< of the pieces, most of them shared by several
  std::vector<int> corners;      ///< of the pieces, one piece after the other: indices of points
  std::vector<Piece> pieces;
  std::vector<Vector3d> filled;  ///< the corners of the box that lie in the solid

  bool empty() const { return points.empty() && filled.empty(); }
};

/// Asks for each point once: neighbouring cells share corners, and so do the ways to divide a cell.
class RememberedInside {
 public:
  explicit RememberedInside(const Inside& inside) : inside_(inside) {}
  bool operator()(const Vector3d& p) {
    const auto [entry, added] = known_.try_emplace({p.x(), p.y(), p.z()}, false);
    if (added) entry->second = inside_(p);
    return entry->second;
  }

 private:
  const Inside& inside_;
  std::map<std::array<double, 3>, bool> known_;
};

/// Shrinks the box to the points: the solid inside the cell lies in their convex hull.
void finish(Cell& cell, RememberedInside& inside) {
  for (int k = 0; k < 8; ++k) {
    const Vector3d corner = cell.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k));
    if (inside(corner)) cell.filled.push_back(corner);
  }
  cell.box.setEmpty();
  for (const Vector3d& p : cell.points) cell.box.extend(p);
  for (const Vector3d& p : cell.filled) cell.box.extend(p);
}

/// Cuts a cell's pieces by the plane x[axis] = level and collects those on one side of it.
class Half {
 public:
  /// sign: 1 for the side of larger coordinates, -1 for the other.
  Half(const Cell& whole, int axis, double level, double sign)
      : whole_(whole), axis_(axis), level_(level), index_(whole.points.size(), kUnknown) {
    height_.reserve(whole.points.size());
    for (const Vector3d& p : whole.points) height_.push_back(sign * (p[axis] - level));
    half_.points.reserve(whole.points.size());
    half_.corners.reserve(whole.corners.size());
    half_.pieces.reserve(whole.pieces.size());
    half_.box = whole.box;
    (sign < 0.0 ? half_.box.max() : half_.box.min())[axis] = level;
    for (const Piece& piece : whole.pieces) add(piece);
  }
  Cell take() { return std::move(half_); }

 private:
  static constexpr int kUnknown = -1;

  double height(int point) const { return height_[static_cast<std::size_t>(point)]; }

  void keep(int point) {
    int& index = index_[static_cast<std::size_t>(point)];
    if (index == kUnknown) {
      index = static_cast<int>(half_.points.size());
      half_.points.push_back(whole_.points[static_cast<std::size_t>(point)]);
    }
    half_.corners.push_back(index);
  }

  /// Corners on the plane belong to both sides.
  void add(const Piece& piece) {
    const int first = static_cast<int>(half_.corners.size());
    const int* const corners = &whole_.corners[static_cast<std::size_t>(piece.first)];
    if (std::all_of(corners, corners + piece.count, [this](int corner) { return height(corner) < 0.0; })) return;
    for (int i = 0; i < piece.count; ++i) {
      const int a = corners[i];
      const int b = corners[i + 1 == piece.count ? 0 : i + 1];
      const double above_a = height(a);
      const double above_b = height(b);
      if (above_a >= 0.0) keep(a);
      if ((above_a > 0.0 && above_b < 0.0) || (above_a < 0.0 && above_b > 0.0)) {
        const Vector3d& from = whole_.points[static_cast<std::size_t>(a)];
        const Vector3d& to = whole_.points[static_cast<std::size_t>(b)];
        Vector3d cut = from + (to - from) * (above_a / (above_a - above_b));
        cut[axis_] = level_;
        half_.corners.push_back(static_cast<int>(half_.points.size()));
        half_.points.push_back(cut);
      }
    }
    half_.pieces.push_back({first, static_cast<int>(half_.corners.size()) - first});
  }

  const Cell& whole_;
  int axis_;
  double level_;
  std::vector<double> height_;  ///< of the whole's points above the plane, m
  std::vector<int> index_;      ///< of the whole's points in the half
  Cell half_;
};

/// A ball around all points of a cell, nearly the smallest.
SphereTree::Node ball_of(const Cell& cell) {
  const EnclosingBall ball = enclosing_ball(cell.points, cell.filled);
  return {ball.center, ball.radius * (1.0 + kRounding), 0, 0};
}

/// Binary tree of cells while it is made.
struct Branch {
  Cell cell;
  SphereTree::Node ball;
  std::array<int, 2> children{-1, -1};
};

std::array<Branch, 2> divide(const Cell& cell, RememberedInside& inside) {
  std::array<Branch, 2> best;
  double least = std::numeric_limits<double>::infinity();
  const Vector3d size = cell.box.sizes();
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] < 0.4 * size.maxCoeff()) continue;
    std::array<Branch, 2> branches;
    double cost = 0.0;
    for (Branch& branch : branches) {
      const double sign = &branch == branches.data() ? -1.0 : 1.0;
      branch.cell = Half(cell, axis, cell.box.center()[axis], sign).take();
      finish(branch.cell, inside);
      if (branch.cell.empty()) continue;
      branch.ball = ball_of(branch.cell);
      cost += std::pow(branch.ball.radius, 3);
    }
    if (cost < least) {
      least = cost;
      best = std::move(branches);
    }
  }
  return best;
}

/// Divides the largest ball again and again.
std::vector<Branch> grow(Branch root, const Inside& asked, const SphereTreeSettings& settings) {
  RememberedInside inside(asked);
  std::vector<Branch> branches{std::move(root)};
  std::vector<int> leaves{0};
  while (!leaves.empty() && static_cast<int>(leaves.size()) < settings.leaves) {
    const auto largest = std::max_element(leaves.begin(), leaves.end(), [&](int a, int b) {
      return branches[static_cast<std::size_t>(a)].ball.radius < branches[static_cast<std::size_t>(b)].ball.radius;
    });
    const auto parent = static_cast<std::size_t>(*largest);
    if (branches[parent].ball.radius <= settings.radius) break;
    std::array<Branch, 2> halves = divide(branches[parent].cell, inside);
    leaves.erase(largest);
    if (halves[0].cell.empty() && halves[1].cell.empty()) continue;  // coordinates too large to be divided
    branches[parent].cell = {};
    for (std::size_t side = 0; side < 2; ++side) {
      if (halves[side].cell.empty()) continue;
      branches[parent].children[side] = static_cast<int>(branches.size());
      leaves.push_back(static_cast<int>(branches.size()));
      branches.push_back(std::move(halves[side]));
    }
  }
  return branches;
}

/// The children of a branch in a tree with up to kBranching children a node: the largest balls are replaced by theirs.
std::vector<int> gathered(const std::vector<Branch>& branches, int index) {
  std::vector<int> children{index};
  while (static_cast<int>(children.size()) < kBranching) {
    int widest = -1;
    for (int i = 0; i < static_cast<int>(children.size()); ++i) {
      const Branch& branch = branches[static_cast<std::size_t>(children[static_cast<std::size_t>(i)])];
      if (branch.children == std::array<int, 2>{-1, -1}) continue;
      const auto radius = [&](int k) {
        return branches[static_cast<std::size_t>(children[static_cast<std::size_t>(k)])].ball.radius;
      };
      if (widest < 0 || radius(i) > radius(widest)) widest = i;
    }
    if (widest < 0) break;
    const Branch& parent = branches[static_cast<std::size_t>(children[static_cast<std::size_t>(widest)])];
    children.erase(children.begin() + widest);
    for (const int child : parent.children) {
      if (child >= 0) children.push_back(child);
    }
  }
  return children;
}

/// Takes the points from the leaves.
CellTree flatten(std::vector<Branch>& branches) {
  CellTree made;
  std::vector<SphereTree::Node>& nodes = made.tree.nodes;
  std::vector<int> source{0};
  nodes.push_back(branches[0].ball);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Branch& branch = branches[static_cast<std::size_t>(source[i])];
    std::vector<Vector3d>& points = made.points.emplace_back();
    if (branch.children == std::array<int, 2>{-1, -1}) {
      points = std::move(branch.cell.points);
      continue;
    }
    nodes[i].first_child = static_cast<int>(nodes.size());
    for (const int child : gathered(branches, source[i])) {
      nodes.push_back(branches[static_cast<std::size_t>(child)].ball);
      source.push_back(child);
    }
    nodes[i].children = static_cast<int>(nodes.size()) - nodes[i].first_child;
  }
  return made;
}

CellTree cell_tree(const TriangleMesh& surface, const Inside& inside, const SphereTreeSettings& settings) {
  require(surface.triangles.cols() > 0, "sphere_tree: a surface without triangles");
  require(settings.leaves >= 1 && settings.radius > 0.0, "sphere_tree: leaves must be at least 1, radius positive");
  Branch root;
  std::vector<int> index(static_cast<std::size_t>(surface.vertices.cols()), -1);
  for (Eigen::Index f = 0; f < surface.triangles.cols(); ++f) {
    root.cell.pieces.push_back({static_cast<int>(root.cell.corners.size()), 3});
    for (const int vertex : surface.triangles.col(f)) {
      int& known = index[static_cast<std::size_t>(vertex)];
      if (known < 0) {
        known = static_cast<int>(root.cell.points.size());
        root.cell.points.emplace_back(surface.vertices.col(vertex));
        root.cell.box.extend(root.cell.points.back());
      }
      root.cell.corners.push_back(known);
    }
  }
  root.ball = ball_of(root.cell);  // the solid lies in the convex hull of its surface
  std::vector<Branch> branches = grow(std::move(root), inside, settings);
  return flatten(branches);
}

/// Balls on the axis, each around a slice: they fit the side closely and stick out at the ends.
SphereTree slices(const Cylinder& cylinder, double longest) {
  SphereTree tree;
  std::vector<double> lengths{cylinder.length};
  const auto ball = [&](double z, double length) {
    return SphereTree::Node{{0.0, 0.0, z}, std::hypot(cylinder.radius, 0.5 * length) * (1.0 + kRounding), 0, 0};
  };
  tree.nodes.push_back(ball(0.0, cylinder.length));
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    if (lengths[i] <= longest) continue;
    const double length = lengths[i] / kBranching;
    tree.nodes[i].first_child = static_cast<int>(tree.nodes.size());
    tree.nodes[i].children = kBranching;
    for (int k = 0; k < kBranching; ++k) {
      tree.nodes.push_back(ball(tree.nodes[i].center.z() + length * (k - 0.5 * (kBranching - 1)), length));
      lengths.push_back(length);
    }
  }
  return tree;
}

}  // namespace

CellTree cell_tree(const TriangleMesh& mesh, const SolidRegion& region, const SphereTreeSettings& settings) {
  return cell_tree(
      mesh, [&](const Vector3d& p) { return region.touches(p); }, settings);
}

SphereTree sphere_tree(const TriangleMesh& surface, const Inside& inside, const SphereTreeSettings& settings) {
  return cell_tree(surface, inside, settings).tree;
}

SphereTree sphere_tree(const Shape& shape, const SphereTreeSettings& settings) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return {{{Vector3d::Zero(), sphere->radius, 0, 0}}};
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return slices(*cylinder, std::max(kSliceLength * cylinder->radius, cylinder->length / settings.leaves));
  }
  if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
    return cell_tree(**mesh, SolidRegion(**mesh), settings).tree;
  }
  // A box is convex and fills its bounding box.
  return sphere_tree(
      triangulate(shape), [](const Vector3d&) { return true; }, settings);
}

}  // namespace opponens::robot
