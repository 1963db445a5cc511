// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/body_drawing.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <variant>

#include "core/require.hpp"

namespace opponens::report {
namespace {

using Mesh = std::shared_ptr<const robot::TriangleMesh>;

/// Parent link of each link, -1 for the root.
int parent_of(const robot::RobotModel& model, int link) {
  const int joint = model.links()[static_cast<std::size_t>(link)].joint;
  return joint < 0 ? -1 : model.description().joints[static_cast<std::size_t>(joint)].parent;
}

int paint_of(const robot::RobotModel& model, int link, int finger) {
  bool hand = false;
  for (int at = link; at >= 0; at = parent_of(model, at)) hand = hand || at == model.palm();
  if (!hand) return paint_arm;
  return finger < 0 ? paint_palm : paint_finger + finger % 5;
}

std::string finger_name(const robot::SurfacePoint& tip) { return tip.finger.empty() ? tip.name : tip.finger; }

}  // namespace

std::vector<int> finger_of_links(const robot::RobotModel& model) {
  constexpr int kNone = -1;
  constexpr int kSeveral = -2;
  std::vector<int> finger(model.links().size(), kNone);
  const std::vector<std::string> names = finger_names(model);
  for (const auto& tip : model.description().tips) {
    const auto found = std::find(names.begin(), names.end(), finger_name(tip));
    const int number = static_cast<int>(found - names.begin());
    for (int link = tip.link; link >= 0; link = parent_of(model, link)) {
      int& mine = finger[static_cast<std::size_t>(link)];
      mine = mine == kNone || mine == number ? number : kSeveral;
    }
  }
  for (std::size_t i = 0; i < finger.size(); ++i) {  // a link beyond the tip's belongs to the same finger
    const int parent = parent_of(model, static_cast<int>(i));
    if (finger[i] == kNone && parent >= 0) finger[i] = finger[static_cast<std::size_t>(parent)];
  }
  for (int& number : finger) number = std::max(number, kNone);
  return finger;
}

std::vector<std::string> finger_names(const robot::RobotModel& model) {
  std::vector<std::string> names;
  for (const auto& tip : model.description().tips) {
    const std::string name = finger_name(tip);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<Paint> body_paints() {
  return {{176, 182, 190, true},                                                 // arm
          {92, 98, 110, true},                                                   // palm
          {104, 126, 160, true},  {120, 150, 140, true}, {150, 128, 160, true},  // fingers
          {150, 122, 108, true},  {122, 122, 122, true}, {238, 142, 38, true},   // object
          {226, 229, 224, false},                                                // obstacle
          {214, 206, 192, false}};                                               // support
}

RobotFacets robot_facets(const robot::RobotModel& model, int max_triangles) {
  int meshes = 0;
  for (const auto& link : model.links()) {
    meshes += static_cast<int>(std::count_if(link.collision.begin(), link.collision.end(), [](const auto& geometry) {
      return std::holds_alternative<Mesh>(geometry.shape);
    }));
  }
  const FacetDetail detail{16, std::max(24, max_triangles / std::max(1, meshes))};
  const std::vector<int> fingers = finger_of_links(model);
  RobotFacets result;
  for (std::size_t i = 0; i < model.links().size(); ++i) {
    const int paint = paint_of(model, static_cast<int>(i), fingers[i]);
    std::vector<Facet> link;
    for (const auto& geometry : model.links()[i].collision) {
      const auto part = facets(geometry, paint, detail);
      link.insert(link.end(), part.begin(), part.end());
    }
    result.links.push_back(std::move(link));
  }
  return result;
}

void append_robot(std::vector<Facet>& out, const robot::RobotModel& model, const RobotFacets& facets,
                  const Eigen::Isometry3d& X_WR, const Eigen::VectorXd& q) {
  require(facets.links.size() == model.links().size(), "robot facets belong to another robot");
  const auto X_RL = model.link_poses(q);
  for (std::size_t i = 0; i < X_RL.size(); ++i) append(out, facets.links[i], X_WR * X_RL[i]);
}

std::vector<Eigen::Vector3d> corners_of(const std::vector<Facet>& facets) {
  std::vector<Eigen::Vector3d> corners;
  for (const auto& facet : facets) corners.insert(corners.end(), facet.corners.begin(), facet.corners.end());
  return corners;
}

Eigen::VectorXd by_name(const robot::RobotModel& model, const std::vector<std::string>& names,
                        const Eigen::VectorXd& values, const Eigen::VectorXd& base) {
  require(static_cast<Eigen::Index>(names.size()) == values.size(), "joint names and values differ in number");
  require(base.size() == model.dof(), "base configuration has another number of joints than the robot");
  Eigen::VectorXd q = base;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = std::find(model.joint_names().begin(), model.joint_names().end(), names[i]);
    require(found != model.joint_names().end(), [&] { return "the robot has no joint '" + names[i] + "'"; });
    q[found - model.joint_names().begin()] = values[static_cast<Eigen::Index>(i)];
  }
  return q;
}

Eigen::VectorXd rest_configuration(const robot::RobotModel& model) {
  return model.clip(Eigen::VectorXd::Zero(model.dof()));
}

}  // namespace opponens::report
