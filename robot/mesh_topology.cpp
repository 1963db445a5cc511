// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "robot/mesh.hpp"
#include "robot/mesh_distance.hpp"

namespace opponens::robot {

namespace {

double area_of(const TriangleMesh& mesh, Eigen::Index triangle) {
  const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, triangle));
  const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, triangle));
  const Eigen::Vector3d c = mesh.vertices.col(mesh.triangles(2, triangle));
  return 0.5 * (b - a).cross(c - a).norm();
}

/// Whether a triangle runs along an edge from its lower vertex to its higher one.
bool runs_forward(const TriangleMesh& mesh, int triangle, const MeshEdge& edge) {
  for (int k = 0; k < 3; ++k) {
    if (mesh.triangles(k, triangle) == edge.low) return mesh.triangles((k + 1) % 3, triangle) == edge.high;
  }
  return false;
}

using VertexTriple = std::array<int, 3>;

/// A triangle's vertices from the lowest on, in its order.
VertexTriple corners_from_lowest(const TriangleMesh& mesh, Eigen::Index triangle) {
  VertexTriple corners{mesh.triangles(0, triangle), mesh.triangles(1, triangle), mesh.triangles(2, triangle)};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Marks the triangles against the majority of one patch.
void mark_minority(const TriangleMesh& mesh, const std::vector<int>& patch, const std::vector<int>& side,
                   PatchOrientation& result) {
  double balance = 0.0;
  for (const int f : patch) balance += side[static_cast<std::size_t>(f)] * area_of(mesh, f);
  for (const int f : patch) {
    const bool turned = side[static_cast<std::size_t>(f)] * balance < 0.0;
    result.turned[static_cast<std::size_t>(f)] = turned;
    result.turned_count += turned ? 1 : 0;
  }
}

/// A solid that a component encloses, with its box.
struct Enclosed {
  MeshDistance distance;
  Eigen::Vector3d lower, upper;
  double volume;

  bool holds(const Eigen::Vector3d& p) const {
    if ((p.array() < lower.array()).any() || (p.array() > upper.array()).any()) return false;
    return (volume < 0.0) != distance.inside(p);
  }
};

}  // namespace

std::vector<MeshEdge> mesh_edges(const TriangleMesh& mesh) {
  std::vector<std::array<int, 3>> half_edges;  // low, high, triangle
  half_edges.reserve(static_cast<std::size_t>(3 * mesh.triangles.cols()));
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles(k, f), mesh.triangles((k + 1) % 3, f));
      half_edges.push_back({low, high, static_cast<int>(f)});
    }
  }
  std::sort(half_edges.begin(), half_edges.end());
  std::vector<MeshEdge> edges;
  for (const auto& [low, high, triangle] : half_edges) {
    if (edges.empty() || edges.back().low != low || edges.back().high != high) edges.push_back({low, high, {}, 0});
    MeshEdge& edge = edges.back();
    edge.triangles.push_back(triangle);
    edge.forward += runs_forward(mesh, triangle, edge) ? 1 : 0;
  }
  return edges;
}

PatchOrientation patch_orientation(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges) {
  const auto count = static_cast<std::size_t>(mesh.triangles.cols());
  std::vector<std::vector<std::pair<int, int>>> neighbours(count);  // triangle, 1: oriented alike, -1: not
  for (const MeshEdge& edge : edges) {
    if (edge.triangles.size() != 2) continue;
    const int alike = edge.forward == 1 ? 1 : -1;
    neighbours[static_cast<std::size_t>(edge.triangles[0])].emplace_back(edge.triangles[1], alike);
    neighbours[static_cast<std::size_t>(edge.triangles[1])].emplace_back(edge.triangles[0], alike);
  }
  PatchOrientation result;
  result.turned.assign(count, false);
  std::vector<int> side(count, 0);
  for (std::size_t seed = 0; seed < count; ++seed) {
    if (side[seed] != 0) continue;
    side[seed] = 1;
    std::vector<int> patch{static_cast<int>(seed)};
    for (std::size_t next = 0; next < patch.size(); ++next) {
      const auto f = static_cast<std::size_t>(patch[next]);
      for (const auto& [other, alike] : neighbours[f]) {
        int& other_side = side[static_cast<std::size_t>(other)];
        if (other_side == 0) patch.push_back(other);
        if (other_side != 0 && other_side != side[f] * alike) result.orientable = false;
        if (other_side == 0) other_side = side[f] * alike;
      }
    }
    mark_minority(mesh, patch, side, result);
  }
  return result;
}

int nonmanifold_vertices(const TriangleMesh& mesh) {
  std::vector<std::vector<int>> around(static_cast<std::size_t>(mesh.vertices.cols()));
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) around[static_cast<std::size_t>(mesh.triangles(k, f))].push_back(static_cast<int>(f));
  }
  int count = 0;
  for (std::size_t v = 0; v < around.size(); ++v) {
    // The triangles about v, joined where they share another vertex: one fan, or several.
    std::map<int, std::vector<int>> by_vertex;
    for (const int f : around[v]) {
      for (int k = 0; k < 3; ++k) {
        if (mesh.triangles(k, f) != static_cast<int>(v)) by_vertex[mesh.triangles(k, f)].push_back(f);
      }
    }
    std::map<int, bool> reached;
    std::vector<int> open;
    if (!around[v].empty()) open.push_back(around[v].front());
    while (!open.empty()) {
      const int f = open.back();
      open.pop_back();
      if (!reached.emplace(f, true).second) continue;
      for (int k = 0; k < 3; ++k) {
        if (mesh.triangles(k, f) == static_cast<int>(v)) continue;
        for (const int other : by_vertex[mesh.triangles(k, f)]) {
          if (reached.count(other) == 0) open.push_back(other);
        }
      }
    }
    count += reached.size() < around[v].size() ? 1 : 0;
  }
  return count;
}

std::vector<int> first_close_vertex(const TriangleMesh& mesh, double tolerance) {
  using Cell = std::array<long long, 3>;
  std::map<Cell, std::vector<int>> grid;
  std::vector<int> first(static_cast<std::size_t>(mesh.vertices.cols()));
  const Eigen::Vector3d origin = mesh.vertices.rowwise().minCoeff();
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    const Eigen::Vector3d p = mesh.vertices.col(v);
    const Eigen::Vector3d scaled = (p - origin) / tolerance;
    const Cell at{std::llround(std::floor(scaled.x())), std::llround(std::floor(scaled.y())),
                  std::llround(std::floor(scaled.z()))};
    int found = static_cast<int>(v);
    for (int offset = 0; offset < 27; ++offset) {
      const auto cell = grid.find({at[0] + offset % 3 - 1, at[1] + offset / 3 % 3 - 1, at[2] + offset / 9 - 1});
      if (cell == grid.end()) continue;
      for (const int other : cell->second) {
        if (other < found && (mesh.vertices.col(other) - p).norm() < tolerance) found = other;
      }
    }
    first[static_cast<std::size_t>(v)] = found;
    if (found == static_cast<int>(v)) grid[at].push_back(found);  // only these can be the first of others
  }
  return first;
}

RepeatedTriangles repeated_triangles(const TriangleMesh& mesh) {
  constexpr double kFinShare = 1e-3;
  std::map<VertexTriple, std::vector<Eigen::Index>> same;
  double area = 0.0;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    VertexTriple corners = corners_from_lowest(mesh, f);
    std::sort(corners.begin(), corners.end());
    same[corners].push_back(f);
    area += area_of(mesh, f);
  }
  const auto is_fin = [&mesh](const std::vector<Eigen::Index>& group) {
    return group.size() == 2 && corners_from_lowest(mesh, group[0]) != corners_from_lowest(mesh, group[1]);
  };
  double fin_area = 0.0;
  for (const auto& [corners, group] : same) fin_area += is_fin(group) ? 2.0 * area_of(mesh, group[0]) : 0.0;
  RepeatedTriangles result;
  result.kept.assign(static_cast<std::size_t>(mesh.triangles.cols()), true);
  for (const auto& [corners, group] : same) {
    const bool fin = fin_area < kFinShare * area && is_fin(group);
    for (std::size_t i = fin ? 0 : 1; i < group.size(); ++i) result.kept[static_cast<std::size_t>(group[i])] = false;
    result.fins += fin ? 1 : 0;
    result.dropped += fin ? 0 : static_cast<int>(group.size()) - 1;
  }
  return result;
}

std::vector<ComponentKind> component_kinds(const TriangleMesh& mesh) {
  const std::vector<TriangleMesh> parts = components(mesh);
  std::vector<std::unique_ptr<const Enclosed>> solids;
  for (const TriangleMesh& part : parts) {
    solids.push_back(nullptr);
    if (!is_closed(part)) continue;
    const double volume = mass_properties(part).volume;
    solids.back() = std::make_unique<const Enclosed>(Enclosed{MeshDistance(std::make_shared<const TriangleMesh>(part)),
                                                              part.vertices.rowwise().minCoeff(),
                                                              part.vertices.rowwise().maxCoeff(), volume});
  }
  std::vector<ComponentKind> kinds;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!solids[i]) {
      kinds.push_back(ComponentKind::open);
    } else if (solids[i]->volume >= 0.0) {
      kinds.push_back(ComponentKind::solid);
    } else {
      int depth = 0;
      for (std::size_t j = 0; j < parts.size(); ++j) {
        depth += j != i && solids[j] && solids[j]->holds(parts[i].vertices.col(0)) ? 1 : 0;
      }
      kinds.push_back(depth % 2 == 1 ? ComponentKind::cavity : ComponentKind::inside_out);
    }
  }
  return kinds;
}

void turn_triangle(TriangleMesh& mesh, Eigen::Index triangle) {
  std::swap(mesh.triangles(1, triangle), mesh.triangles(2, triangle));
}

}  // namespace opponens::robot
