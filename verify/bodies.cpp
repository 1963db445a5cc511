// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <variant>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/distance.h>

namespace opponens::verify {
namespace {

using Surface = fcl::BVHModel<fcl::OBBRSSd>;
using MeshPointer = std::shared_ptr<const robot::TriangleMesh>;

/// Equal for equal shapes.
using ShapeKey = std::tuple<std::size_t, double, double, double, const void*>;

ShapeKey key_of(const robot::Shape& shape) {
  const std::size_t kind = shape.index();
  if (const auto* box = std::get_if<robot::Box>(&shape)) {
    return {kind, box->size.x(), box->size.y(), box->size.z(), nullptr};
  }
  if (const auto* sphere = std::get_if<robot::Sphere>(&shape)) return {kind, sphere->radius, 0, 0, nullptr};
  if (const auto* cylinder = std::get_if<robot::Cylinder>(&shape)) {
    return {kind, cylinder->radius, cylinder->length, 0, nullptr};
  }
  return {kind, 0, 0, 0, std::get<MeshPointer>(shape).get()};
}

std::shared_ptr<Surface> surface_of(const robot::TriangleMesh& mesh) {
  auto model = std::make_shared<Surface>();
  model->beginModel(static_cast<int>(mesh.triangles.cols()), static_cast<int>(mesh.vertices.cols()));
  for (const auto& t : mesh.triangles.colwise()) {
    model->addTriangle(mesh.vertices.col(t[0]), mesh.vertices.col(t[1]), mesh.vertices.col(t[2]));
  }
  model->endModel();
  return model;
}

/// What equal shapes share.
struct Made {
  std::shared_ptr<const Solid> solid;
  std::shared_ptr<Surface> surface;  ///< null for spheres
  std::optional<double> sphere;      ///< m, its radius when it is one
};

double point_box_distance(const Eigen::Vector3d& p_B, const Eigen::Vector3d& half) {
  return (p_B.cwiseAbs() - half).cwiseMax(0.0).norm();
}

}  // namespace

struct Bodies::Part {
  std::string name;
  int link;                ///< -1: a scene body
  Eigen::Isometry3d X_BG;  ///< in the link, or in the world
  Made made;
  Eigen::Vector3d middle;  ///< m, of the bounding box in G
  Eigen::Vector3d half;    ///< m, half sizes of that box
  double radius;           ///< m, of the ball about its middle
  Eigen::Isometry3d X_WG;  ///< where it is now
  Eigen::Vector3d p_WM;    ///< m, the middle now

  void move(const Eigen::Isometry3d& X) {
    X_WG = X;
    p_WM = X * middle;
  }

  /// A vertex that lies near to another part's box, in that part's frame: always the nearer ball of two.
  Eigen::Vector3d vertex_towards(const Part& other) const {
    const BallTree& tree = made.solid->tree();
    const Eigen::Isometry3d X = other.X_WG.inverse() * X_WG;
    const auto away = [&](int ball) {
      const Eigen::Vector3d center = X * tree.balls()[static_cast<std::size_t>(ball)].center;
      return point_box_distance(center - other.middle, other.half);
    };
    int ball = 0;
    while (!tree.balls()[static_cast<std::size_t>(ball)].leaf) {
      const int one = ball + 1;
      const int two = tree.balls()[static_cast<std::size_t>(one)].next;
      ball = away(one) <= away(two) ? one : two;
    }
    const int begin = tree.balls()[static_cast<std::size_t>(ball)].begin;
    return X * tree.corners(tree.order()[static_cast<std::size_t>(begin)]).col(0);
  }

  /// This one is a sphere: from it to another part's surface; m, at most `bound`; 0 when it holds the other.
  double distance_of_sphere(const Part& other, double bound) const {
    const Eigen::Vector3d center = other.X_WG.inverse() * X_WG.translation();
    const double reach = bound + *made.sphere;
    const double to =
        other.made.sphere ? center.norm() - *other.made.sphere : other.made.solid->distance(center, reach);
    if (to >= reach) return bound;  // exactly: reach less the radius may be rounded to less
    return std::clamp(to - *made.sphere, 0.0, bound);
  }

  /// This one is a sphere. With its centre outside the other, no point of it is deeper there than the other's nearest
  /// point is in the sphere. Nothing when the centre is inside.
  std::optional<double> depth_of_sphere(const Part& other) const {
    const Eigen::Vector3d center = other.X_WG.inverse() * X_WG.translation();
    const double r = *made.sphere;
    if (other.made.solid->inside(center)) return std::nullopt;
    const double to = other.made.sphere ? center.norm() - *other.made.sphere : other.made.solid->distance(center, r);
    return std::clamp(r - to, 0.0, r);
  }

  bool reaches_into(const Part& other) const {
    const Eigen::Isometry3d X = other.X_WG.inverse() * X_WG;
    for (const auto& point : made.solid->component_points().colwise()) {
      if (other.made.solid->inside(X * point)) return true;
    }
    return false;
  }
};

struct Bodies::Data {
  const robot::RobotModel& robot;
  Eigen::Isometry3d X_WR;
  std::vector<Part> parts;  ///< links first
  std::vector<Pair> pairs;
  std::map<ShapeKey, Made> made;

  const Part& part(int index) const { return parts[static_cast<std::size_t>(index)]; }

  void add(const std::string& name, int link, const robot::Geometry& geometry, const Eigen::Isometry3d& X_WB) {
    Made& shared = made[key_of(geometry.shape)];
    if (!shared.solid) {
      shared.solid = std::make_shared<const Solid>(geometry.shape);
      if (const auto* sphere = std::get_if<robot::Sphere>(&geometry.shape)) {
        shared.sphere = sphere->radius;
      } else {
        shared.surface = surface_of(shared.solid->mesh());
      }
    }
    const Eigen::AlignedBox3d& box = shared.solid->bounds();
    const Eigen::Vector3d middle = box.center();
    const double radius =
        std::sqrt((shared.solid->mesh().vertices.colwise() - middle).colwise().squaredNorm().maxCoeff());
    Part part{name, link, link < 0 ? X_WB * geometry.X_BG : geometry.X_BG, shared, middle, 0.5 * box.sizes(), radius,
              {},   {}};
    part.move(part.X_BG);
    parts.push_back(std::move(part));
  }

  void add_pairs() {
    const int count = static_cast<int>(parts.size());
    for (int i = 0; i < count; ++i) {
      for (int j = i + 1; j < count; ++j) {
        const int a = part(i).link;
        const int b = part(j).link;
        if (a < 0 || a == b) continue;
        if (b >= 0 && robot.description().allowed_collisions.count(std::minmax(a, b)) == 1) continue;
        pairs.push_back({i, j});
      }
    }
  }
};

Bodies::Bodies(const robot::RobotModel& robot, const robot::Scene& scene)
    : data_(std::make_unique<Data>(Data{robot, scene.X_WR, {}, {}, {}})) {
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    for (const robot::Geometry& g : robot.links()[l].collision) {
      data_->add(robot.links()[l].name, static_cast<int>(l), g, Eigen::Isometry3d::Identity());
    }
  }
  for (const robot::SceneBody& body : scene.bodies) {
    for (const robot::Geometry& g : body.geometry) data_->add(body.name, -1, g, body.X_WB);
  }
  data_->add_pairs();
}

Bodies::~Bodies() = default;

const std::vector<Bodies::Pair>& Bodies::pairs() const { return data_->pairs; }
const std::string& Bodies::name(int part) const { return data_->part(part).name; }
int Bodies::link(int part) const { return data_->part(part).link; }

void Bodies::place(const std::vector<Eigen::Isometry3d>& X_RL) {
  for (Part& part : data_->parts) {
    if (part.link >= 0) part.move(data_->X_WR * X_RL[static_cast<std::size_t>(part.link)] * part.X_BG);
  }
}

double Bodies::gap(const Pair& pair, double enough) const {
  const Part& a = data_->part(pair.first);
  const Part& b = data_->part(pair.second);
  const Eigen::Vector3d between = b.p_WM - a.p_WM;
  const double balls = between.norm() - a.radius - b.radius;
  if (balls >= enough) return balls;
  const Eigen::Matrix3d& R_a = a.X_WG.linear();
  const Eigen::Matrix3d& R_b = b.X_WG.linear();
  const Eigen::Vector3d t_a = R_a.transpose() * between;
  const Eigen::Vector3d t_b = R_b.transpose() * between;
  double best =
      std::max({0.0, balls, point_box_distance(t_a, a.half) - b.radius, point_box_distance(t_b, b.half) - a.radius});
  if (best >= enough) return best;
  // Separation along the normals of both boxes' faces (Gottschalk, Lin and Manocha 1996, doi:10.1145/237170.237244).
  const Eigen::Matrix3d turn = (R_a.transpose() * R_b).cwiseAbs();
  best = std::max(best, (t_a.cwiseAbs() - a.half - turn * b.half).maxCoeff());
  return std::max(best, (t_b.cwiseAbs() - b.half - turn.transpose() * a.half).maxCoeff());
}

Bodies::NearPoints Bodies::points(const Pair& pair) const {
  const auto any = [&](int part) -> Eigen::Vector3d { return data_->part(part).made.solid->mesh().vertices.col(0); };
  return {any(pair.first), any(pair.second)};
}

double Bodies::apart(const Pair& pair, const NearPoints& points) const {
  return (data_->part(pair.first).X_WG * points.first - data_->part(pair.second).X_WG * points.second).norm();
}

double Bodies::approach(const Pair& pair, double bound) const {
  const Part* fine = &data_->part(pair.first);
  const Part* coarse = &data_->part(pair.second);
  if (fine->made.solid->mesh().triangles.cols() < coarse->made.solid->mesh().triangles.cols()) std::swap(fine, coarse);
  return coarse->made.solid->distance(fine->vertex_towards(*coarse), bound);
}

double Bodies::distance(const Pair& pair, double bound) const {
  NearPoints unused;
  return distance(pair, bound, unused);
}

double Bodies::distance(const Pair& pair, double bound, NearPoints& near) const {
  const Part& a = data_->part(pair.first);
  const Part& b = data_->part(pair.second);
  if (a.made.sphere) return a.distance_of_sphere(b, bound);
  if (b.made.sphere) return b.distance_of_sphere(a, bound);
  const fcl::DistanceRequestd request(true);
  fcl::DistanceResultd result(bound);  // only nearer pairs of triangles are descended to
  fcl::distance(a.made.surface.get(), a.X_WG, b.made.surface.get(), b.X_WG, request, result);
  if (result.min_distance < bound) {
    near = {a.X_WG.inverse() * result.nearest_points[0], b.X_WG.inverse() * result.nearest_points[1]};
  }
  return std::clamp(result.min_distance, 0.0, bound);
}

bool Bodies::contained(const Pair& pair) const {
  const Part& a = data_->part(pair.first);
  const Part& b = data_->part(pair.second);
  return a.reaches_into(b) || b.reaches_into(a);
}

Depth Bodies::depth(const Pair& pair, double enough) const {
  const Part& a = data_->part(pair.first);
  const Part& b = data_->part(pair.second);
  std::optional<double> exact;
  if (a.made.sphere) exact = a.depth_of_sphere(b);
  if (!exact && b.made.sphere) exact = b.depth_of_sphere(a);
  if (exact) return {*exact, *exact};
  const Eigen::Isometry3d X_BA = b.X_WG.inverse() * a.X_WG;
  Depth one = penetration(*a.made.solid, *b.made.solid, X_BA, enough);
  const Depth other = penetration(*b.made.solid, *a.made.solid, X_BA.inverse(), enough);
  return {std::max(one.attained, other.attained), std::max(one.bound, other.bound)};
}

}  // namespace opponens::verify
