// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_check.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>

#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/mesh_repair.hpp"
#include "robot/mesh_topology.hpp"
#include "robot/three_digits.hpp"

namespace opponens::robot {

namespace {

constexpr double kLongest = 20.0;     ///< m, of things that a hand or an arm meets
constexpr double kShortest = 0.002;   ///< m
constexpr double kUsualLow = 0.02;    ///< m, longest edge of the box of things that hands grasp
constexpr double kUsualHigh = 2.0;    ///< m
constexpr double kDegenerate = 1e-9;  ///< least height of a triangle, of the diagonal

std::vector<MeshHole> holes_of(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges) {
  std::vector<int> parent(static_cast<std::size_t>(mesh.vertices.cols()));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) v = parent[static_cast<std::size_t>(v)];
    return v;
  };
  for (const MeshEdge& edge : edges) {
    if (edge.triangles.size() != 1) continue;
    const int a = root(edge.low);
    const int b = root(edge.high);
    parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  std::map<int, MeshHole> by_root;
  for (const MeshEdge& edge : edges) {
    if (edge.triangles.size() != 1) continue;
    MeshHole& hole = by_root.try_emplace(root(edge.low), MeshHole{0, 0.0}).first->second;
    ++hole.edges;
    hole.length += (mesh.vertices.col(edge.low) - mesh.vertices.col(edge.high)).norm();
  }
  std::vector<MeshHole> holes;
  for (const auto& [vertex, hole] : by_root) holes.push_back(hole);
  std::stable_sort(holes.begin(), holes.end(),
                   [](const MeshHole& a, const MeshHole& b) { return a.length > b.length; });
  return holes;
}

bool is_degenerate(const TriangleMesh& mesh, Eigen::Index f, double least_height) {
  const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, f));
  const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, f));
  const Eigen::Vector3d c = mesh.vertices.col(mesh.triangles(2, f));
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return (b - a).cross(c - a).norm() <= least_height * longest;
}

int count_duplicates(const TriangleMesh& mesh) {
  std::set<std::array<int, 3>> seen;
  int duplicates = 0;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    std::array<int, 3> corners{mesh.triangles(0, f), mesh.triangles(1, f), mesh.triangles(2, f)};
    std::sort(corners.begin(), corners.end());
    duplicates += seen.insert(corners).second ? 0 : 1;
  }
  return duplicates;
}

bool is_soup(const TriangleMesh& written) {
  std::set<int> seen;
  for (Eigen::Index f = 0; f < written.triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (!seen.insert(written.triangles(k, f)).second) return false;
    }
  }
  return written.triangles.cols() > 1;
}

std::vector<double> likely_scales(double longest) {
  std::vector<double> scales;
  if (longest >= kShortest && longest <= kLongest) return scales;
  for (const double scale : {0.001, 1000.0, 0.01, 100.0, 0.0254, 1.0 / 0.0254}) {
    if (longest * scale >= kUsualLow && longest * scale <= kUsualHigh) scales.push_back(scale);
  }
  return scales;
}

std::string counted(int count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// What a factor between units means.
std::string unit_of_scale(double scale) {
  if (scale == 0.001) return "millimetres read as metres";
  if (scale == 0.01) return "centimetres read as metres";
  if (scale == 0.0254) return "inches read as metres";
  if (scale == 1000.0) return "metres read as millimetres";
  if (scale == 100.0) return "metres read as centimetres";
  return "metres read as inches";
}

std::string size_defect(const MeshReport& report) {
  const double longest = report.extent.maxCoeff();
  if (longest >= kShortest && longest <= kLongest) return "";
  std::string sentence = "is ";
  sentence.append(three_digits(longest)).append(" m long: a wrong unit?");
  for (const double scale : report.likely_scales) {
    sentence.append(" ").append(unit_of_scale(scale)).append(" it would be ");
    sentence.append(three_digits(longest * scale)).append(" m;");
  }
  if (sentence.back() == ';') sentence.pop_back();
  return sentence;
}

}  // namespace

MeshReport check_mesh(const TriangleMesh& written, bool self_intersections) {
  require(written.triangles.cols() > 0, "check_mesh: a mesh without triangles");
  const TriangleMesh mesh = merge_equal_vertices(written);
  MeshReport report;
  report.vertices = static_cast<int>(mesh.vertices.cols());
  report.triangles = static_cast<int>(written.triangles.cols());
  report.repeated_vertices = static_cast<int>(written.vertices.cols() - mesh.vertices.cols());
  report.soup = is_soup(written);
  report.extent = mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff();
  report.likely_scales = likely_scales(report.extent.maxCoeff());
  report.degenerate_triangles = report.triangles - static_cast<int>(mesh.triangles.cols());
  const double diagonal = report.extent.norm();
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    report.degenerate_triangles += is_degenerate(mesh, f, kDegenerate * diagonal) ? 1 : 0;
  }
  if (mesh.triangles.cols() == 0) return report;
  const std::vector<int> first = first_close_vertex(mesh, kCloseVertices * diagonal);
  for (std::size_t v = 0; v < first.size(); ++v) report.close_vertices += first[v] != static_cast<int>(v) ? 1 : 0;
  report.duplicate_triangles = count_duplicates(mesh);
  const std::vector<MeshEdge> edges = mesh_edges(mesh);
  report.holes = holes_of(mesh, edges);
  for (const MeshEdge& edge : edges) report.nonmanifold_edges += edge.triangles.size() > 2 ? 1 : 0;
  report.nonmanifold_vertices = nonmanifold_vertices(mesh);
  const PatchOrientation orientation = patch_orientation(mesh, edges);
  report.flipped_triangles = orientation.turned_count;
  report.orientable = orientation.orientable;
  for (const ComponentKind kind : component_kinds(mesh)) {
    ++report.components;
    report.open_components += kind == ComponentKind::open ? 1 : 0;
    report.cavities += kind == ComponentKind::cavity ? 1 : 0;
    report.inside_out += kind == ComponentKind::inside_out ? 1 : 0;
  }
  if (self_intersections) report.self_intersections = count_self_intersections(mesh);
  return report;
}

std::vector<std::string> defects(const MeshReport& report) {
  std::vector<std::string> found;
  const auto add = [&found](int count, const std::string& one, const std::string& many) {
    if (count > 0) found.push_back(counted(count, one, many));
  };
  if (!report.holes.empty()) {
    found.push_back(counted(static_cast<int>(report.holes.size()), "hole", "holes") + " (the longest rim has " +
                    counted(report.holes.front().edges, "edge", "edges") + ", " +
                    three_digits(report.holes.front().length) + " m)");
  }
  add(report.flipped_triangles, "triangle turned against its neighbours", "triangles turned against their neighbours");
  add(report.inside_out, "part inside out", "parts inside out");
  add(report.nonmanifold_edges, "edge of more than two triangles", "edges of more than two triangles");
  add(report.nonmanifold_vertices, "vertex where parts only touch", "vertices where parts only touch");
  add(report.duplicate_triangles, "triangle twice", "triangles twice");
  add(report.degenerate_triangles, "triangle without area", "triangles without area");
  add(report.close_vertices, "vertex beside another, not joined", "vertices beside others, not joined");
  add(report.self_intersections.value_or(0), "pair of triangles cross", "pairs of triangles cross");
  if (!report.orientable) found.push_back("a surface with only one side");
  if (const std::string size = size_defect(report); !size.empty()) found.push_back(size);
  return found;
}

std::vector<std::string> mesh_warnings(const Scene& scene) {
  std::vector<std::string> warnings;
  std::set<const TriangleMesh*> seen;
  for (const SceneBody& body : scene.bodies) {
    for (const Geometry& geometry : body.geometry) {
      const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&geometry.shape);
      if (mesh == nullptr || !seen.insert(mesh->get()).second) continue;
      std::string list;
      for (const std::string& defect : defects(check_mesh(**mesh))) list += (list.empty() ? "" : ", ") + defect;
      if (!list.empty()) warnings.push_back("body '" + body.name + "': mesh " + (*mesh)->source + ": " + list);
    }
  }
  return warnings;
}

}  // namespace opponens::robot
