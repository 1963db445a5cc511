// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/glove_calibration.hpp"

#include <string_view>

#include "robot/robot_model.hpp"

namespace opponens::cli {
namespace {

/// Recordings with an unknown zero are calibrated together: those of one source and one value of the label that the
/// source calibrates by ("range by subject"). Empty: the channels are calibrated already.
std::string calibration_cluster(const Demonstration& motion) {
  const std::string rule = label_of(motion, "calibration");
  constexpr std::string_view prefix = "range by ";
  if (!rule.starts_with(prefix)) return {};
  return label_of(motion, "source") + "/" + label_of(motion, rule.substr(prefix.size()));
}

robot::ChannelCalibration identity(const std::vector<std::string>& channels) {
  const auto n = static_cast<Eigen::Index>(channels.size());
  return {channels, Eigen::VectorXd::Ones(n), Eigen::VectorXd::Zero(n)};
}

}  // namespace

std::string label_of(const Demonstration& motion, const std::string& name) {
  const auto found = motion.labels.find(name);
  return found == motion.labels.end() ? std::string() : found->second;
}

Calibrations calibrate(const std::vector<Stored<Demonstration>>& motions, const robot::RobotModel& human) {
  std::map<std::string, std::vector<const Demonstration*>> clusters;
  Calibrations result;
  for (const auto& motion : motions) {
    const auto cluster = calibration_cluster(motion.value);
    if (cluster.empty()) continue;
    clusters[cluster].push_back(&motion.value);
    result[cluster].recordings.push_back(motion.id);
  }
  for (const auto& [cluster, members] : clusters) {
    result.at(cluster).channels = robot::calibrate_range(members, human);
  }
  return result;
}

std::vector<std::string> inputs_of(const std::string& recording, const Calibration& calibration) {
  std::vector<std::string> inputs = {recording};
  for (const auto& other : calibration.recordings) {
    if (other != recording) inputs.push_back(other);
  }
  return inputs;
}

Calibration calibration_of(const Demonstration& motion, const Calibrations& calibrations) {
  const auto cluster = calibration_cluster(motion);
  return cluster.empty() ? Calibration{identity(motion.joint_names), {}} : calibrations.at(cluster);
}

Json still_json(const Calibrations& calibrations) {
  Json all = Json::array();
  for (const auto& [cluster, calibration] : calibrations) {
    if (!calibration.channels.still.empty()) {
      all.push_back({{"recordings", cluster}, {"channels", calibration.channels.still}});
    }
  }
  return all;
}

void say_still(const Calibrations& calibrations, const Console& console) {
  for (const auto& [cluster, calibration] : calibrations) {
    if (calibration.channels.still.empty()) continue;
    console.say("channels of " + cluster +
                " that do not move, their joints rest: " + joined(calibration.channels.still));
  }
}

}  // namespace opponens::cli
