// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Geometry>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// The tree below a link, which becomes the root; notes say how much was left out.
RobotDescription subtree(const RobotDescription& whole, int root);

/// Appends a tree to link `parent` by a fixed joint, with its allowed pairs, notes, missing meshes and SRDFs (whose
/// names stay as their files write them). Both keep their topological
/// order; the names must differ (the caller's contract). Returns the index of the tree's root.
int append_tree(RobotDescription& robot, const RobotDescription& tree, int parent, const Eigen::Isometry3d& X_PT,
                const std::string& joint_name);

/// "right/elbow_joint": how a part of a robot with several arms names its links and joints.
std::string prefixed(const std::string& part, const std::string& name);

/// Gives every link and joint, and every name that refers to one, the part's prefix.
void add_prefix(RobotDescription& tree, const std::string& part);

/// Takes it away from the joints again.
void remove_joint_prefix(RobotDescription& tree, const std::string& part);

}  // namespace opponens::robot
