// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/hand_drawing.hpp"

#include <cstddef>

#include <Eigen/Geometry>

#include "core/require.hpp"
#include "report/svg.hpp"
#include "report/text.hpp"

namespace opponens::report {
namespace {

/// Directions of a hand in its root frame.
struct HandAxes {
  Eigen::Vector3d fingers;  ///< from the palm to the fingertips, at rest
  Eigen::Vector3d palm;     ///< out of the palm
  Eigen::Vector3d thumb;    ///< sideways, to the thumb
};

Eigen::Vector3d unit_or(const Eigen::Vector3d& v, const Eigen::Vector3d& fallback) {
  return v.norm() > 1e-9 ? Eigen::Vector3d(v.normalized()) : fallback;
}

HandAxes hand_axes(const robot::RobotModel& hand) {
  const auto X_RL = hand.link_poses(rest_configuration(hand));
  const Eigen::Isometry3d& X_RH = X_RL[static_cast<std::size_t>(hand.palm())];
  Eigen::Vector3d fingers = Eigen::Vector3d::Zero();
  Eigen::Vector3d thumb = Eigen::Vector3d::Zero();
  for (const auto& tip : hand.description().tips) {
    const Eigen::Vector3d p = X_RL[static_cast<std::size_t>(tip.link)] * tip.p_L - X_RH.translation();
    const bool is_thumb = tip.finger == "thumb" || tip.name.find("thumb") != std::string::npos;
    (is_thumb ? thumb : fingers) += p;
  }
  Eigen::Vector3d palm = Eigen::Vector3d::Zero();
  for (const auto& point : hand.description().contact_points) {
    if (point.link == hand.palm()) palm += X_RH.linear() * point.n_L;
  }
  HandAxes axes;
  axes.fingers = unit_or(fingers, X_RH.linear().col(2));
  palm -= axes.fingers * axes.fingers.dot(palm);
  axes.palm = unit_or(palm, axes.fingers.unitOrthogonal());
  axes.thumb = axes.fingers.cross(axes.palm);
  if (axes.thumb.dot(thumb) < 0.0) axes.thumb = -axes.thumb;
  return axes;
}

constexpr double kCaption = 18.0;  // px under a posture

void draw_contact(Svg& svg, const View& view, const Contact& contact) {
  constexpr double kArrow = 0.022;  // m
  const Eigen::Vector2d tip = view.project(contact.p_OC);
  const Eigen::Vector2d tail = view.project(contact.p_OC - kArrow * contact.n_O);
  svg.line(tail.x(), tail.y(), tip.x(), tip.y(), "class=\"halo\"");
  svg.line(tail.x(), tail.y(), tip.x(), tip.y(), "class=\"normal\"");
  svg.circle(tip.x(), tip.y(), 3.4, "class=\"contact\"");
}

}  // namespace

std::string draw_postures(const robot::RobotModel& hand, const RobotFacets& facets,
                          const std::vector<Posture>& postures, const std::string& title, double cell_width,
                          double height) {
  require(!postures.empty(), "no posture to draw");
  const HandAxes axes = hand_axes(hand);
  const Eigen::Vector3d toward = 0.62 * axes.palm + 0.72 * axes.thumb + 0.3 * axes.fingers;
  std::vector<std::vector<Facet>> bodies;
  std::vector<Eigen::Vector3d> shown;
  for (const auto& posture : postures) {
    std::vector<Facet> body;
    append_robot(body, hand, facets, Eigen::Isometry3d::Identity(), posture.q);
    const auto corners = corners_of(body);
    shown.insert(shown.end(), corners.begin(), corners.end());
    bodies.push_back(std::move(body));
  }
  Svg svg(cell_width * static_cast<double>(postures.size()), height, title);
  if (shown.empty()) shown.push_back(Eigen::Vector3d::Zero());  // a hand without geometry: an empty picture
  const View view = fit_view(toward, axes.fingers, shown, cell_width, height - kCaption, 4.0);
  svg.rect(0.0, 0.0, cell_width * static_cast<double>(postures.size()), height - kCaption, "class=\"sky\"");
  for (std::size_t i = 0; i < postures.size(); ++i) {
    const double left = cell_width * static_cast<double>(i);
    svg.open_clip(left, 0.0, cell_width, height - kCaption);
    draw_facets(svg, view, std::move(bodies[i]), body_paints());
    svg.close_clip();
    svg.text(left + 0.5 * cell_width, height - 5.0, postures[i].caption, "class=\"tick\" text-anchor=\"middle\"");
  }
  return svg.str();
}

std::string draw_grasp(const robot::RobotModel& hand, const RobotFacets& hand_facets, const robot::SceneBody& object,
                       const Grasp& grasp, GraspSide side, const std::string& title, double width, double height) {
  require(!object.geometry.empty(), "the object of a grasp has no geometry to draw");
  auto paints = body_paints();
  paints[paint_object].shows_through = false;
  std::vector<Facet> body;
  for (const auto& geometry : object.geometry)
    append(body, facets(geometry, paint_object, {28, 1200}), Eigen::Isometry3d::Identity());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  const auto object_corners = corners_of(body);
  for (const auto& p : object_corners) middle += p / static_cast<double>(object_corners.size());
  const auto X_RL = hand.link_poses(grasp.q_grasp);
  const Eigen::Isometry3d X_OR = grasp.X_OH * X_RL[static_cast<std::size_t>(hand.palm())].inverse();
  append_robot(body, hand, hand_facets, X_OR, grasp.q_grasp);

  const Eigen::Vector3d up = object.X_WB.linear().transpose() * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d ahead = middle - grasp.X_OH.translation();
  ahead -= up * up.dot(ahead);
  ahead = unit_or(ahead, up.unitOrthogonal());
  const Eigen::Vector3d left = up.cross(ahead);
  const Eigen::Vector3d toward = side == GraspSide::left ? Eigen::Vector3d(0.85 * left - 0.4 * ahead + 0.4 * up)
                                                         : Eigen::Vector3d(-0.85 * left + 0.25 * ahead + 0.3 * up);
  // Hand and the part of the object near it: a grasp of a long object would else be a small spot.
  std::vector<Eigen::Vector3d> shown;
  for (const auto& p : corners_of(body)) {
    if ((p - grasp.X_OH.translation()).norm() < 0.3) shown.push_back(p);
  }
  if (shown.empty()) shown.push_back(grasp.X_OH.translation());
  const View view = fit_view(toward, up, shown, width, height, 8.0);
  Svg svg(width, height, title);
  svg.rect(0.0, 0.0, width, height, "class=\"sky\"");
  draw_facets(svg, view, std::move(body), paints);
  for (const auto& contact : grasp.contacts) draw_contact(svg, view, contact);
  return svg.str();
}

}  // namespace opponens::report
