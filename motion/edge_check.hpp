// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "motion/continuous_check.hpp"
#include "motion/joint_groups.hpp"
#include "motion/world.hpp"
#include "robot/collision.hpp"
#include "robot/robot_model.hpp"

namespace opponens::motion {

/// Whether a configuration [d] rad is valid. Same argument, same answer; thread-safe if the world is to be.
using Validity = std::function<bool(const Eigen::VectorXd& q)>;

/// Checks the motion q_from (exclusive) to q_to (inclusive) at equal spacing <= resolution (rad, weighted metric, and
/// that of each group): first q_to, then the inner configurations by bisection (1/2, 1/4, 3/4, 1/8, ...: van der
/// Corput's sequence), so that an obstacle in the middle is met after few evaluations. Returns the fraction of the
/// first invalid configuration in that order. Deterministic; adds the configurations evaluated to checks.
std::optional<double> first_invalid(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, const Validity& valid,
                                    const Eigen::VectorXd& weights, const Spacing& resolution, std::int64_t& checks);

/// The same of freedom from collision, asked eight configurations at a time: all of an eight count as evaluated.
std::optional<double> first_invalid(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                    const robot::CollisionChecker& checker, const Eigen::VectorXd& weights,
                                    const Spacing& resolution, std::int64_t& checks);

/// The first row of a batch [B x d] rad that is not valid. Same argument, same answer.
using FirstInvalidRow = std::function<std::optional<int>(const robot::ConfigurationBatch& batch)>;

/// The same with any validity that is asked of eight configurations at a time.
std::optional<double> first_invalid_by_rows(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                            const FirstInvalidRow& first_row, const Eigen::VectorXd& weights,
                                            const Spacing& resolution, std::int64_t& checks);

/// A World of such a validity, at the given spacing and at a tenth of it to confirm an answer.
World make_world_by_rows(const FirstInvalidRow& first_row, const Eigen::VectorXd& weights, const Spacing& resolution);

/// A World that asks `valid` at the given spacing, and at confirm_resolution (default: a tenth of it) to confirm an
/// answer; confirm_resolution = 0: no confirmation.
World make_world(const Validity& valid, const Eigen::VectorXd& weights, double resolution, double confirm_resolution);
World make_world(const Validity& valid, const Eigen::VectorXd& weights, const Spacing& resolution);

/// The robot's world: inside the joint limits, free for the checker, which is asked in batches, and with `clearance`:
/// motions that are confirmed keep it throughout, single configurations keep it too. Checker and robot are referred to
/// and must outlive the world. The checker's scene may be larger than that of the clearance's.
World make_world(const robot::CollisionChecker& checker, const robot::RobotModel& robot, const Spacing& resolution,
                 std::shared_ptr<const ContinuousCheck> clearance);
/// With the default clearance of what the checker checks.
World make_world(const robot::CollisionChecker& checker, const robot::RobotModel& robot, const Spacing& resolution);

}  // namespace opponens::motion
