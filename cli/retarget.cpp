// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>
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
constexpr double kModelHandLength = 0.19;  // m, of models/human_hand

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

using Calibrations = std::map<std::string, robot::ChannelCalibration>;

Calibrations calibrate(const std::vector<Stored<Demonstration>>& motions, const robot::RobotModel& human) {
  std::map<std::string, std::vector<const Demonstration*>> clusters;
  for (const auto& motion : motions) {
    const auto cluster = calibration_cluster(motion.value);
    if (!cluster.empty()) clusters[cluster].push_back(&motion.value);
  }
  Calibrations result;
  for (const auto& [cluster, members] : clusters) result[cluster] = robot::calibrate_range(members, human, {});
  return result;
}

double hand_length(const Demonstration& motion, double otherwise) {
  const std::string text = label(motion, "hand_length");
  if (text.empty()) return otherwise;
  double length = 0.0;
  const auto end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, length);
  if (error != std::errc() || stop != end || !(length > 0.0)) {
    throw InputError(motion.id + ": label hand_length is '" + text + "', expected metres");
  }
  return length;
}

/// Human hands by length: a store rarely has more than a few wearers.
class HumanHands {
 public:
  explicit HumanHands(robot::RobotDescription description) : description_(std::move(description)) {}
  const robot::RobotModel& of_length(double length) {
    const auto found = hands_.find(length);
    if (found != hands_.end()) return found->second;
    return hands_.emplace(length, robot::RobotModel(robot::scaled(description_, length / kModelHandLength)))
        .first->second;
  }

 private:
  robot::RobotDescription description_;
  std::map<double, robot::RobotModel> hands_;
};

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
  const auto motions = recordings(store);
  if (motions.empty())
    throw InputError(store.directory().string() + ": no recordings; run: opponens simulate, or ingest");
  const auto hand_file = find_file(options.hand);
  const auto human_file = find_file(kHumanHand);
  const robot::RobotModel hand(robot::load_hand(hand_file));
  const auto mapping = robot::load_hand_mapping(hand_file);
  HumanHands humans(robot::load_hand(human_file));
  const Calibrations calibrations = calibrate(motions, humans.of_length(options.hand_length));

  Progress progress(console, "mapping to the robot hand");
  std::vector<storage::Record> records;
  Residuals residuals;
  for (const auto& motion : motions) {
    if (interrupt_requested) break;
    progress.update(static_cast<std::int64_t>(records.size()), static_cast<std::int64_t>(motions.size()));
    const double length = hand_length(motion.value, options.hand_length);
    const auto cluster = calibration_cluster(motion.value);
    const auto calibration = cluster.empty() ? identity(motion.value.joint_names) : calibrations.at(cluster);
    const auto mapped = robot::retarget(motion.value, calibration, humans.of_length(length), hand, mapping, {});
    if (!mapped) throw InputError(motion.value.id + ": " + mapped.error().detail);
    const Json parameters = {{"hand", recorded_name(hand_file)}, {"mapping", options.mapping}, {"hand_length", length}};
    records.push_back(
        motion_record(*mapped, provenance("retarget", {motion.id}, {hand_file, human_file}, parameters, 0)));
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
