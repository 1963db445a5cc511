// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/grasp.hpp"

namespace opponens::table2 {

/// Grasps that were chosen before any planner was tuned, of one hand and one object. Of each: group, epsilon, q_grasp,
/// q_pregrasp, X_OH, X_OH_pregrasp and the links of its contacts; nothing else is filled.
struct PredefinedGrasps {
  std::string hand;    ///< which hand and object, for a person
  std::string object;  ///< body of the scene
  std::vector<Grasp> grasps;
};

/// joint_names: [n] of the hand, in whose order positions are returned. Throws InputError naming file and field.
PredefinedGrasps load_grasps(const std::filesystem::path& file, const std::vector<std::string>& joint_names);
/// Throws InputError when the file cannot be written.
void save_grasps(const std::filesystem::path& file, const PredefinedGrasps& grasps,
                 const std::vector<std::string>& joint_names);

}  // namespace opponens::table2
