// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "core/grasp.hpp"

namespace opponens::cli {

/// Gravity on an object, and other wrenches that act on it.
struct TaskInput {
  double mass = 0.0;                                                      ///< kg; 0: none
  Eigen::Vector3d p_OM = Eigen::Vector3d::Zero();                         ///< m, centre of mass
  std::vector<Eigen::Vector3d> down;                                      ///< directions in which gravity may act, in O
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> disturbances;  ///< force N, torque N m about the origin
};

struct ContactCase {
  std::string name;
  std::vector<Contact> contacts;
  QualityConvention convention;
  std::vector<WrenchNorm> norms;  ///< under which to score it, one or two
  TaskInput task;
};

/// The contact sets of a file in the form of docs/cli.md, quality; options that are given win over the file. Throws
/// InputError that names file, field, value and what was expected.
std::vector<ContactCase> read_contact_cases(const std::filesystem::path& file, const QualityOptions& options);

}  // namespace opponens::cli
