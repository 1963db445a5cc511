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

Eigen::Vector3d unit_or(const Eigen::Vector3d& v, const Eigen::Vector3d& fallback) {
  return v.norm() > 1e-9 ? Eigen::Vector3d(v.normalized()) : fallback;
}

constexpr double kCaption = 18.0;  // px under a posture

}  // namespace

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

}  // namespace opponens::report
