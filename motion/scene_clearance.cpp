// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/scene_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <variant>

#include "core/require.hpp"
#include "robot/mesh_cover.hpp"
#include "robot/mesh_distance.hpp"
#include "robot/sphere_tree.hpp"

namespace opponens::motion {
namespace {

struct Ball {
  Eigen::Vector3d center;  ///< m, in the link or body
  double radius;
};

struct LinkBalls {
  int link;
  std::vector<Ball> balls;
};

struct Away {
  double distance;
  Eigen::Vector3d gradient;
};

/// From a box about the origin with these half sizes; also what is left of a cylinder in (radius, z).
template <int N>
std::pair<double, Eigen::Matrix<double, N, 1>> from_box(const Eigen::Matrix<double, N, 1>& p,
                                                        const Eigen::Matrix<double, N, 1>& half) {
  using Vector = Eigen::Matrix<double, N, 1>;
  const Vector beyond = p.cwiseAbs() - half;
  const Vector outside = beyond.cwiseMax(0.0);
  const Vector sign = p.unaryExpr([](double x) { return x < 0.0 ? -1.0 : 1.0; });
  if (const double distance = outside.norm(); distance > 0.0) return {distance, sign.cwiseProduct(outside) / distance};
  Eigen::Index nearest = 0;
  const double depth = beyond.maxCoeff(&nearest);
  return {depth, sign[nearest] * Vector::Unit(nearest)};
}

/// A shape of the scene, in the robot's root frame.
class Obstacle {
 public:
  Obstacle(const robot::Shape& shape, const Eigen::Isometry3d& X_RG) : shape_(shape), X_RG_(X_RG) {
    if (const auto* mesh = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&shape)) {
      mesh_ = std::make_shared<const robot::MeshDistance>(*mesh);
      const Eigen::Vector3d low = (*mesh)->vertices.rowwise().minCoeff();
      const Eigen::Vector3d high = (*mesh)->vertices.rowwise().maxCoeff();
      bound_ = {0.5 * (low + high), 0.5 * (high - low).norm()};
    } else if (const auto* box = std::get_if<robot::Box>(&shape)) {
      bound_ = {Eigen::Vector3d::Zero(), 0.5 * box->size.norm()};
    } else if (const auto* cylinder = std::get_if<robot::Cylinder>(&shape)) {
      bound_ = {Eigen::Vector3d::Zero(), std::hypot(cylinder->radius, 0.5 * cylinder->length)};
    } else {
      bound_ = {Eigen::Vector3d::Zero(), std::get<robot::Sphere>(shape).radius};
    }
  }

  /// Never more than the distance.
  double at_least(const Eigen::Vector3d& p_R) const {
    return (X_RG_.inverse() * p_R - bound_.center).norm() - bound_.radius;
  }

  Away away(const Eigen::Vector3d& p_R) const {
    const Eigen::Vector3d p = X_RG_.inverse() * p_R;
    Away result = in_frame(p);
    result.gradient = X_RG_.linear() * result.gradient;
    return result;
  }

 private:
  Away in_frame(const Eigen::Vector3d& p) const {
    if (mesh_) {
      const auto query = mesh_->query(p);
      return {query.distance, query.gradient};
    }
    if (const auto* box = std::get_if<robot::Box>(&shape_)) {
      const auto [distance, gradient] = from_box<3>(p, 0.5 * box->size);
      return {distance, gradient};
    }
    if (const auto* cylinder = std::get_if<robot::Cylinder>(&shape_)) {
      const double radius = std::max(p.head<2>().norm(), 1e-12);
      const auto [distance, gradient] = from_box<2>({radius, p.z()}, {cylinder->radius, 0.5 * cylinder->length});
      return {distance, {gradient[0] * p.x() / radius, gradient[0] * p.y() / radius, gradient[1]}};
    }
    const double norm = std::max(p.norm(), 1e-12);
    return {norm - std::get<robot::Sphere>(shape_).radius, p / norm};
  }

  robot::Shape shape_;
  Eigen::Isometry3d X_RG_;
  std::shared_ptr<const robot::MeshDistance> mesh_;
  Ball bound_{};
};

/// The leaves of the tree cut where it has few enough nodes: the widest node is opened first.
std::vector<Ball> balls_of(const robot::SphereTree& tree, const Eigen::Isometry3d& X_LG) {
  constexpr std::size_t kBalls = 12;
  std::vector<int> open{0};
  while (true) {
    const auto widest = std::max_element(open.begin(), open.end(), [&](int a, int b) {
      const auto width = [&](int i) {
        const auto& node = tree.nodes[static_cast<std::size_t>(i)];
        return node.children == 0 ? -1.0 : node.radius;
      };
      return width(a) < width(b);
    });
    const auto& node = tree.nodes[static_cast<std::size_t>(*widest)];
    if (node.children == 0 || open.size() + static_cast<std::size_t>(node.children) - 1 > kBalls) break;
    const int first = node.first_child;
    const int count = node.children;
    open.erase(widest);
    for (int i = 0; i < count; ++i) open.push_back(first + i);
  }
  std::vector<Ball> balls;
  for (const int i : open) {
    const auto& node = tree.nodes[static_cast<std::size_t>(i)];
    balls.push_back({X_LG * node.center, node.radius});
  }
  return balls;
}

std::vector<Ball> balls_of(const robot::Geometry& geometry) {
  if (const auto* mesh = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&geometry.shape)) {
    if (const robot::MeshCover* cover = (*mesh)->cover.get()) return balls_of(cover->tree, geometry.X_BG);
  }
  return balls_of(robot::sphere_tree(geometry.shape, {12, 0.01}), geometry.X_BG);
}

bool moves(const robot::RobotModel& robot, int link) {
  for (int joint = robot.links()[static_cast<std::size_t>(link)].joint; joint >= 0;) {
    if (robot.drives()[static_cast<std::size_t>(joint)].index >= 0) return true;
    const int parent = robot.description().joints[static_cast<std::size_t>(joint)].parent;
    joint = robot.links()[static_cast<std::size_t>(parent)].joint;
  }
  return false;
}

struct Surroundings {
  std::vector<LinkBalls> links;
  std::vector<Obstacle> obstacles;
};

}  // namespace

Clearances scene_clearances(const robot::RobotModel& robot, const robot::Scene& scene, double reach) {
  require(std::isfinite(reach), "scene_clearances: reach must be finite (m)");
  auto around = std::make_shared<Surroundings>();
  for (std::size_t i = 0; i < robot.links().size(); ++i) {
    LinkBalls link{static_cast<int>(i), {}};
    for (const robot::Geometry& geometry : robot.links()[i].collision) {
      for (const Ball& ball : balls_of(geometry)) link.balls.push_back(ball);
    }
    if (!link.balls.empty() && moves(robot, link.link)) around->links.push_back(std::move(link));
  }
  const Eigen::Isometry3d X_RW = scene.X_WR.inverse();
  for (const robot::SceneBody& body : scene.bodies) {
    for (const robot::Geometry& geometry : body.geometry) {
      around->obstacles.emplace_back(geometry.shape, X_RW * body.X_WB * geometry.X_BG);
    }
  }
  return [&robot, around, reach](const Eigen::VectorXd& q, Eigen::MatrixXd* derivative) {
    const auto X_RL = robot.link_poses(q);
    const auto count = static_cast<Eigen::Index>(around->links.size());
    Eigen::VectorXd clearance = Eigen::VectorXd::Constant(count, reach);
    if (derivative != nullptr) *derivative = Eigen::MatrixXd::Zero(count, q.size());
    for (Eigen::Index i = 0; i < count; ++i) {
      const LinkBalls& link = around->links[static_cast<std::size_t>(i)];
      Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
      Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
      for (const Ball& ball : link.balls) {
        const Eigen::Vector3d p_R = X_RL[static_cast<std::size_t>(link.link)] * ball.center;
        for (const Obstacle& obstacle : around->obstacles) {
          if (obstacle.at_least(p_R) - ball.radius >= clearance[i]) continue;
          const Away away = obstacle.away(p_R);
          if (away.distance - ball.radius >= clearance[i]) continue;
          clearance[i] = away.distance - ball.radius;
          nearest = p_R;
          gradient = away.gradient;
        }
      }
      if (derivative == nullptr || clearance[i] >= reach) continue;
      derivative->row(i) = gradient.transpose() * robot.point_jacobian(X_RL, link.link, nearest);
    }
    return clearance;
  };
}

}  // namespace opponens::motion
