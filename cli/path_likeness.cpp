// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/path_likeness.hpp"

#include <string>
#include <utility>

namespace opponens::cli {
namespace {

using analysis::LikenessReference;

/// Covariance of a group's grasp phase, in radians.
LikenessReference grasp_phase_reference(const SynergyGroup& group) {
  const Eigen::MatrixXd scaled = group.basis.axes * group.basis.variance.asDiagonal() * group.basis.axes.transpose();
  return {"grasp phase of group " + group.name, group.box.scale.asDiagonal() * scaled * group.box.scale.asDiagonal()};
}

/// Of the values that are there.
std::optional<double> mean_of(const std::vector<std::optional<double>>& values) {
  double sum = 0.0;
  double count = 0.0;
  for (const auto& value : values) {
    if (!value) continue;
    sum += *value;
    count += 1.0;
  }
  return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

/// Names of the references, each once: "grasp phase of group 1 and grasp phase of group 3".
std::string names_of(const std::vector<LikenessReference>& references) {
  std::string names;
  for (const auto& reference : references) {
    if (names.find(reference.name) == std::string::npos) names += (names.empty() ? "" : " and ") + reference.name;
  }
  return names;
}

/// Appends the entries of one path. references: of each arm.
void append(Json& list, const char* of, const Eigen::MatrixXd& waypoints, const std::vector<robot::DrivenArm>& arms,
            const std::vector<LikenessReference>& references) {
  std::vector<std::optional<double>> values;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const Eigen::MatrixXd hand = waypoints.middleCols(arms[i].hand.first, arms[i].hand.count);
    values.push_back(analysis::human_likeness(hand, references[i]));
  }
  Json main = {{"of", of}, {"value", number(mean_of(values))}, {"reference", names_of(references)}};
  if (arms.size() == 1) {
    list.push_back(std::move(main));
    return;
  }
  for (const auto& arm : arms) main["hands"].push_back(arm.name);
  list.push_back(std::move(main));
  for (std::size_t i = 0; i < arms.size(); ++i) {
    list.push_back({{"of", of},
                    {"value", number(values[i])},
                    {"reference", references[i].name},
                    {"hands", Json::array({arms[i].name})}});
  }
}

}  // namespace

std::optional<LikenessReference> free_motion_reference(const storage::Store& store) {
  const Motions motions = hand_motions(store);
  std::vector<const Demonstration*> values;
  for (const auto& motion : motions.newest) values.push_back(&motion.value);
  return analysis::free_motion_reference(values);
}

Json likeness_of_path(const Eigen::MatrixXd& planned, const Eigen::MatrixXd& final,
                      const std::vector<robot::DrivenArm>& arms, const std::vector<const SynergyGroup*>& groups,
                      const std::optional<LikenessReference>& free_motion) {
  Json list = Json::array();
  const auto add = [&](const std::vector<LikenessReference>& references) {
    append(list, "planned", planned, arms, references);
    append(list, "final", final, arms, references);
  };
  if (free_motion) {
    add({arms.size(), *free_motion});
  } else {
    list.push_back({{"of", "planned"}, {"value", nullptr}, {"reference", "none in the store"}});
  }
  std::vector<LikenessReference> phases;
  phases.reserve(groups.size());
  for (const SynergyGroup* group : groups) phases.push_back(grasp_phase_reference(*group));
  add(phases);
  return list;
}

}  // namespace opponens::cli
