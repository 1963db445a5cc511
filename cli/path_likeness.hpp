// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/human_likeness.hpp"
#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "core/synergies.hpp"
#include "robot/robot_model.hpp"

namespace opponens::cli {

/// Free motions of the hand, the reference of human-likeness; nullopt when the store has none.
std::optional<analysis::LikenessReference> free_motion_reference(const storage::Store& store);

/// The human-likeness of a path as planned and as it became, [N x d] rad each, both up to the pre-grasp: a list of
/// {of, value, reference}, the main one first. groups: of each driven arm's grasp. Where several hands move, the mean
/// over those that do comes first and each hand's own after it; `hands` then names which hands a value is of.
Json likeness_of_path(const Eigen::MatrixXd& planned, const Eigen::MatrixXd& final,
                      const std::vector<robot::DrivenArm>& arms, const std::vector<const SynergyGroup*>& groups,
                      const std::optional<analysis::LikenessReference>& free_motion);

}  // namespace opponens::cli
