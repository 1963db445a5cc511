// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/resources.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"
#include "robot/hand_mapping.hpp"
#include "robot/load_robot.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

constexpr const char* kHumanHand = "models/human_hand/human_hand.yaml";

std::string label(const Demonstration& motion, const std::string& name) {
  const auto found = motion.labels.find(name);
  return found == motion.labels.end() ? std::string() : found->second;
}

/// Recordings with an unknown zero are calibrated together: those of one source and one value of the label that the
/// source calibrates by ("range by subject"). Empty: the channels are calibrated already.
std::string calibration_cluster(const Demonstration& motion) {
  const std::string rule = label(motion, "calibration");
  constexpr std::string_view prefix = "range by ";
  if (!rule.starts_with(prefix)) return {};
  return label(motion, "source") + "/" + label(motion, rule.substr(prefix.size()));
}

robot::ChannelCalibration identity(const std::vector<std::string>& channels) {
  const auto n = static_cast<Eigen::Index>(channels.size());
  return {channels, Eigen::VectorXd::Ones(n), Eigen::VectorXd::Zero(n)};
}

/// How the channels of one cluster are calibrated, and from which recordings.
struct Calibration {
  robot::ChannelCalibration channels;
  std::vector<std::string> recordings;  ///< ids
};
using Calibrations = std::map<std::string, Calibration>;

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
    result.at(cluster).channels = robot::calibrate_range(members, human, {});
  }
  return result;
}

/// What a mapped motion is made from: its recording first, then the others that its calibration rests on.
std::vector<std::string> inputs_of(const std::string& recording, const Calibration& calibration) {
  std::vector<std::string> inputs = {recording};
  for (const auto& other : calibration.recordings) {
    if (other != recording) inputs.push_back(other);
  }
  return inputs;
}

struct Residuals {
  double squares = 0.0;
  double largest = 0.0;
  int clamped = 0;
  int samples = 0;
};

storage::Record motion_record(const robot::Retargeted& mapped, const storage::Provenance& origin) {
  auto record = storage::encode(mapped.demonstration, origin);
  record.kind = kHandMotion;
  record.fields["tip_residual_rms"] = mapped.tip_residual_rms;
  record.fields["tip_residual_max"] = mapped.tip_residual_max;
  record.fields["clamped_samples"] = std::int64_t{mapped.clamped_samples};
  return record;
}

}  // namespace

int retarget(const RetargetOptions& options, const Console& console) {
  storage::Store store(options.common.store, false);
  const RunLog log(store, "retarget", 1);
  const auto [motions, superseded] = recordings(store);
  if (motions.empty())
    throw InputError(store.directory().string() + ": no recordings; run: opponens simulate, or ingest");
  const auto hand_file = find_file(options.hand);
  const auto human_file = find_file(kHumanHand);
  say_superseded(console, superseded);
  const robot::RobotModel hand(robot::load_hand(hand_file));
  const robot::RobotModel human(robot::load_hand(human_file));
  const auto mapping = robot::load_hand_mapping(hand_file);
  const Calibrations calibrations = calibrate(motions, human);
  std::vector<std::filesystem::path> files = hand.description().files;
  files.insert(files.end(), human.description().files.begin(), human.description().files.end());
  storage::Provenance origin =
      provenance("retarget", {}, files, {{"hand", recorded_name(hand_file)}, {"mapping", options.mapping}}, 0);

  Progress progress(console, "mapping to the robot hand");
  std::vector<storage::Record> records;
  Residuals residuals;
  for (const auto& motion : motions) {
    if (interrupt_requested) break;
    progress.update(static_cast<std::int64_t>(records.size()), static_cast<std::int64_t>(motions.size()));
    const auto cluster = calibration_cluster(motion.value);
    const auto calibration =
        cluster.empty() ? Calibration{identity(motion.value.joint_names), {}} : calibrations.at(cluster);
    const auto mapped = robot::retarget(motion.value, calibration.channels, human, hand, mapping, {});
    if (!mapped) throw InputError(motion.value.id + ": " + mapped.error().detail);
    origin.inputs = inputs_of(motion.id, calibration);
    records.push_back(motion_record(*mapped, origin));
    const auto samples = static_cast<int>(motion.value.time.size());
    residuals.squares += mapped->tip_residual_rms * mapped->tip_residual_rms * samples;
    residuals.largest = std::max(residuals.largest, mapped->tip_residual_max);
    residuals.clamped += mapped->clamped_samples;
    residuals.samples += samples;
  }
  const auto ids = store.commit(records);
  log.finish(ids);
  if (interrupt_requested) throw Interrupted();
  const double rms = std::sqrt(residuals.squares / residuals.samples);
  char text[200];
  std::snprintf(text, sizeof text,
                "mapped %zu recordings to %s: fingertips off by %.1f mm rms, %.1f mm at most; a joint was clamped in "
                "%d of %d samples",
                ids.size(), hand.description().name.c_str(), 1e3 * rms, 1e3 * residuals.largest, residuals.clamped,
                residuals.samples);
  console.say(text);
  Json result = document("retarget");
  result.update({{"ids", ids},
                 {"tip_residual_rms_m", rms},
                 {"tip_residual_max_m", residuals.largest},
                 {"clamped_samples", residuals.clamped},
                 {"samples", residuals.samples}});
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
