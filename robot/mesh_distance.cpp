// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "robot/bounding_volume_tree.hpp"

namespace opponens::robot {

namespace {

double angle_between(const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

/// Normals that decide the sign: of each face; of each vertex, the faces' weighted by their angle there; of each edge,
/// the sum of its faces'. Columns are unit, or zero where faces cancel or have no area.
struct PseudoNormals {
  Eigen::Matrix3Xd face;              ///< [3 x F]
  Eigen::Matrix3Xd vertex;            ///< [3 x V]
  Eigen::Matrix3Xd edge;              ///< [3 x 3F], column 3 f + k: edge from corner k of triangle f
  std::vector<bool> vertex_manifold;  ///< [V] false where several fans meet: the normal does not tell the sign there
  std::vector<bool> edge_manifold;    ///< [3F] false where more than two triangles meet

  explicit PseudoNormals(const TriangleMesh& mesh)
      : face(Eigen::Matrix3Xd::Zero(3, mesh.triangles.cols())),
        vertex(Eigen::Matrix3Xd::Zero(3, mesh.vertices.cols())),
        edge(Eigen::Matrix3Xd::Zero(3, 3 * mesh.triangles.cols())),
        vertex_manifold(static_cast<std::size_t>(mesh.vertices.cols()), true),
        edge_manifold(static_cast<std::size_t>(3 * mesh.triangles.cols()), true) {
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
      const Eigen::Vector3i t = mesh.triangles.col(f);
      const Eigen::Vector3d a = mesh.vertices.col(t[0]);
      const Eigen::Vector3d b = mesh.vertices.col(t[1]);
      const Eigen::Vector3d c = mesh.vertices.col(t[2]);
      face.col(f) = (b - a).cross(c - a).stableNormalized();
      vertex.col(t[0]) += angle_between(b - a, c - a) * face.col(f);
      vertex.col(t[1]) += angle_between(c - b, a - b) * face.col(f);
      vertex.col(t[2]) += angle_between(a - c, b - c) * face.col(f);
    }
    for (Eigen::Index v = 0; v < vertex.cols(); ++v) vertex.col(v).stableNormalize();
    add_edges(mesh);
  }

 private:
  using HalfEdge = std::pair<std::uint64_t, int>;  ///< undirected edge, slot 3 f + k of the corner it starts from

  void add_edges(const TriangleMesh& mesh) {
    std::vector<HalfEdge> half_edges;
    half_edges.reserve(static_cast<std::size_t>(edge.cols()));
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const int a = mesh.triangles(k, f);
        const int b = mesh.triangles((k + 1) % 3, f);
        half_edges.emplace_back(
            (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint64_t>(std::max(a, b)),
            static_cast<int>(3 * f + k));
      }
    }
    std::sort(half_edges.begin(), half_edges.end());
    Fans fans(mesh);
    for (std::size_t begin = 0; begin < half_edges.size();) {
      std::size_t end = begin;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (; end < half_edges.size() && half_edges[end].first == half_edges[begin].first; ++end) {
        sum += face.col(half_edges[end].second / 3);
      }
      sum.stableNormalize();
      if (end - begin == 2) fans.join(half_edges[begin].second, half_edges[begin + 1].second);
      for (std::size_t i = begin; i < end; ++i) {
        edge.col(half_edges[i].second) = sum;
        edge_manifold[static_cast<std::size_t>(half_edges[i].second)] = end - begin <= 2;
      }
      begin = end;
    }
    fans.mark_pinched(vertex_manifold);
  }

  /// Groups the triangle corners around each vertex that are linked through edges of two triangles.
  class Fans {
   public:
    explicit Fans(const TriangleMesh& mesh)
        : mesh_(mesh), parent_(static_cast<std::size_t>(3 * mesh.triangles.cols())) {
      std::iota(parent_.begin(), parent_.end(), 0);
    }

    void join(int slot_a, int slot_b) {
      for (const int a : {slot_a, next(slot_a)}) {
        for (const int b : {slot_b, next(slot_b)}) {
          if (vertex(a) == vertex(b)) parent_[static_cast<std::size_t>(root(a))] = root(b);
        }
      }
    }

    /// A vertex with more than one fan joins parts of the surface that only touch there.
    void mark_pinched(std::vector<bool>& manifold) {
      std::vector<int> fan_of(manifold.size(), -1);
      for (int slot = 0; slot < static_cast<int>(parent_.size()); ++slot) {
        int& fan = fan_of[static_cast<std::size_t>(vertex(slot))];
        if (fan >= 0 && fan != root(slot)) manifold[static_cast<std::size_t>(vertex(slot))] = false;
        fan = root(slot);
      }
    }

   private:
    static int next(int slot) { return slot % 3 == 2 ? slot - 2 : slot + 1; }
    int vertex(int slot) const { return mesh_.triangles(slot % 3, slot / 3); }
    int root(int slot) {
      while (parent_[static_cast<std::size_t>(slot)] != slot) {
        int& up = parent_[static_cast<std::size_t>(slot)];
        up = parent_[static_cast<std::size_t>(up)];
        slot = up;
      }
      return slot;
    }

    const TriangleMesh& mesh_;
    std::vector<int> parent_;
  };
};

/// Winding number of the mesh about p: 1 inside a closed mesh, 0 outside. O(F). Solid angles by Van Oosterom and
/// Strackee 1983, doi:10.1109/TBME.1983.325207.
double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double sum = 0.0;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, f)) - p;
    const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, f)) - p;
    const Eigen::Vector3d c = mesh.vertices.col(mesh.triangles(2, f)) - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

}  // namespace

struct MeshDistance::Tree {
  explicit Tree(std::shared_ptr<const TriangleMesh> m) : mesh(std::move(m)), volumes(*mesh), normals(*mesh) {}

  Eigen::Vector3d normal(int triangle, TriangleFeature feature) const {
    const int k = static_cast<int>(feature);
    if (feature == TriangleFeature::face) return normals.face.col(triangle);
    if (k >= 3) return normals.edge.col(3 * triangle + k - 3);
    return normals.vertex.col(mesh->triangles(k, triangle));
  }

  bool sign_by_normal(int triangle, TriangleFeature feature) const {
    const int k = static_cast<int>(feature);
    if (feature == TriangleFeature::face) return true;
    if (k >= 3) return normals.edge_manifold[static_cast<std::size_t>(3 * triangle + k - 3)];
    return normals.vertex_manifold[static_cast<std::size_t>(mesh->triangles(k, triangle))];
  }

  std::shared_ptr<const TriangleMesh> mesh;
  BoundingVolumeTree volumes;
  PseudoNormals normals;
};

MeshDistance::MeshDistance(std::shared_ptr<const TriangleMesh> mesh) {
  require(mesh != nullptr, "MeshDistance: no mesh");
  tree_ = std::make_unique<const Tree>(std::move(mesh));
}
MeshDistance::~MeshDistance() = default;
MeshDistance::MeshDistance(MeshDistance&&) noexcept = default;
MeshDistance& MeshDistance::operator=(MeshDistance&&) noexcept = default;

MeshDistance::Query MeshDistance::query(const Eigen::Vector3d& p) const {
  return query(p, std::numeric_limits<double>::infinity());
}

MeshDistance::Query MeshDistance::query(const Eigen::Vector3d& p, double within) const {
  require(p.allFinite(), "MeshDistance: the point is not finite");
  BoundingVolumeTree::Nearest nearest = tree_->volumes.nearest(p, within);
  if (nearest.triangle < 0) nearest = tree_->volumes.nearest(p);  // what was known of the point was wrong
  const Eigen::Vector3d away = p - nearest.point;
  const Eigen::Vector3d normal = tree_->normal(nearest.triangle, nearest.feature);
  const double distance = std::sqrt(nearest.squared_distance);
  bool inside = away.dot(normal) < 0.0;
  if (!tree_->sign_by_normal(nearest.triangle, nearest.feature) && distance > 0.0) {
    inside = winding_number(*tree_->mesh, p) > 0.5;
  }
  const double sign = inside ? -1.0 : 1.0;
  // On the surface (or too near to tell a direction) the gradient is the normal there.
  Query query{sign * distance, nearest.point, normal, nearest.triangle};
  if (distance > 1e-12 || normal.isZero()) query.gradient = distance > 0.0 ? (away * (sign / distance)).eval() : normal;
  return query;
}

const TriangleMesh& MeshDistance::mesh() const { return *tree_->mesh; }

}  // namespace opponens::robot
