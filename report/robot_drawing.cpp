// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/robot_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Geometry>

#include "report/body_drawing.hpp"
#include "report/labels.hpp"
#include "report/picture.hpp"
#include "report/report.hpp"
#include "report/svg.hpp"
#include "report/text.hpp"
#include "robot/phalanges.hpp"

namespace opponens::report {
namespace {

using Eigen::Vector3d;

constexpr double kCellWidth = 600.0;   // px
constexpr double kCellHeight = 430.0;  // px, with the caption
constexpr double kViewCaption = 24.0;  // px under a view
constexpr double kMargin = 120.0;      // px left and right, for names
constexpr double kTriad = 52.0;        // px below the names, for the root's axes
constexpr int kTriangles = 12000;      // of all meshes together
constexpr double kArrow = 34.0;        // px, a joint's axis
constexpr const char* kJointColor = "#0050b0";
constexpr const char* kContactColor = "#c4007a";
constexpr const char* kTipColor = "#b35900";

struct NamedPoints {
  const std::vector<robot::SurfacePoint>& tips;
  const std::vector<robot::SurfacePoint>& contacts;
};

/// A window onto the robot.
struct Cell {
  std::string caption;
  Vector3d toward;  ///< the viewer, root frame
  Vector3d up;
  bool hand_only = false;
  std::set<std::string> joints{};  ///< drawn with their names
  bool points = false;
  bool names = false;  ///< of the points
};

/// The robot at rest.
struct Posed {
  const robot::RobotModel& robot;
  RobotFacets facets;
  Eigen::VectorXd q;
  std::vector<Eigen::Isometry3d> X_RL;
  std::vector<bool> in_hand;  ///< by link: below the palm, or it
};

Posed posed(const robot::RobotModel& robot) {
  Posed pose{robot, robot_facets(robot, kTriangles), rest_configuration(robot), {}, {}};
  pose.X_RL = robot.link_poses(pose.q);
  for (std::size_t i = 0; i < robot.links().size(); ++i) {
    const int joint = robot.links()[i].joint;
    const int parent = joint < 0 ? -1 : robot.description().joints[static_cast<std::size_t>(joint)].parent;
    pose.in_hand.push_back(static_cast<int>(i) == robot.palm() ||
                           (parent >= 0 && pose.in_hand[static_cast<std::size_t>(parent)]));
  }
  return pose;
}

std::vector<Facet> surface_of(const Posed& pose, bool hand_only) {
  std::vector<Facet> surface;
  for (std::size_t i = 0; i < pose.X_RL.size(); ++i) {
    if (!hand_only || pose.in_hand[i]) append(surface, pose.facets.links[i], pose.X_RL[i]);
  }
  return surface;
}

/// Where the view has to reach: corners of the surfaces, or the links' origins where nothing has a surface.
std::vector<Vector3d> reach_of(const Posed& pose, const std::vector<Facet>& surface, bool hand_only) {
  std::vector<Vector3d> reach = corners_of(surface);
  for (std::size_t i = 0; i < pose.X_RL.size() && surface.empty(); ++i) {
    if (!hand_only || pose.in_hand[i]) reach.push_back(pose.X_RL[i].translation());
  }
  return reach;
}

void arrow(Svg& svg, const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::string& color) {
  const std::string stroke = concat({"stroke=\"", color, "\" stroke-width=\"1.6\""});
  svg.line(from.x(), from.y(), to.x(), to.y(), "stroke=\"#fff\" stroke-width=\"3.4\" stroke-opacity=\".8\"");
  svg.line(from.x(), from.y(), to.x(), to.y(), stroke);
  const Eigen::Vector2d along = to - from;
  if (along.norm() < 5.0) return;  // it points at the viewer: the circle at its foot shows the place
  const Eigen::Vector2d back = -4.5 * along.normalized();
  const Eigen::Vector2d aside(0.5 * back.y(), -0.5 * back.x());
  svg.polygon({to, to + back + aside, to + back - aside}, concat({"fill=\"", color, "\""}));
}

void draw_joints(Svg& svg, const View& view, const Posed& pose, const Cell& cell, std::vector<Label>& labels) {
  for (const robot::Joint& joint : pose.robot.description().joints) {
    if (!cell.joints.contains(joint.name)) continue;
    const Eigen::Isometry3d& X = pose.X_RL[static_cast<std::size_t>(joint.child)];
    const Vector3d axis = X.linear() * joint.axis * (kArrow / view.scale);
    const Eigen::Vector2d foot = view.project(X.translation());
    arrow(svg, foot, view.project(X.translation() + axis), kJointColor);
    svg.circle(foot.x(), foot.y(), 2.4, concat({"fill=\"#fff\" stroke=\"", kJointColor, "\" stroke-width=\"1.3\""}));
    labels.push_back({foot, joint.name, kJointColor});
  }
}

void draw_point(Svg& svg, const View& view, const Posed& pose, const robot::SurfacePoint& point,
                const std::string& color) {
  const Eigen::Isometry3d& X = pose.X_RL[static_cast<std::size_t>(point.link)];
  const Eigen::Vector2d at = view.project(X * point.p_L);
  const Eigen::Vector2d end = view.project(X * point.p_L + X.linear() * point.n_L * (14.0 / view.scale));
  svg.line(at.x(), at.y(), end.x(), end.y(), concat({"stroke=\"", color, "\" stroke-width=\"1.4\""}));
  const bool faces = view.toward.dot(X.linear() * point.n_L) > 0.0;
  svg.circle(
      at.x(), at.y(), 3.2,
      concat({"fill=\"", faces ? color : "#fff", "\" stroke=\"", faces ? "#fff" : color, "\" stroke-width=\"1.1\""}));
}

void draw_points(Svg& svg, const View& view, const Posed& pose, const NamedPoints& points, bool names,
                 std::vector<Label>& labels) {
  const auto place = [&](const robot::SurfacePoint& point) {
    return view.project(pose.X_RL[static_cast<std::size_t>(point.link)] * point.p_L);
  };
  for (const auto& point : points.contacts) {
    draw_point(svg, view, pose, point, kContactColor);
    if (names) labels.push_back({place(point), point.name, kContactColor});
  }
  for (const auto& tip : points.tips) {
    draw_point(svg, view, pose, tip, kTipColor);
    const auto same = [&](const robot::SurfacePoint& point) {
      return point.link == tip.link && (point.p_L - tip.p_L).norm() < 0.002;
    };
    const bool shown = std::any_of(points.contacts.begin(), points.contacts.end(), same);
    if (names && !shown) labels.push_back({place(tip), "tip " + tip.name, kTipColor});
  }
}

/// Root axes in the lower left corner.
void draw_triad(Svg& svg, const View& view) {
  const Eigen::Vector2d foot(26.0, view.height - 22.0);
  const char* const colors[3] = {"#c0392b", "#27803b", "#2c5fb3"};
  const char* const names[3] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector2d along(view.right[axis], -view.up[axis]);
    const Eigen::Vector2d end = foot + 17.0 * along;
    svg.line(foot.x(), foot.y(), end.x(), end.y(), concat({"stroke=\"", colors[axis], "\" stroke-width=\"1.6\""}));
    if (along.norm() < 0.25) continue;  // its letter would hide the others
    const Eigen::Vector2d text = foot + 23.0 * along;
    svg.text(text.x(), text.y() + 3.0, names[axis], "font-size=\"9.5\" text-anchor=\"middle\"");
  }
}

void draw_cell(Svg& svg, const Posed& pose, const NamedPoints& points, const Cell& cell, double x, double y) {
  const double height = kCellHeight - kViewCaption;
  std::vector<Facet> surface = surface_of(pose, cell.hand_only);
  View view =
      fit_view(cell.toward, cell.up, reach_of(pose, surface, cell.hand_only), kCellWidth - 2.0 * kMargin, height, 26.0);
  view.width = kCellWidth;  // the margins hold the names
  svg.open_clip(x, y, kCellWidth, kCellHeight);
  svg.rect(0.0, 0.0, kCellWidth - 6.0, height, "class=\"sky\"");
  draw_facets(svg, view, std::move(surface), body_paints());
  std::vector<Label> labels;
  draw_joints(svg, view, pose, cell, labels);
  if (cell.points) draw_points(svg, view, pose, points, cell.names, labels);
  draw_labels(svg, std::move(labels), kCellWidth - 6.0, height - kTriad);
  draw_triad(svg, view);
  svg.text(0.5 * kCellWidth, height + 15.0, cell.caption, "class=\"axis\" text-anchor=\"middle\"");
  svg.close_clip();
}

/// The hand's directions in the root frame; where the fingers do not tell them, the palm frame's x and z.
robot::PalmDirections directions_of(const Posed& pose) {
  robot::PalmDirections palm = robot::palm_directions(robot::finger_bones(pose.robot, robot::rest_in_palm(pose.robot)));
  if (palm.side.norm() == 0.0) palm.side = Vector3d::UnitX();
  palm.ahead -= palm.side * palm.side.dot(palm.ahead);
  palm.ahead = palm.ahead.norm() > 0.1 ? palm.ahead.normalized().eval() : palm.side.unitOrthogonal();
  const Eigen::Matrix3d R = pose.X_RL[static_cast<std::size_t>(pose.robot.palm())].linear();
  return {R * palm.side, R * palm.ahead};
}

std::vector<Cell> cells_of(const Posed& pose) {
  const auto& description = pose.robot.description();
  std::vector<Cell> cells;
  if (!description.arm_joints.empty()) {
    const std::set<std::string> joints(description.arm_joints.begin(), description.arm_joints.end());
    cells.push_back({"The arm's joints and their axes", {0.5, -0.75, 0.4}, Vector3d::UnitZ(), false, joints});
    cells.push_back({"From the other side", {-0.8, 0.45, 0.35}, Vector3d::UnitZ(), false});
  }
  if (description.hand_joints.empty()) return cells;
  const robot::PalmDirections palm = directions_of(pose);
  const Vector3d aside = palm.ahead.cross(palm.side);
  std::set<std::string> joints;
  for (const robot::Joint& joint : description.joints) {
    if (joint.type != robot::JointType::fixed && pose.in_hand[static_cast<std::size_t>(joint.parent)]) {
      joints.insert(joint.name);
    }
  }
  cells.push_back({"Palm side: contact points (pink) and tips (orange)",
                   palm.side + 0.25 * aside,
                   palm.ahead,
                   true,
                   {},
                   true,
                   true});
  cells.push_back({"Back: joints and their axes", -palm.side + 0.3 * aside, palm.ahead, true, joints});
  cells.push_back({"From one side; rings face away", aside + 0.25 * palm.side, palm.ahead, true, {}, true});
  cells.push_back({"From the other side", -aside + 0.25 * palm.side, palm.ahead, true, {}, true});
  return cells;
}

}  // namespace

std::string draw_robot(const robot::RobotModel& robot, const std::vector<robot::SurfacePoint>& tips,
                       const std::vector<robot::SurfacePoint>& contact_points) {
  const Posed pose = posed(robot);
  const std::vector<Cell> cells = cells_of(pose);
  constexpr double kTitle = 34.0;  // px
  const double rows = std::ceil(0.5 * static_cast<double>(cells.size()));
  const std::string& name = robot.description().name;
  Svg svg(2.0 * kCellWidth, kTitle + rows * kCellHeight, name);
  svg.text(8.0, 22.0, name, "font-size=\"17\"");
  for (std::size_t i = 0; i < cells.size(); ++i) {
    draw_cell(svg, pose, {tips, contact_points}, cells[i], kCellWidth * static_cast<double>(i % 2),
              kTitle + kCellHeight * static_cast<double>(i / 2));
  }
  return svg_files(svg.str()).front().content;
}

}  // namespace opponens::report
