// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/scene_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "report/svg.hpp"

namespace opponens::report {
namespace {

constexpr double kLargestShown = 0.5;  // m, extent of a body that a picture zooms out for

struct Bounds {
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d high = -low;
};

Bounds bounds_of(const std::vector<Eigen::Vector3d>& points) {
  Bounds bounds;
  for (const auto& p : points) {
    bounds.low = bounds.low.min(p.array());
    bounds.high = bounds.high.max(p.array());
  }
  return bounds;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

int paint_of(const robot::Scene& scene, const robot::SceneBody& body, const std::vector<std::string>& objects) {
  if (contains(objects, body.name)) return paint_object;
  return body.name == scene.support ? paint_support : paint_obstacle;
}

/// Horizontal unit direction from the robot's root to the middle of the objects, or to the middle of all bodies.
Eigen::Vector3d heading(const robot::Scene& scene, const std::vector<std::string>& objects) {
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const auto& body : scene.bodies) {
    if (!objects.empty() && !contains(objects, body.name)) continue;
    target += body.X_WB.translation();
    count += 1.0;
  }
  Eigen::Vector3d ahead = count > 0.0 ? Eigen::Vector3d(target / count - scene.X_WR.translation())
                                      : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  ahead.z() = 0.0;
  return ahead.norm() > 1e-6 ? Eigen::Vector3d(ahead.normalized()) : Eigen::Vector3d(Eigen::Vector3d::UnitX());
}

void draw_trail(Svg& svg, const View& view, const Trail& trail) {
  std::vector<Eigen::Vector2d> line;
  line.reserve(trail.size());
  for (const auto& p : trail) line.push_back(view.project(p));
  if (line.size() < 2) return;
  svg.polyline(line, "class=\"trail-halo\"");
  svg.polyline(line, "class=\"trail\"");
  svg.circle(line.front().x(), line.front().y(), 3.0, "class=\"trail-start\"");
  svg.circle(line.back().x(), line.back().y(), 3.0, "class=\"trail-end\"");
}

}  // namespace

DrawnScene drawn_scene(const robot::RobotModel& robot, const robot::Scene& scene,
                       const std::vector<std::string>& objects, int max_triangles) {
  DrawnScene drawn;
  drawn.robot = robot_facets(robot, max_triangles);
  for (const auto& body : scene.bodies) {
    std::vector<Facet> surface;
    const FacetDetail detail{16, contains(objects, body.name) ? 1000 : 500};
    for (const auto& geometry : body.geometry) {
      append(surface, facets(geometry, paint_of(scene, body, objects), detail), body.X_WB);
    }
    const auto corners = corners_of(surface);
    const Bounds bounds = bounds_of(corners);
    if (!corners.empty() && (bounds.high - bounds.low).maxCoeff() < kLargestShown) {
      drawn.surroundings.insert(drawn.surroundings.end(), corners.begin(), corners.end());
    }
    drawn.bodies.insert(drawn.bodies.end(), surface.begin(), surface.end());
  }
  return drawn;
}

View scene_view(const robot::RobotModel& robot, const robot::Scene& scene, const std::vector<std::string>& objects,
                const DrawnScene& drawn, const Camera& camera, const std::vector<Eigen::VectorXd>& configurations,
                double width, double height) {
  const Eigen::Vector3d ahead = heading(scene, objects);
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(ahead);
  const Eigen::Vector3d level = std::sin(camera.azimuth) * left - std::cos(camera.azimuth) * ahead;
  const Eigen::Vector3d toward =
      std::cos(camera.elevation) * level + std::sin(camera.elevation) * Eigen::Vector3d::UnitZ();
  auto shown = drawn.surroundings;
  for (const auto& q : configurations) {
    std::vector<Facet> body;
    append_robot(body, robot, drawn.robot, scene.X_WR, q);
    const auto corners = corners_of(body);
    shown.insert(shown.end(), corners.begin(), corners.end());
  }
  if (shown.empty()) shown.push_back(scene.X_WR.translation());
  return fit_view(toward, Eigen::Vector3d::UnitZ(), shown, width, height, 10.0);
}

std::string draw_scene(const robot::RobotModel& robot, const robot::Scene& scene, const DrawnScene& drawn,
                       const View& view, const Eigen::VectorXd& q, const std::vector<Trail>& trails,
                       const std::string& title) {
  std::vector<Facet> all = drawn.bodies;
  append_robot(all, robot, drawn.robot, scene.X_WR, q);
  Svg svg(view.width, view.height, title);
  svg.rect(0.0, 0.0, view.width, view.height, "class=\"sky\"");
  draw_facets(svg, view, std::move(all), body_paints());
  for (const Trail& trail : trails) draw_trail(svg, view, trail);
  return svg.str();
}

}  // namespace opponens::report
