// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// FRoGGeR's published grasps (Li et al. 2024, doi:10.1109/ICRA57147.2024.10610519), read from reference/frogger.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace opponens {

struct ReferenceGrasp {
  int index = 0;
  double min_weight = 0.0;
  double epsilon = 0.0;
  double seconds = 0.0;            ///< published, on their hardware, failures included
  double surface_violation = 0.0;  ///< m
  double collision_violation = 0.0;
  double joint_violation = 0.0;
  Eigen::Isometry3d X_OB = Eigen::Isometry3d::Identity();  ///< hand base in the object
  Eigen::VectorXd q;                                       ///< [16] rad
};

struct ReferenceFile {
  std::string object;
  std::string method;  ///< frogger, baseline_fc, fccorr16
  double mu = 0.0;
  int edges = 0;
  double depth = 0.0;              ///< m, d_pen: how deep a tip may be
  double surface_tolerance = 0.0;  ///< m
  double collision_tolerance = 0.0;
  double joint_tolerance = 0.0;                     ///< rad
  double table_z = 0.0;                             ///< m, in O: the table top is at z = 0 of the world
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();  ///< m, bounding box of the mesh that they used
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();
  int tried = 0;  ///< grasps in the file, timed out ones included
  std::vector<ReferenceGrasp> valid;
};

/// valid: a solution is there and its own violations are within the file's own tolerances. Throws InputError.
ReferenceFile read_reference(const std::filesystem::path& file);

}  // namespace opponens
