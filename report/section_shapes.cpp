// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "report/hand_drawing.hpp"
#include "report/sections.hpp"
#include "report/svg.hpp"

namespace opponens::report {
namespace {

constexpr double kDrawnDeviations = 1.5;  ///< standard deviations from the mean that a drawing shows
constexpr Eigen::Index kDrawnSynergies = 3;

/// The hand at q as far as its limits let it, with the words that tell where they do not.
Posture posture(const robot::RobotModel& hand, const std::vector<std::string>& joint_names, const Eigen::VectorXd& q,
                const std::string& name) {
  const Eigen::VectorXd wanted = by_name(hand, joint_names, q, rest_configuration(hand));
  const Eigen::VectorXd reached = hand.clip(wanted);
  const double clipped = (wanted - reached).cwiseAbs().maxCoeff();
  return {reached, clipped < 0.005 ? name : concat({name, ", clipped by ", fixed(clipped, 2)})};
}

Markup draw_synergy(const robot::RobotModel& hand, const RobotFacets& facets, const SynergyPart& part,
                    const SynergyItem& item, Eigen::Index i) {
  const auto& group = item.group;
  const double reach = kDrawnDeviations * std::sqrt(std::max(0.0, group.basis.variance[i]));
  std::vector<Posture> postures;
  for (const int side : {-1, 0, 1}) {
    const Eigen::VectorXd x = group.basis.mean + side * reach * group.basis.axes.col(i);
    const Eigen::VectorXd q = group.box.scale.cwiseProduct(x);
    postures.push_back(posture(hand, part.joint_names, q,
                               side == 0  ? "mean"
                               : side < 0 ? "mean - 1.5 s"
                                          : "mean + 1.5 s"));
  }
  const double total = group.basis.variance.sum();
  const double share = total > 0.0 ? group.basis.variance[i] / total : 0.0;
  const std::string name = concat({"Synergy ", std::to_string(i + 1), " of ", group.name});
  const std::string caption = concat({"Synergy ", std::to_string(i + 1), ": ", percent(share),
                                      " of the variance, s = ", fixed(reach / kDrawnDeviations, 2),
                                      i < group.box.half_width.size() ? "" : " (beyond k)"});
  return figure(draw_postures(hand, facets, postures, name, 172.0, 190.0), caption);
}

}  // namespace

Markup synergy_drawing_section(const ReportInput& input) {
  if (!input.synergies) return note("No synergies to draw.");
  if (!input.hand) return note("The hand's model was not given: its shape cannot be drawn.");
  check_sizes(*input.synergies);
  const RobotFacets facets = robot_facets(*input.hand, 2400);
  Markup out = paragraph(
      "The robot hand at the mean of each group and 1.5 standard deviations s to both sides along its first three "
      "synergies, clipped to the joint limits where that reaches beyond them (the words say by how much at most, "
      "rad).");
  for (const auto& item : input.synergies->groups) {
    out += subheading(item.group.name == "pre-grasp"
                          ? "Pre-grasp"
                          : concat({item.group.phase == "grasp" ? "Grasp phase, " : "Whole movement, ",
                                    input.synergies->grouped_by, " ", item.group.name}));
    std::vector<Markup> drawings;
    for (Eigen::Index i = 0; i < std::min(kDrawnSynergies, item.group.basis.variance.size()); ++i) {
      drawings.push_back(draw_synergy(*input.hand, facets, *input.synergies, item, i));
    }
    out += row_of(drawings);
  }
  return out;
}

}  // namespace opponens::report
