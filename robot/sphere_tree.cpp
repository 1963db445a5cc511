// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/sphere_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/solid_region.hpp"

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

/// Radii are enlarged by this share, far above the rounding of distances in double precision.
constexpr double kRounding = 1e-12;
constexpr int kCenterSteps = 100;
constexpr int kCoreSetRounds = 4;
constexpr int kBranching = 4;         ///< children per node wanted
constexpr double kSliceLength = 0.5;  ///< of a cylinder's slices at most, in radii

/// A convex piece of a triangle: its corners, in the surface's list of points.
struct Piece {
  int first;
  int count;
};

/// The part of the surface in a cell.
struct Cell {
  Eigen::AlignedBox3d box;
  std::vector<Vector3d> points;  ///< corners of the pieces, one piece after the other
  std::vector<Piece> pieces;
  std::vector<Vector3d> corners;  ///< of the box, in the solid
};

void add_piece(Cell& cell, const Vector3d* corners, int count) {
  cell.pieces.push_back({static_cast<int>(cell.points.size()), count});
  cell.points.insert(cell.points.end(), corners, corners + count);
}

/// Shrinks the box to the points: the solid inside the cell lies in their convex hull.
void finish(Cell& cell, const Inside& inside) {
  cell.corners.clear();
  for (int k = 0; k < 8; ++k) {
    const Vector3d corner = cell.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k));
    if (inside(corner)) cell.corners.push_back(corner);
  }
  cell.box.setEmpty();
  for (const Vector3d& p : cell.points) cell.box.extend(p);
  for (const Vector3d& p : cell.corners) cell.box.extend(p);
}

/// The convex polygon on the side of the plane x[axis] = level that `sign` names; corners on the plane belong to both.
/// Returns the number of corners.
int clip(const Vector3d* polygon, int count, int axis, double level, double sign, Vector3d* clipped) {
  int size = 0;
  for (int i = 0; i < count; ++i) {
    const Vector3d& a = polygon[i];
    const Vector3d& b = polygon[(i + 1) % count];
    const double da = sign * (a[axis] - level);
    const double db = sign * (b[axis] - level);
    if (da >= 0.0) clipped[size++] = a;
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
      Vector3d& cut = clipped[size++];
      cut = a + (b - a) * (da / (da - db));
      cut[axis] = level;
    }
  }
  return size;
}

/// The two halves of a cell.
std::array<Cell, 2> cut(const Cell& cell, int axis, double level, const Inside& inside) {
  std::array<Cell, 2> halves;
  std::vector<Vector3d> clipped;
  for (std::size_t side = 0; side < 2; ++side) {
    Cell& half = halves[side];
    half.box = cell.box;
    (side == 0 ? half.box.max() : half.box.min())[axis] = level;
    for (const Piece& piece : cell.pieces) {
      clipped.resize(2 * static_cast<std::size_t>(piece.count));
      const int count = clip(&cell.points[static_cast<std::size_t>(piece.first)], piece.count, axis, level,
                             side == 0 ? -1.0 : 1.0, clipped.data());
      if (count > 0) add_piece(half, clipped.data(), count);
    }
    finish(half, inside);
  }
  return halves;
}

/// The point of the cell farthest from a center, and its squared distance.
std::pair<const Vector3d*, double> farthest(const Cell& cell, const Vector3d& center) {
  std::pair<const Vector3d*, double> far{nullptr, -1.0};
  for (const auto* points : {&cell.points, &cell.corners}) {
    for (const Vector3d& p : *points) {
      const double squared = (p - center).squaredNorm();
      if (squared > far.second) far = {&p, squared};
    }
  }
  return far;
}

/// Points of the cell that are extreme along the axes and diagonals of a cube: their ball is nearly that of all.
std::vector<Vector3d> extreme_points(const Cell& cell) {
  std::vector<Vector3d> extremes;
  for (int code = 14; code < 27; ++code) {  // one of each direction and its opposite
    const Vector3d direction(code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1);
    std::pair<const Vector3d*, double> low{nullptr, std::numeric_limits<double>::infinity()};
    std::pair<const Vector3d*, double> high{nullptr, -std::numeric_limits<double>::infinity()};
    for (const auto* points : {&cell.points, &cell.corners}) {
      for (const Vector3d& p : *points) {
        const double along = direction.dot(p);
        if (along < low.second) low = {&p, along};
        if (along > high.second) high = {&p, along};
      }
    }
    extremes.push_back(*low.first);
    extremes.push_back(*high.first);
  }
  return extremes;
}

/// Nearly the center of the smallest ball around some points: steps towards the farthest (Badoiu and Clarkson 2003,
/// "Smaller core-sets for balls").
Vector3d ball_center(const std::vector<Vector3d>& points, const Vector3d& start) {
  Vector3d center = start;
  Vector3d best = start;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= kCenterSteps; ++i) {
    const Vector3d* far = nullptr;
    double squared = -1.0;
    for (const Vector3d& p : points) {
      if ((p - center).squaredNorm() > squared) std::tie(far, squared) = std::pair(&p, (p - center).squaredNorm());
    }
    if (squared < least) std::tie(best, least) = std::pair(center, squared);
    center += (*far - center) / (i + 1.0);
  }
  return best;
}

/// A ball around all points of a cell, nearly the smallest: that of a few of them, to which the farthest is added.
SphereTree::Node ball_of(const Cell& cell) {
  std::vector<Vector3d> few = extreme_points(cell);
  SphereTree::Node ball{cell.box.center(), 0.0, 0, 0};
  double least = std::numeric_limits<double>::infinity();
  Vector3d center = ball_center(few, ball.center);
  for (int round = 0; round < kCoreSetRounds; ++round) {
    const auto [far, squared] = farthest(cell, center);
    if (squared < least) std::tie(ball.center, least) = std::pair(center, squared);
    few.push_back(*far);
    center = ball_center(few, center);
  }
  ball.radius = std::sqrt(least) * (1.0 + kRounding);
  return ball;
}

/// Binary tree of cells while it is made.
struct Branch {
  Cell cell;
  SphereTree::Node ball;
  std::array<int, 2> children{-1, -1};
};

std::array<Branch, 2> divide(const Cell& cell, const Inside& inside) {
  std::array<Branch, 2> best;
  double least = std::numeric_limits<double>::infinity();
  const Vector3d size = cell.box.sizes();
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] < 0.4 * size.maxCoeff()) continue;
    std::array<Cell, 2> halves = cut(cell, axis, cell.box.center()[axis], inside);
    std::array<Branch, 2> branches;
    double cost = 0.0;
    for (std::size_t side = 0; side < 2; ++side) {
      if (halves[side].points.empty() && halves[side].corners.empty()) continue;
      branches[side].ball = ball_of(halves[side]);
      cost += std::pow(branches[side].ball.radius, 3);
      branches[side].cell = std::move(halves[side]);
    }
    if (cost < least) {
      least = cost;
      best = std::move(branches);
    }
  }
  return best;
}

bool empty(const Branch& branch) { return branch.cell.points.empty() && branch.cell.corners.empty(); }

/// Divides the largest ball again and again.
std::vector<Branch> grow(Branch root, const Inside& inside, const SphereTreeSettings& settings) {
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
    branches[parent].cell = {};
    for (std::size_t side = 0; side < 2; ++side) {
      if (empty(halves[side])) continue;
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

SphereTree flatten(const std::vector<Branch>& branches) {
  SphereTree tree;
  std::vector<int> source{0};
  tree.nodes.push_back(branches[0].ball);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Branch& branch = branches[static_cast<std::size_t>(source[i])];
    if (branch.children == std::array<int, 2>{-1, -1}) continue;
    tree.nodes[i].first_child = static_cast<int>(tree.nodes.size());
    for (const int child : gathered(branches, source[i])) {
      tree.nodes.push_back(branches[static_cast<std::size_t>(child)].ball);
      source.push_back(child);
    }
    tree.nodes[i].children = static_cast<int>(tree.nodes.size()) - tree.nodes[i].first_child;
  }
  return tree;
}

}  // namespace

SphereTree sphere_tree(const TriangleMesh& surface, const Inside& inside, const SphereTreeSettings& settings) {
  require(surface.triangles.cols() > 0, "sphere_tree: a surface without triangles");
  require(settings.leaves >= 1 && settings.radius > 0.0, "sphere_tree: leaves must be at least 1, radius positive");
  Branch root;
  root.cell.points.reserve(3 * static_cast<std::size_t>(surface.triangles.cols()));
  for (Eigen::Index f = 0; f < surface.triangles.cols(); ++f) {
    const std::array<Vector3d, 3> corners{surface.vertices.col(surface.triangles(0, f)),
                                          surface.vertices.col(surface.triangles(1, f)),
                                          surface.vertices.col(surface.triangles(2, f))};
    add_piece(root.cell, corners.data(), 3);
    for (const Vector3d& p : corners) root.cell.box.extend(p);
  }
  root.ball = ball_of(root.cell);  // the solid lies in the convex hull of its surface
  return flatten(grow(std::move(root), inside, settings));
}

namespace {

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

SphereTree sphere_tree(const Shape& shape, const SphereTreeSettings& settings) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return {{{Vector3d::Zero(), sphere->radius, 0, 0}}};
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return slices(*cylinder, std::max(kSliceLength * cylinder->radius, cylinder->length / settings.leaves));
  }
  if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
    const SolidRegion region(**mesh);
    return sphere_tree(
        **mesh, [&](const Vector3d& p) { return region.touches(p); }, settings);
  }
  // A box is convex and fills its bounding box.
  return sphere_tree(
      triangulate(shape), [](const Vector3d&) { return true; }, settings);
}

}  // namespace opponens::robot
