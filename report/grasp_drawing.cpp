// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/grasp_drawing.hpp"

#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "core/require.hpp"
#include "report/contact_marks.hpp"
#include "report/svg.hpp"
#include "report/text.hpp"

namespace opponens::report {
namespace {

constexpr int kHandTriangles = 2400;
constexpr int kObjectTriangles = 1200;
constexpr double kNear = 0.3;     // m from the palm: what a picture is zoomed to
constexpr double kMargin = 22.0;  // px: room for cones and numbers at the rim

int link_of(const robot::RobotModel& hand, const std::string& name) {
  for (std::size_t i = 0; i < hand.links().size(); ++i) {
    if (hand.links()[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

/// The bodies' paints, fingers tinted like their contacts and the object pale, so that marks on it are read.
std::vector<Paint> gallery_paints() {
  constexpr double kTint = 0.3;
  constexpr int kGrey = 208;
  auto paints = body_paints();
  for (int finger = 0; finger < 5; ++finger) {
    const Paint color = contact_paint(finger);
    const auto mixed = [](int channel) {
      return static_cast<int>(std::lround(kTint * channel + (1.0 - kTint) * kGrey));
    };
    paints[static_cast<std::size_t>(paint_finger + finger)] = {mixed(color.red), mixed(color.green), mixed(color.blue),
                                                               true};
  }
  paints[paint_palm] = {150, 156, 166, true};
  paints[paint_object] = {240, 222, 190, false};
  return paints;
}

}  // namespace

GraspStage grasp_stage(const robot::RobotModel& hand, const robot::SceneBody& object) {
  require(!object.geometry.empty(), "the object of a grasp has no geometry to draw");
  GraspStage stage{hand, robot_facets(hand, kHandTriangles), {}, finger_of_links(hand), {}};
  for (const auto& geometry : object.geometry) {
    append(stage.object, facets(geometry, paint_object, {28, kObjectTriangles}), Eigen::Isometry3d::Identity());
  }
  stage.up = object.X_WB.linear().transpose() * Eigen::Vector3d::UnitZ();
  return stage;
}

GraspBodies grasp_bodies(const GraspStage& stage, const Grasp& grasp) {
  require(grasp.q_grasp.size() == stage.hand.dof(), "q_grasp has another number of joints than the hand");
  const auto X_RL = stage.hand.link_poses(grasp.q_grasp);
  const Eigen::Isometry3d X_OR = grasp.X_OH * X_RL[static_cast<std::size_t>(stage.hand.palm())].inverse();
  GraspBodies bodies;
  for (std::size_t i = 0; i < X_RL.size(); ++i) {
    append(bodies.links.emplace_back(), stage.facets.links[i], X_OR * X_RL[i]);
  }
  bodies.object = stage.object;
  for (const auto& contact : grasp.contacts) bodies.contact_links.push_back(link_of(stage.hand, contact.link));
  const HandAxes axes = hand_axes(stage.hand);
  bodies.hand = {X_OR.linear() * axes.fingers, X_OR.linear() * axes.palm, X_OR.linear() * axes.thumb};
  bodies.up = stage.up;
  return bodies;
}

std::vector<int> contact_fingers(const GraspStage& stage, const Grasp& grasp) {
  std::vector<int> fingers;
  for (const auto& contact : grasp.contacts) {
    const int link = link_of(stage.hand, contact.link);
    fingers.push_back(link < 0 ? -1 : stage.fingers[static_cast<std::size_t>(link)]);
  }
  return fingers;
}

std::string draw_grasp(const GraspStage& stage, const GraspBodies& bodies, const Grasp& grasp, const GraspView& view,
                       const std::string& title, double width, double height) {
  require(view.sights.size() == grasp.contacts.size(), "a view's sights belong to another grasp");
  std::vector<Facet> all = bodies.object;
  for (const auto& link : bodies.links) all.insert(all.end(), link.begin(), link.end());
  // Hand and the part of the object near it: a grasp of a long object would else be a small spot.
  std::vector<Eigen::Vector3d> shown;
  for (const auto& p : corners_of(all)) {
    if ((p - grasp.X_OH.translation()).norm() < kNear) shown.push_back(p);
  }
  for (const auto& contact : grasp.contacts) shown.push_back(contact.p_OC);
  if (shown.empty()) shown.push_back(grasp.X_OH.translation());
  const View window = fit_view(view.toward, bodies.up, shown, width, height, kMargin);
  Svg svg(width, height, title);
  svg.rect(0.0, 0.0, width, height, "class=\"sky\"");
  draw_facets(svg, window, std::move(all), gallery_paints());
  const std::vector<int> fingers = contact_fingers(stage, grasp);
  std::vector<ContactMark> marks;
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    marks.push_back({grasp.contacts[i], fingers[i], view.sights[i] == Sight::behind_others});
  }
  draw_contacts(svg, window, marks, grasp.quality.convention.model != ContactModel::frictionless);
  return svg.str();
}

}  // namespace opponens::report
