// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/console.hpp"
#include "cli/resources.hpp"
#include "core/demonstration.hpp"
#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "storage/store.hpp"

namespace opponens::cli {

// Kinds of stored objects; the library's codecs know the types, these names say what an object is in the flow.
inline constexpr const char* kRecording = "demonstration";        ///< a glove recording
inline constexpr const char* kHandMotion = "hand_demonstration";  ///< the same, mapped to a robot hand
inline constexpr const char* kSynergySet = "synergy_set";
inline constexpr const char* kFirstOrderSynergies = "first_order_synergies";  ///< of joint velocities
inline constexpr const char* kGrasp = "grasp";
inline constexpr const char* kGraspSearch = "grasp_search";  ///< trials and rejections of one group's search
inline constexpr const char* kPath = "path";
inline constexpr const char* kPlanRuns = "plan_runs";  ///< every run of one plan command, those that failed too
inline constexpr const char* kVerdicts = "verification";

/// A decoded object with its id.
template <typename T>
struct Stored {
  std::string id;
  storage::Record record;
  T value;
};

/// Provenance of something this program makes now.
storage::Provenance provenance(const std::string& command, std::vector<std::string> inputs,
                               const std::vector<std::filesystem::path>& files, const nlohmann::json& parameters,
                               std::uint64_t seed);

/// The index entries of motions by source and recording: of several with the same label "source" and the same id, the
/// newest. Only recordings whose id occurs more than once are read.
struct MotionEntries {
  std::vector<storage::IndexEntry> newest;  ///< in the order in which the first of each was stored
  int superseded = 0;                       ///< older ones left out
};
MotionEntries newest_motions(const storage::Store& store, const char* kind);

/// The same, all read. Motions by source and recording: of several with the same label "source" and the same id, the
/// newest.
struct Motions {
  std::vector<Stored<Demonstration>> newest;  ///< in the order in which the first of each was stored
  int superseded = 0;                         ///< older ones left out
};
/// Tells how many recordings are left out, when there are any.
void say_superseded(const Console& console, int superseded);
Motions recordings(const storage::Store& store);
/// The same of recordings mapped to a robot hand.
Motions hand_motions(const storage::Store& store);

/// "newest" is what was made last, also when it had been made before (Store::list_as_produced).
std::optional<std::string> newest(const storage::Store& store, const char* kind);
/// The objects of a kind that were made from any of the given objects, the newest first.
std::vector<storage::IndexEntry> made_from(const storage::Store& store, const char* kind,
                                           const std::set<std::string>& inputs);
/// A synergy set of either order. Throws InputError when the object is none.
Stored<SynergySet> synergies_of(const storage::Store& store, const std::string& id);
/// The pre-grasp (or the pool of all groups), then the groups.
std::vector<const SynergyGroup*> groups_in_order(const SynergySet& set);
/// The newest synergy set. Throws InputError saying which command makes one when there is none.
Stored<SynergySet> newest_synergies(const storage::Store& store);
/// The grasp-phase group of that name. Throws InputError when the set has none: a grasp names its group.
const SynergyGroup& group_named(const SynergySet& set, const std::string& name);

/// Robot, scene and object of one arm's grasps, by what their files hold, not by how their paths are spelt.
struct WorldKey {
  std::string object;
  std::string arm;              ///< of a robot with several arms
  std::set<std::string> files;  ///< SHA-256 of each
  bool operator==(const WorldKey&) const = default;
};
/// The arm in a recorded "FILE#ARM"; empty: none.
std::string recorded_arm(const std::string& robot);
/// Of a stored grasp, search or path: one for each arm that it is about.
std::vector<WorldKey> world_keys(const storage::Record& record);
/// The one of that arm. Throws InputError when the object is not about it.
WorldKey key_of_arm(const storage::Record& record, const std::string& arm);

/// Grasps made from a synergy set with the given robot, scene and object.
std::vector<Stored<Grasp>> grasps_of(const storage::Store& store, const std::string& synergies, const WorldKey& world);

/// Robot, scene and object that a stored object was made with.
nlohmann::json parameters_of(const storage::Record& record);

/// The field of a path that names the grasp of an arm after the first one, whose field is "goal_grasp".
std::string goal_grasp_field(const std::string& arm);

/// A text field; empty when the record has none of that name.
std::string text_field(const storage::Record& record, const std::string& name);

/// Appends a line about this run: command, what it stored, date, wall and CPU seconds, host, threads.
class RunLog {
 public:
  RunLog(const storage::Store& store, std::string command, int threads);
  /// Seconds of CPU used by this process since construction.
  double cpu_seconds() const;
  /// `more` is merged into the line.
  void finish(const std::vector<std::string>& stored, const nlohmann::json& more) const;
  void finish(const std::vector<std::string>& stored) const;

 private:
  const storage::Store& store_;
  std::string command_;
  int threads_;
  double wall_begin_;
  double cpu_begin_;
};

/// Number of threads to use: the option, or all cores when it is 0.
int thread_count(int option);

}  // namespace opponens::cli
