// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <future>

#include "cli/commands.hpp"
#include "cli/glove_calibration.hpp"
#include "cli/json.hpp"
#include "cli/resources.hpp"
#include "cli/retarget_totals.hpp"
#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "core/require.hpp"
#include "robot/load_robot.hpp"
#include "robot/retarget.hpp"
#include "storage/codec.hpp"
#include "storage/readers/source.hpp"

namespace opponens::cli {
namespace {

constexpr const char* kHumanHand = "models/human_hand/human_hand.yaml";
constexpr double kShortestHand = 0.1;  ///< m, of a wearer
constexpr double kLongestHand = 0.3;   ///< m

/// Length of the wearer's hand, m, where the label hand_length or the option tells it.
std::optional<double> told_length(const Demonstration& motion, const RetargetOptions& options) {
  const std::string text = label_of(motion, "hand_length");
  if (text.empty()) return options.hand_length;
  double length = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  if (error != std::errc() || end != text.data() + text.size() || length < kShortestHand || length > kLongestHand) {
    throw InputError("recording " + motion.id + ": label hand_length: expected metres between 0.1 and 0.3, found '" +
                     text + "'");
  }
  return length;
}

/// All that every recording of one command shares.
struct Task {
  const RetargetOptions& options;
  robot::RobotModel hand;
  robot::RobotDescription human;  ///< of the reference size
  robot::HandMapping mapping;
  robot::RetargetSettings settings;
  Calibrations calibrations;
};

robot::MappingKind mapping_kind(const std::string& name) {
  if (name == "joint") return robot::MappingKind::joint;
  return name == "fingertip" ? robot::MappingKind::fingertip : robot::MappingKind::paper;
}

Task make_task(const RetargetOptions& options, const std::vector<Stored<Demonstration>>& motions) {
  const auto hand_file = find_file(options.hand);
  Task task{options,
            robot::RobotModel(load_hand_file(options.hand, options.urdf)),
            robot::load_hand(find_file(kHumanHand)),
            robot::load_hand_mapping(hand_file),
            robot::default_settings(mapping_kind(options.mapping)),
            {}};
  const robot::RobotModel human(task.human);
  task.calibrations = calibrate(motions, human);
  if (options.mapping == "paper") {
    if (options.hand_length) {
      throw InputError("--hand-length: with --mapping paper the size of the human hand divides out; leave it out");
    }
    return task;
  }
  if (task.mapping.fingertips.empty()) {
    if (options.mapping == "joint") return task;
    throw InputError(hand_file.string() + ": mapping.fingertips is missing; --mapping fingertip needs it");
  }
  const auto alignment = robot::align_hands(human, task.hand, task.mapping);
  if (!alignment) throw InputError(hand_file.string() + ": " + alignment.error().detail);
  task.settings.alignment = *alignment;
  return task;
}

robot::RetargetSettings settings_of(const Demonstration& motion, const Task& task) {
  robot::RetargetSettings settings = task.settings;
  settings.postures = label_of(motion, "kind") == storage::kPostures;
  return settings;
}

/// Maps every recording on the given number of threads; recordings that an interrupt left out are empty. The results do
/// not depend on the number of threads.
std::vector<std::optional<Result<robot::Retargeted>>> map_all(const std::vector<Stored<Demonstration>>& motions,
                                                              const Task& task, int threads, const Console& console) {
  std::vector<std::optional<Result<robot::Retargeted>>> mapped(motions.size());
  std::map<double, robot::RobotModel> humans;  // by hand length
  for (const auto& motion : motions) {
    const double length = told_length(motion.value, task.options).value_or(robot::kHumanHandLength);
    if (humans.contains(length)) continue;
    humans.emplace(length, robot::RobotModel(robot::scaled(task.human, length / robot::kHumanHandLength)));
  }
  std::atomic<std::size_t> next = 0;
  Progress progress(console, "mapping to the robot hand");
  const auto work = [&](bool tells) {
    for (std::size_t i = next++; i < motions.size() && !interrupt_requested; i = next++) {
      const Demonstration& motion = motions[i].value;
      const double length = told_length(motion, task.options).value_or(robot::kHumanHandLength);
      mapped[i] = robot::retarget(motion, calibration_of(motion, task.calibrations).channels, humans.at(length),
                                  task.hand, task.mapping, settings_of(motion, task));
      if (tells && !interrupt_requested) {
        progress.update(static_cast<std::int64_t>(i) + 1, static_cast<std::int64_t>(motions.size()));
      }
    }
  };
  std::vector<std::future<void>> others;
  for (int t = 1; t < threads; ++t) others.push_back(std::async(std::launch::async, work, false));
  work(true);
  for (auto& other : others) other.get();  // rethrows here
  return mapped;
}

storage::Record motion_record(const robot::Retargeted& mapped, const storage::Provenance& origin) {
  auto record = storage::encode(mapped.demonstration, origin);
  record.kind = kHandMotion;
  if (!mapped.tips.empty()) {
    record.fields["tip_residual_rms"] = mapped.tip_residual_rms;
    record.fields["tip_residual_max"] = mapped.tip_residual_max;
    record.fields["tip_names"] = mapped.tips;
    record.fields["tip_rms"] = mapped.tip_rms;
  }
  record.fields["clamped_samples"] = std::int64_t{mapped.clamped_samples};
  record.fields["clamped_share"] = mapped.clamped_share;
  return record;
}

/// Which sizes of the wearers' hands were used; nothing for --mapping paper, where they have no effect.
void say_hand_lengths(const std::vector<Stored<Demonstration>>& motions, const Task& task, const Console& console) {
  if (!task.settings.alignment) return;
  const auto assumed = std::count_if(motions.begin(), motions.end(), [&](const Stored<Demonstration>& motion) {
    return !told_length(motion.value, task.options).has_value();
  });
  if (assumed == 0) return;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "hand length of %.3f m assumed for %d of %zu recordings: they have no label hand_length, and "
                "--hand-length was not given",
                robot::kHumanHandLength, static_cast<int>(assumed), motions.size());
  console.say(text.data());
}

Json alignment_json(const Task& task) {
  const auto& alignment = task.settings.alignment;
  return alignment ? Json{{"scale", alignment->scale}, {"offset_m", array(alignment->offset)}} : Json(nullptr);
}

storage::Provenance origin_of(const Task& task) {
  const RetargetOptions& options = task.options;
  std::vector<std::filesystem::path> files = task.hand.description().files;
  files.insert(files.end(), task.human.files.begin(), task.human.files.end());
  Json parameters = {{"hand", recorded_name(find_file(options.hand))}, {"mapping", options.mapping}};
  if (!options.urdf.empty()) parameters["urdf"] = recorded_name(find_file(options.urdf));
  if (task.settings.alignment) parameters["alignment"] = alignment_json(task);
  return provenance("retarget", {}, files, parameters, 0);
}

/// What came of all recordings.
struct Outcome {
  std::vector<storage::Record> records{};
  RetargetTotals totals{};
  Json skipped = Json::array();  ///< [{id, reason}]
};

Outcome collect(const std::vector<Stored<Demonstration>>& motions,
                const std::vector<std::optional<Result<robot::Retargeted>>>& mapped, const Task& task) {
  Outcome outcome;
  const storage::Provenance common = origin_of(task);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (!mapped[i]) continue;
    if (!*mapped[i]) {
      outcome.skipped.push_back({{"id", motions[i].id}, {"reason", mapped[i]->error().detail}});
      continue;
    }
    const Demonstration& motion = motions[i].value;
    storage::Provenance origin = common;
    origin.inputs = inputs_of(motions[i].id, calibration_of(motion, task.calibrations));
    if (task.settings.alignment) {
      Json parameters = Json::parse(origin.parameters);
      parameters["hand_length_m"] = told_length(motion, task.options).value_or(robot::kHumanHandLength);
      origin.parameters = parameters.dump();
    }
    outcome.records.push_back(motion_record(**mapped[i], origin));
    outcome.totals.add(**mapped[i]);
  }
  return outcome;
}

/// Throws InputError when nothing could be mapped.
void warn_skipped(const Outcome& outcome) {
  if (outcome.skipped.empty()) return;
  const std::string first = outcome.skipped.front().at("reason").get<std::string>();
  if (outcome.records.empty()) throw InputError("no recording could be mapped; the first: " + first);
  for (const Json& one : outcome.skipped) Console::warn("skipped: " + one.at("reason").get<std::string>());
}

}  // namespace

int retarget(const RetargetOptions& options, const Console& console) {
  storage::Store store(options.common.store, false);
  const int threads = thread_count(options.common.threads);
  const RunLog log(store, "retarget", threads);
  const auto [motions, superseded] = recordings(store);
  if (motions.empty())
    throw InputError(store.directory().string() + ": no recordings; run: opponens simulate, or ingest");
  say_superseded(console, superseded);
  const Task task = make_task(options, motions);
  const Outcome outcome = collect(motions, map_all(motions, task, threads, console), task);
  if (!interrupt_requested) warn_skipped(outcome);
  const auto ids = store.commit(outcome.records);
  log.finish(ids);
  if (interrupt_requested) throw Interrupted();
  console.say("mapped " + std::to_string(ids.size()) + " recordings to " + task.hand.description().name +
              ", --mapping " + options.mapping);
  say_hand_lengths(motions, task, console);
  say_still(task.calibrations, console);
  outcome.totals.say(console);
  Json result = document("retarget");
  result.update(outcome.totals.json());
  result.update(
      {{"mapping", options.mapping}, {"alignment", alignment_json(task)}, {"still", still_json(task.calibrations)}});
  result["ids"] = ids;
  result["skipped"] = outcome.skipped;
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
