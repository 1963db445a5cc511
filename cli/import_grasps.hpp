// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/world.hpp"
#include "grasp/close_hand.hpp"

namespace opponens::cli {

/// Grasps read from a file, as postures of the world's hand.
struct ImportedPostures {
  struct One {
    std::string name;  ///< in the file: "grasp 3", or the id of a stored grasp
    grasp::HandPose posture;
    std::optional<std::string> object;  ///< that it was made for, as the file says
  };
  std::string form;  ///< "frogger", "grasp" (a document of grasp --json) or "export"
  std::vector<One> postures;
};

/// Reads grasps made elsewhere: FRoGGeR's JSON (X_object_handbase, hand_q in hand_joint_order, hand base = the link
/// that handbase_frame names), the document of `opponens grasp --json`, or a file of `opponens export --format json`.
/// Joints go by their names. Poses are made rigid where eight digits have left them short of it. Throws InputError
/// naming file, grasp and field, and what was expected: also for an empty list.
ImportedPostures import_grasps(const std::filesystem::path& file, const NamedWorld& world);

}  // namespace opponens::cli
