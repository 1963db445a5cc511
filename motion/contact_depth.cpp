// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/contact_depth.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "core/require.hpp"
#include "robot/mesh.hpp"

namespace opponens::motion {
namespace {

constexpr std::size_t kLeafPoints = 8;
constexpr double kDistanceRounding = 1e-9;  ///< m, far above that of a distance

}  // namespace

ContactDepth::ContactDepth(const robot::RobotModel& robot, const robot::Scene& scene, const std::string& object,
                           const std::vector<std::string>& links, double spacing)
    : ContactDepth(robot, scene, {{object, links}}, spacing) {}

ContactDepth::ContactDepth(const robot::RobotModel& robot, const robot::Scene& scene,
                           const std::vector<TouchingLinks>& hands, double spacing)
    : robot_(&robot), bound_(robot) {
  require(spacing > 0.0, "ContactDepth: spacing must be positive");
  for (const TouchingLinks& hand : hands) {
    const std::size_t first_solid = solids_.size();
    add_object(scene, hand.object);
    for (const std::string& link : hand.links) add_link(link, spacing, first_solid);
  }
}

void ContactDepth::add_object(const robot::Scene& scene, const std::string& object) {
  const robot::SceneBody& body = scene.body(object);
  for (const robot::Geometry& geometry : body.geometry) {
    const auto* shared = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&geometry.shape);
    auto mesh = shared ? *shared : std::make_shared<const robot::TriangleMesh>(robot::triangulate(geometry.shape, 64));
    const Eigen::Isometry3d X_GR = (body.X_WB * geometry.X_BG).inverse() * scene.X_WR;
    const Eigen::AlignedBox3d box(mesh->vertices.rowwise().minCoeff(), mesh->vertices.rowwise().maxCoeff());
    solids_.push_back({robot::MeshDistance(std::move(mesh)), X_GR, box});
  }
}

void ContactDepth::add_link(const std::string& name, double spacing, std::size_t first_solid) {
  const int link = robot_->link_index(name);
  std::vector<Eigen::Vector3d> points;
  for (const robot::Geometry& geometry : robot_->links()[static_cast<std::size_t>(link)].collision) {
    // Points of a link's geometry come in the body frame.
    const auto samples = robot::surface_samples(geometry, spacing);
    points.insert(points.end(), samples.begin(), samples.end());
  }
  if (points.empty()) return;
  links_.push_back({link, std::move(points), {}, first_solid, solids_.size()});
  links_.back().enclose(0, links_.back().points.size());
}

void ContactDepth::LinkSurface::enclose(std::size_t begin, std::size_t end) {
  const auto first = points.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = points.begin() + static_cast<std::ptrdiff_t>(end);
  Eigen::AlignedBox3d box;
  std::for_each(first, last, [&](const Eigen::Vector3d& p) { box.extend(p); });
  Ball ball{box.center(), 0.0, begin, end, 0, end - begin <= kLeafPoints};
  std::for_each(first, last,
                [&](const Eigen::Vector3d& p) { ball.radius = std::max(ball.radius, (p - ball.center).norm()); });
  const std::size_t index = balls.size();
  balls.push_back(ball);
  if (!ball.leaf) {
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(first, points.begin() + static_cast<std::ptrdiff_t>(middle), last,
                     [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
    enclose(begin, middle);
    enclose(middle, end);
  }
  balls[index].next = balls.size();
}

double ContactDepth::deepest(const LinkSurface& link, const Solid& solid, const Eigen::Isometry3d& X_GL, double depth,
                             double enough) {
  // The surface is no further from a point than from the one asked before and the way between them: known before it is
  // looked for, which is most of the search.
  Eigen::Vector3d last_p = Eigen::Vector3d::Zero();
  double last_distance = std::numeric_limits<double>::infinity();
  const auto signed_distance = [&](const Eigen::Vector3d& p) {
    const double within = last_distance + (p - last_p).norm() + kDistanceRounding;
    const double distance = solid.distance.query(p, within).distance;
    last_p = p;
    last_distance = std::abs(distance);
    return distance;
  };
  for (std::size_t i = 0; i < link.balls.size() && depth <= enough;) {
    const Ball& ball = link.balls[i];
    // A signed distance changes by no more than the way: no point of a ball this far out is deeper.
    const Eigen::Vector3d p_G = X_GL * ball.center;
    const double reach = ball.radius - depth;
    const double outside = solid.box.exteriorDistance(p_G);
    const bool far = outside > 0.0 && outside >= reach;
    const bool may_be_deeper = !far && signed_distance(p_G) < reach;
    if (may_be_deeper && ball.leaf) {
      for (std::size_t p = ball.begin; p < ball.end; ++p) {
        depth = std::max(depth, -signed_distance(X_GL * link.points[p]));
      }
    }
    i = may_be_deeper && !ball.leaf ? i + 1 : ball.next;
  }
  return depth;
}

double ContactDepth::operator()(const Eigen::VectorXd& q) const {
  const std::vector<Eigen::Isometry3d> X_RL = robot_->link_poses(q);
  double depth = 0.0;
  for (const LinkSurface& link : links_) {
    for (std::size_t i = link.first_solid; i < link.last_solid; ++i) {
      const Solid& solid = solids_[i];
      depth = deepest(link, solid, solid.X_GR * X_RL[static_cast<std::size_t>(link.link)], depth,
                      std::numeric_limits<double>::infinity());
    }
  }
  return depth;
}

bool ContactDepth::keeps(const std::vector<Eigen::Isometry3d>& X_RL, const robot::LinkTravel& travel, double share,
                         double max_depth) const {
  return std::all_of(links_.begin(), links_.end(), [&](const LinkSurface& link) {
    const double allowed = max_depth - share * bound_.of_link(travel, link.link);
    for (std::size_t i = link.first_solid; i < link.last_solid; ++i) {
      const Eigen::Isometry3d X_GL = solids_[i].X_GR * X_RL[static_cast<std::size_t>(link.link)];
      if (deepest(link, solids_[i], X_GL, allowed, allowed) > allowed) return false;
    }
    return true;
  });
}

std::optional<double> ContactDepth::first_deeper(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                                 double max_depth, double shortest, std::int64_t& checks) const {
  require(shortest > 0.0, "first_deeper: the shortest part must be positive");
  ++checks;
  if ((*this)(q_to) > max_depth) return 1.0;
  const Eigen::VectorXd joint_step = robot_->joint_positions(q_to) - robot_->joint_positions(q_from);
  std::vector<std::pair<double, double>> parts{{0.0, 1.0}};
  while (!parts.empty()) {
    const auto [begin, end] = parts.back();
    parts.pop_back();
    const double middle = 0.5 * (begin + end);
    const std::vector<Eigen::Isometry3d> X_RL = robot_->link_poses(q_from + middle * (q_to - q_from));
    ++checks;
    const robot::LinkTravel travel = bound_.travel(X_RL, (end - begin) * joint_step);
    if (keeps(X_RL, travel, 0.5, max_depth)) continue;
    if (end - begin > shortest) {
      parts.emplace_back(middle, end);
      parts.emplace_back(begin, middle);
    } else if (!keeps(X_RL, travel, 0.0, max_depth)) {
      return middle;
    }
  }
  return std::nullopt;
}

}  // namespace opponens::motion
