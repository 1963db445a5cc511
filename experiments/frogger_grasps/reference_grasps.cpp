// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/frogger_grasps/reference_grasps.hpp"

#include <fstream>

#include <nlohmann/json.hpp>

#include "core/require.hpp"

namespace opponens {
namespace {

using nlohmann::json;

Eigen::Isometry3d read_pose(const json& rows) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c)
      pose.matrix()(r, c) = rows.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c));
  }
  // Written with eight digits: the rotation is brought back to an orthonormal one.
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return pose;
}

ReferenceGrasp read_grasp(const json& value) {
  ReferenceGrasp grasp;
  grasp.index = value.at("i");
  grasp.min_weight = value.at("min_weight_metric_l");
  grasp.epsilon = value.at("ferrari_canny");
  grasp.seconds = value.at("total_time_s");
  grasp.surface_violation = value.at("surface_violation_m");
  grasp.collision_violation = value.at("collision_violation_m");
  grasp.joint_violation = value.at("joint_violation");
  grasp.X_OB = read_pose(value.at("X_object_handbase"));
  const std::vector<double> q = value.at("hand_q");
  grasp.q = Eigen::Map<const Eigen::VectorXd>(q.data(), static_cast<Eigen::Index>(q.size()));
  return grasp;
}

}  // namespace

ReferenceFile read_reference(const std::filesystem::path& file) {
  std::ifstream input(file);
  if (!input) throw InputError(file.string() + ": cannot be read");
  try {
    const json document = json::parse(input);
    ReferenceFile reference;
    reference.object = document.at("object");
    reference.method = document.at("method");
    const json& model = document.at("model_settings");
    reference.mu = model.at("mu");
    reference.edges = model.at("ns");
    reference.depth = model.at("d_pen");
    const json& options = document.at("opt_settings");
    reference.surface_tolerance = options.at("tol_surf");
    reference.collision_tolerance = options.at("tol_col");
    reference.joint_tolerance = options.at("tol_joint");
    reference.table_z = -read_pose(document.at("X_world_object")).translation().z();
    for (int i = 0; i < 3; ++i) {
      reference.lower[i] = document.at("aabb_object").at(0).at(static_cast<std::size_t>(i));
      reference.upper[i] = document.at("aabb_object").at(1).at(static_cast<std::size_t>(i));
    }
    for (const json& value : document.at("grasps")) {
      ++reference.tried;
      if (value.at("min_weight_metric_l").is_null()) continue;  // timed out
      const ReferenceGrasp grasp = read_grasp(value);
      const bool within = grasp.surface_violation <= reference.surface_tolerance &&
                          grasp.collision_violation <= reference.collision_tolerance &&
                          grasp.joint_violation <= reference.joint_tolerance;
      if (within) reference.valid.push_back(grasp);
    }
    return reference;
  } catch (const json::exception& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

}  // namespace opponens
