// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "recorded_paths.hpp"

#include <cstdlib>
#include <fstream>

#include <nlohmann/json.hpp>

namespace opponens::benchmarks {

Recorded read_paths(const std::string& file, const robot::RobotModel& robot, const std::string& object) {
  std::ifstream stream(OPPONENS_SOURCE_DIR "/experiments/benchmarks/" + file);
  const auto document = nlohmann::json::parse(stream);
  const char* const at_most = std::getenv("OPPONENS_BENCHMARK_PATHS");
  Recorded recorded;
  for (const auto& one : document.at("paths")) {
    if (at_most != nullptr && recorded.paths.size() >= std::stoul(at_most)) break;
    const auto rows = one.at("waypoints").get<std::vector<std::vector<double>>>();
    JointPath path;
    path.joint_names = robot.joint_names();
    path.waypoints.resize(static_cast<Eigen::Index>(rows.size()), robot.dof());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      path.waypoints.row(static_cast<Eigen::Index>(i)) =
          Eigen::Map<const Eigen::RowVectorXd>(rows[i].data(), static_cast<Eigen::Index>(rows[i].size()));
    }
    verify::PathClaim claim;
    claim.closing_from = one.at("closing_from").get<Eigen::Index>();
    claim.start = path.waypoints.row(0).transpose();
    claim.goal = path.waypoints.row(claim.closing_from).transpose();
    claim.grasp = path.waypoints.row(path.waypoints.rows() - 1).transpose();
    claim.hands = {{{}, {}, object, {}}};
    for (const auto& link : one.at("contact_links")) claim.hands[0].contact_links.insert(link.get<std::string>());
    recorded.paths.push_back(path);
    recorded.claims.push_back(claim);
  }
  return recorded;
}

Setting ours() {
  return {robot::RobotModel(robot::load_robot(OPPONENS_SOURCE_DIR "/models/ur5_allegro/ur5_allegro_right.yaml"))};
}

Setting laboratory() {
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  return {robot::RobotModel(
      robot::load_robot(OPPONENS_SOURCE_DIR "/tests/data/robots/paper_lab_ur5_allegro_right_visual.yaml"))};
}

}  // namespace opponens::benchmarks
