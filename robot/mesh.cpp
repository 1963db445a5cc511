// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "core/require.hpp"

namespace opponens::robot {

namespace {

/// Grows a mesh vertex by vertex.
struct Builder {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;

  int vertex(double x, double y, double z) {
    vertices.emplace_back(x, y, z);
    return static_cast<int>(vertices.size()) - 1;
  }

  TriangleMesh mesh(std::string source) const {
    TriangleMesh result;
    result.source = std::move(source);
    result.vertices.resize(3, static_cast<Eigen::Index>(vertices.size()));
    result.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i) result.vertices.col(static_cast<Eigen::Index>(i)) = vertices[i];
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      result.triangles.col(static_cast<Eigen::Index>(i)) = triangles[i];
    }
    return result;
  }
};

/// Vertex ids of one ring of a surface of revolution: one id repeated when the ring is a point on the axis.
std::vector<int> add_ring(Builder& builder, double radius, double height, int segments) {
  if (radius == 0.0) return std::vector<int>(static_cast<std::size_t>(segments), builder.vertex(0.0, 0.0, height));
  std::vector<int> ring;
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / segments;
    ring.push_back(builder.vertex(radius * std::cos(angle), radius * std::sin(angle), height));
  }
  return ring;
}

void connect_rings(Builder& builder, const std::vector<int>& below, const std::vector<int>& above) {
  for (std::size_t i = 0; i < below.size(); ++i) {
    const std::size_t next = (i + 1) % below.size();
    if (below[i] != below[next]) builder.triangles.emplace_back(below[i], below[next], above[next]);
    if (above[i] != above[next]) builder.triangles.emplace_back(below[i], above[next], above[i]);
  }
}

TriangleMesh box_mesh(const Box& box) {
  Builder builder;
  const Eigen::Vector3d h = 0.5 * box.size;
  for (int i = 0; i < 8; ++i) {
    builder.vertex((i & 1) != 0 ? h.x() : -h.x(), (i & 2) != 0 ? h.y() : -h.y(), (i & 4) != 0 ? h.z() : -h.z());
  }
  // Vertex i has bit 0, 1, 2 set where x, y, z is positive.
  builder.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return builder.mesh("box");
}

TriangleMesh sphere_mesh(double radius, int segments) {
  const int rings = std::max(2, segments / 2);
  std::vector<std::pair<double, double>> profile;
  profile.emplace_back(0.0, -radius);
  for (int i = 1; i < rings; ++i) {
    const double latitude = std::numbers::pi * i / rings;
    profile.emplace_back(radius * std::sin(latitude), -radius * std::cos(latitude));
  }
  profile.emplace_back(0.0, radius);
  TriangleMesh mesh = revolve(profile, segments);
  mesh.source = "sphere";
  return mesh;
}

struct TriangulateVisitor {
  int segments;
  TriangleMesh operator()(const Box& box) const { return box_mesh(box); }
  TriangleMesh operator()(const Sphere& sphere) const { return sphere_mesh(sphere.radius, segments); }
  TriangleMesh operator()(const Cylinder& c) const {
    TriangleMesh mesh = revolve({{c.radius, -0.5 * c.length}, {c.radius, 0.5 * c.length}}, segments);
    mesh.source = "cylinder";
    return mesh;
  }
  TriangleMesh operator()(const std::shared_ptr<const TriangleMesh>& mesh) const { return *mesh; }
};

/// Component number of every vertex (-1: in no triangle), numbered by their first vertex.
std::vector<int> component_of_vertices(const TriangleMesh& mesh, int& count) {
  std::vector<int> parent(static_cast<std::size_t>(mesh.vertices.cols()));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) {
      int& up = parent[static_cast<std::size_t>(v)];
      up = parent[static_cast<std::size_t>(up)];
      v = up;
    }
    return v;
  };
  std::vector<bool> used(parent.size(), false);
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = root(mesh.triangles(0, f));
      const int b = root(mesh.triangles(k, f));
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      used[static_cast<std::size_t>(mesh.triangles(k, f))] = true;
    }
  }
  std::vector<int> component(parent.size(), -1);
  count = 0;
  for (std::size_t v = 0; v < parent.size(); ++v) {
    if (!used[v]) continue;
    // The root is the smallest vertex of its component, so it was numbered before.
    const auto r = static_cast<std::size_t>(root(static_cast<int>(v)));
    component[v] = r == v ? count++ : component[r];
  }
  return component;
}

}  // namespace

TriangleMesh revolve(const std::vector<std::pair<double, double>>& profile, int segments) {
  require(profile.size() >= 2, "revolve: a profile needs at least two points");
  require(segments >= 3, [&] { return "revolve: needs at least 3 segments, got " + std::to_string(segments); });
  bool wide = false;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto& [radius, height] = profile[i];
    const bool end = i == 0 || i + 1 == profile.size();
    require(std::isfinite(radius) && std::isfinite(height) && radius >= 0.0 && (end || radius > 0.0),
            [&] { return "revolve: profile point " + std::to_string(i) + " needs a positive radius"; });
    require(i == 0 || height > profile[i - 1].second ||
                (height == profile[i - 1].second && radius > 0.0 && profile[i - 1].first > 0.0 &&
                 radius != profile[i - 1].first),
            [&] { return "revolve: profile point " + std::to_string(i) + " does not rise above the one before"; });
    wide = wide || radius > 0.0;
  }
  require(wide && profile.back().second > profile.front().second, "revolve: the profile encloses no volume");
  Builder builder;
  std::vector<int> below = add_ring(builder, profile.front().first, profile.front().second, segments);
  if (profile.front().first > 0.0)
    connect_rings(builder, add_ring(builder, 0.0, profile.front().second, segments), below);
  for (std::size_t i = 1; i < profile.size(); ++i) {
    std::vector<int> above = add_ring(builder, profile[i].first, profile[i].second, segments);
    connect_rings(builder, below, above);
    below = std::move(above);
  }
  if (profile.back().first > 0.0)
    connect_rings(builder, below, add_ring(builder, 0.0, profile.back().second, segments));
  return builder.mesh("revolution");
}

TriangleMesh triangulate(const Shape& shape, int segments) { return std::visit(TriangulateVisitor{segments}, shape); }

TriangleMesh merge(const std::vector<Geometry>& geometry) {
  TriangleMesh result;
  for (const Geometry& part : geometry) {
    const TriangleMesh mesh = triangulate(part.shape);
    const Eigen::Index v = result.vertices.cols();
    const Eigen::Index f = result.triangles.cols();
    result.vertices.conservativeResize(3, v + mesh.vertices.cols());
    result.triangles.conservativeResize(3, f + mesh.triangles.cols());
    result.vertices.rightCols(mesh.vertices.cols()) =
        (part.X_BG.linear() * mesh.vertices).colwise() + part.X_BG.translation();
    result.triangles.rightCols(mesh.triangles.cols()) = mesh.triangles.array() + static_cast<int>(v);
    result.source += (result.source.empty() ? "" : " + ") + mesh.source;
  }
  return result;
}

MassProperties mass_properties(const TriangleMesh& mesh) {
  // Tetrahedra from a vertex of the mesh rather than from the origin, which may be far away: less cancellation.
  MassProperties result{0.0, Eigen::Vector3d::Zero()};
  require(mesh.triangles.cols() > 0, "mass_properties: a mesh without triangles");
  const Eigen::Vector3d o = mesh.vertices.col(mesh.triangles(0, 0));
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, f)) - o;
    const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, f)) - o;
    const Eigen::Vector3d c = mesh.vertices.col(mesh.triangles(2, f)) - o;
    const double volume = a.dot(b.cross(c)) / 6.0;
    result.volume += volume;
    result.center_of_mass += volume * 0.25 * (a + b + c);
  }
  if (result.volume != 0.0) result.center_of_mass /= result.volume;
  result.center_of_mass += o;
  return result;
}

bool is_closed(const TriangleMesh& mesh) {
  // Undirected edges, sorted, with +1 or -1 for the direction: the signs of each edge have to cancel.
  std::vector<std::pair<std::uint64_t, int>> half_edges;
  half_edges.reserve(static_cast<std::size_t>(3 * mesh.triangles.cols()));
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles(k, f);
      const int b = mesh.triangles((k + 1) % 3, f);
      const auto low = static_cast<std::uint64_t>(std::min(a, b));
      half_edges.emplace_back((low << 32) | static_cast<std::uint64_t>(std::max(a, b)), a < b ? 1 : -1);
    }
  }
  std::sort(half_edges.begin(), half_edges.end());
  int sum = 0;
  for (std::size_t i = 0; i < half_edges.size(); ++i) {
    sum += half_edges[i].second;
    const bool last = i + 1 == half_edges.size() || half_edges[i + 1].first != half_edges[i].first;
    if (last && sum != 0) return false;
  }
  return !half_edges.empty();
}

std::vector<int> component_seeds(const TriangleMesh& mesh) {
  int count = 0;
  const std::vector<int> component = component_of_vertices(mesh, count);
  std::vector<int> seeds;
  for (std::size_t v = 0; v < component.size(); ++v) {
    if (component[v] == static_cast<int>(seeds.size())) seeds.push_back(static_cast<int>(v));
  }
  return seeds;
}

std::vector<int> component_of_triangles(const TriangleMesh& mesh) {
  int count = 0;
  const std::vector<int> component = component_of_vertices(mesh, count);
  std::vector<int> result;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    result.push_back(component[static_cast<std::size_t>(mesh.triangles(0, f))]);
  }
  return result;
}

std::vector<TriangleMesh> components(const TriangleMesh& mesh) {
  int count = 0;
  const std::vector<int> component = component_of_vertices(mesh, count);
  std::vector<Builder> parts(static_cast<std::size_t>(count));
  std::vector<int> renamed(component.size(), -1);
  for (std::size_t v = 0; v < component.size(); ++v) {
    if (component[v] < 0) continue;
    const auto p = mesh.vertices.col(static_cast<Eigen::Index>(v));
    renamed[v] = parts[static_cast<std::size_t>(component[v])].vertex(p.x(), p.y(), p.z());
  }
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const Eigen::Vector3i t = mesh.triangles.col(f);
    const int part = component[static_cast<std::size_t>(t[0])];
    parts[static_cast<std::size_t>(part)].triangles.emplace_back(renamed[static_cast<std::size_t>(t[0])],
                                                                 renamed[static_cast<std::size_t>(t[1])],
                                                                 renamed[static_cast<std::size_t>(t[2])]);
  }
  std::vector<TriangleMesh> result;
  for (const Builder& part : parts) result.push_back(part.mesh(mesh.source));
  return result;
}

void append_mesh_files(const std::vector<Geometry>& geometry, std::vector<std::filesystem::path>& files) {
  for (const Geometry& one : geometry) {
    const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&one.shape);
    if (mesh != nullptr && !(*mesh)->file.empty()) files.push_back((*mesh)->file);
  }
}

}  // namespace opponens::robot
