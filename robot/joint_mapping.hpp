// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/demonstration.hpp"
#include "core/result.hpp"
#include "robot/hand_mapping.hpp"

namespace opponens::robot {

using BoolMatrix = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Place of a name in a list.
std::optional<int> index_of(const std::vector<std::string>& names, const std::string& name);

/// The human joint positions of all samples [d x T] rad, calibrated; channels not recorded stay nearest to zero.
/// Failure: a value is not finite (invalid_input).
Result<Eigen::MatrixXd> human_positions(const Demonstration& recording, const ChannelCalibration& calibration,
                                        const RobotModel& human);

/// Copies human joints into the rows of q [d x T] of the robot hand and marks in clamped [d x T] which samples lay
/// beyond a limit. Failure: a joint or channel is missing (not_found).
Result<std::monostate> copy_joints(const RobotModel& human, const Eigen::MatrixXd& q_human, const RobotModel& hand,
                                   const std::vector<JointMapping>& copies, Eigen::MatrixXd& q, BoolMatrix& clamped);

}  // namespace opponens::robot
