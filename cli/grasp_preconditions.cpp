// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/grasp_preconditions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <variant>
#include <vector>

#include "core/require.hpp"
#include "grasp/body_distance.hpp"
#include "robot/mesh.hpp"
#include "robot/mesh_check.hpp"

namespace opponens::cli {
namespace {

constexpr double kMaxSunk = 0.004;      // m, that an object may stand in another body
constexpr int kSamplesAcross = 30;      // surface points of the object along its longest edge
constexpr double kLeastSpacing = 2e-3;  // m

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char text[320];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// What the scene has to say for the object to have a usual size.
const char* unit_advice(double scale) {
  if (scale == 0.001) return "in millimetres (unit: mm)";
  if (scale == 0.01) return "in centimetres (unit: cm)";
  if (scale == 0.0254) return "in inches (unit: in)";
  if (scale == 1000.0) return "in metres, not millimetres (unit: m),";
  if (scale == 100.0) return "in metres, not centimetres (unit: m),";
  return "in metres, not inches (unit: m),";
}

void require_usual_size(const std::string& name, const robot::MeshReport& report) {
  if (report.likely_scales.empty()) return;
  const Eigen::Vector3d& size = report.extent;
  std::string sentence = formatted("object %s measures %.3g x %.3g x %.3g m, which no hand holds: a wrong unit?",
                                   name.c_str(), size.x(), size.y(), size.z());
  for (const double scale : report.likely_scales) {
    sentence += formatted(" %s it would be %.3g m long;", unit_advice(scale), scale * size.maxCoeff());
  }
  sentence.back() = '.';
  throw InputError(sentence);
}

void require_closed(const std::string& name, const std::vector<robot::Geometry>& geometry) {
  for (const robot::Geometry& one : geometry) {
    const auto* mesh = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&one.shape);
    if (mesh == nullptr || robot::is_closed(**mesh)) continue;
    const robot::MeshReport report = robot::check_mesh(**mesh);
    throw InputError("object " + name + ": its mesh " + (*mesh)->source + " is open (" +
                     std::to_string(report.holes.size()) + " holes, " + std::to_string(report.open_components) +
                     " open parts), so nothing tells its inside from its outside; repair it with: opponens mesh FILE "
                     "--repair CLOSED.stl");
  }
}

/// Shapes with an inside.
std::vector<robot::Geometry> solids(const std::vector<robot::Geometry>& geometry) {
  std::vector<robot::Geometry> result;
  for (const robot::Geometry& one : geometry) {
    const auto* mesh = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&one.shape);
    if (mesh == nullptr || robot::is_closed(**mesh)) result.push_back(one);
  }
  return result;
}

void require_apart(const robot::Scene& scene, const robot::SceneBody& object, double spacing) {
  std::vector<Eigen::Vector3d> points;
  for (const robot::Geometry& one : object.geometry) {
    for (const Eigen::Vector3d& p : robot::surface_samples(one, spacing)) points.push_back(p);
  }
  for (const robot::SceneBody& other : scene.bodies) {
    if (other.name == object.name) continue;
    const grasp::BodyDistance distance(solids(other.geometry));
    if (distance.empty()) continue;
    const Eigen::Isometry3d X_BO = other.X_WB.inverse() * object.X_WB;
    double deepest = 0.0;
    for (const Eigen::Vector3d& p_O : points) deepest = std::min(deepest, distance.query(X_BO * p_O, 0.0).value);
    if (deepest > -kMaxSunk) continue;
    throw InputError(formatted("object %s stands %.0f mm deep in %s: no hand gets around it; move one of the two",
                               object.name.c_str(), -1000.0 * deepest, other.name.c_str()));
  }
}

/// The farthest that a link's frame can be from the frame of an ancestor, whatever the joints: the sum of all offsets.
double longest_chain(const robot::RobotModel& robot, int link, int ancestor) {
  const robot::RobotDescription& d = robot.description();
  double length = 0.0;
  while (link != ancestor && d.links[static_cast<std::size_t>(link)].joint >= 0) {
    const robot::Joint& joint = d.joints[static_cast<std::size_t>(d.links[static_cast<std::size_t>(link)].joint)];
    length += joint.X_PJ.translation().norm();
    if (joint.type == robot::JointType::prismatic) length += std::max(std::abs(joint.lower), std::abs(joint.upper));
    link = joint.parent;
  }
  return length;
}

/// The farthest that a point of the hand can be from the palm's frame.
double hand_length(const robot::RobotModel& hand) {
  double length = 0.0;
  for (std::size_t link = 0; link < hand.links().size(); ++link) {
    double radius = 0.0;
    for (const robot::Geometry& one : hand.links()[link].collision) {
      const robot::TriangleMesh mesh = robot::merge({one});
      radius = std::max(radius, mesh.vertices.colwise().norm().maxCoeff());
    }
    length = std::max(length, longest_chain(hand, static_cast<int>(link), hand.palm()) + radius);
  }
  return length;
}

/// The link that the arm's first moving joint turns: its frame's origin stands still in the root's frame.
std::optional<int> first_moved_link(const robot::RobotModel& robot) {
  const robot::RobotDescription& d = robot.description();
  std::optional<int> first;
  for (int link = robot.palm(); d.links[static_cast<std::size_t>(link)].joint >= 0;) {
    const robot::Joint& joint = d.joints[static_cast<std::size_t>(d.links[static_cast<std::size_t>(link)].joint)];
    if (joint.type != robot::JointType::fixed) first = link;
    link = joint.parent;
  }
  return first;
}

}  // namespace

void require_graspable(const NamedWorld& world) {
  if (world.hand().description().contact_points.empty()) {
    throw InputError("the hand of " + world.parameters.at("robot").get<std::string>() +
                     " has no contact_points, so nothing says where it should touch; opponens robot FILE "
                     "--propose-contacts finds some");
  }
  const robot::SceneBody& object = world.scene.body(world.object());
  if (object.geometry.empty()) throw InputError("object " + world.object() + " has no geometry in the scene");
  const robot::MeshReport report = robot::check_mesh(robot::merge(object.geometry));
  require_usual_size(world.object(), report);
  require_closed(world.object(), object.geometry);
  require_apart(world.scene, object, std::max(kLeastSpacing, report.extent.maxCoeff() / kSamplesAcross));
}

std::optional<std::string> out_of_reach(const NamedWorld& world) {
  const std::optional<int> first = first_moved_link(world.robot);
  if (!first) return std::nullopt;
  const robot::RobotDescription& d = world.robot.description();
  const robot::Joint& joint = d.joints[static_cast<std::size_t>(d.links[static_cast<std::size_t>(*first)].joint)];
  if (joint.type == robot::JointType::prismatic) return std::nullopt;  // a gantry: its first frame moves itself
  const Eigen::Vector3d p_RF =
      world.robot.link_poses(Eigen::VectorXd::Zero(world.robot.dof()))[static_cast<std::size_t>(*first)].translation();
  const Eigen::Isometry3d X_RO = world.X_RO();
  const robot::TriangleMesh mesh = robot::merge(world.scene.body(world.object()).geometry);
  const Eigen::Matrix3Xd vertices = (X_RO.linear() * mesh.vertices).colwise() + X_RO.translation();
  const Eigen::AlignedBox3d box(vertices.rowwise().minCoeff(), vertices.rowwise().maxCoeff());
  const double apart = box.exteriorDistance(p_RF);
  const double length = longest_chain(world.robot, world.robot.palm(), *first) + hand_length(world.hand());
  if (apart <= length) return std::nullopt;
  return formatted(
      "object %s is out of reach: %.2f m from the arm's first joint, and arm and hand are at most %.2f m long",
      world.object().c_str(), apart, length);
}

}  // namespace opponens::cli
