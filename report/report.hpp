// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/demonstration.hpp"
#include "core/grasp.hpp"
#include "core/path.hpp"
#include "core/synergies.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::report {

// What a report shows, as plain values. Every part may be missing: its section then says so in a sentence. All text is
// taken as hostile and escaped. Nothing here may differ between runs with equal inputs, except what is in RunPart.

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Recordings of one group.
struct RecordingGroup {
  std::string name;
  int recordings = 0;
  int samples = 0;
  double mean_duration = 0.0;  ///< s
  Interval duration;           ///< s, shortest and longest
  bool free_motion = false;    ///< free finger movements, which are no group of grasps
};

struct DemonstrationPart {
  std::string grouped_by;              ///< label that forms the groups: "family", "object", ...
  int simulated = 0;                   ///< recordings with origin simulated; > 0 puts the banner on the page
  std::vector<RecordingGroup> groups;  ///< one row each
  std::string source;                  ///< a sentence: where the recordings came from
  std::string mapping;                 ///< how they came to the robot hand, e.g. "paper"; empty: not retargeted
  std::optional<double> tip_residual;  ///< m, root mean square fingertip residual of the mapping
  std::vector<std::pair<std::string, double>> tip_residuals;   ///< m, the same per fingertip
  std::vector<std::pair<std::string, double>> clamped_shares;  ///< share of samples held at a limit, joints that were
  std::optional<Demonstration> example;                        ///< drawn as joint traces
};

/// Both cost curves of one recording. S candidate splits.
struct TransitionCurves {
  std::string demonstration;            ///< id
  Eigen::VectorXd time;                 ///< [S] s
  Eigen::VectorXd log_likeness;         ///< [S] log L(Q-, Q+), Eq. (1)
  Eigen::VectorXd changepoint_cost;     ///< [S] n1 log|S1 + r^2 I| + n2 log|S2 + r^2 I|; empty: not computed
  std::optional<double> likeness_time;  ///< s, minimum found
  std::optional<double> changepoint_time;
  std::optional<double> known_time;  ///< s, ground truth of a simulated movement
};

/// Transition of one recording as a fraction of its duration, by each rule.
struct TransitionFractions {
  std::string demonstration;
  std::optional<double> likeness;
  std::optional<double> changepoint;
  std::optional<double> known;
};

struct TransitionPart {
  std::string method;  ///< the rule in force: "likeness" or "changepoint"; empty: no split was made
  std::optional<TransitionCurves> example;
  std::vector<TransitionCurves> others;  ///< drawn after the example
  std::string chosen_by;                 ///< a sentence: by which rule these recordings were chosen
  std::vector<TransitionFractions> all;  ///< one per recording
};

/// How much of the samples a box holds, beside what it promises (fractions).
struct Coverage {
  double nominal = 0.95;
  double in_sample = 0.0;
  std::optional<double> held_out;  ///< one cluster left out at a time
  std::optional<Interval>
      interval;  ///< of held_out (of in_sample when there is no held_out); nullopt: too few clusters
};

struct SynergyItem {
  SynergyGroup group;
  int samples = 0;
  std::string cluster;                  ///< what is left out and resampled: "subject" or "recording"
  Eigen::VectorXd cumulative_low;       ///< [n] fraction, interval of the cumulative variance; empty: too few clusters
  Eigen::VectorXd cumulative_high;      ///< [n]
  std::optional<Coverage> full_box;     ///< of the n-box
  std::optional<Coverage> reduced_box;  ///< of the first k coordinates
};

struct SynergyPart {
  std::vector<std::string> joint_names;  ///< [n]
  std::string grouped_by;                ///< Table 1 is compared only when this is "family"
  std::string box_root;                  ///< "n", "k" or "literal"
  double interval_level = 0.95;          ///< of all intervals
  std::vector<SynergyItem> groups;       ///< pre-grasp first
};

struct GraspItem {
  std::string id;
  Grasp grasp;
  std::optional<bool> verified;  ///< of `verify`, nullopt: not yet checked
};

/// Trials rejected for reasons that a person would do the same about.
struct RejectionCause {
  std::string name;
  std::string advice;  ///< what may help; empty where nothing is known to
  std::int64_t trials = 0;
};

/// What all searches of one group came to, or all of another kind: with free joints, or of imported grasps.
struct GraspSearch {
  std::string group;     ///< or what was searched: "free joints", "imported"
  bool of_group = true;  ///< otherwise its grasps belong to the groups that they are nearest to
  std::int64_t found = 0;
  std::int64_t trials = 0;
  std::map<std::string, std::int64_t> rejected;  ///< reason -> trials; "reason: bodies" names what was in the way
  std::vector<RejectionCause> causes;            ///< the same trials by cause, the commonest first; empty: by reason
};

struct GraspPart {
  std::string arm;                    ///< whose grasps these are; empty: only one arm grasps
  std::string object;                 ///< body of the scene
  std::string grouped_by;             ///< label that formed the groups: "family", ...; empty: unknown
  std::vector<GraspItem> items;       ///< best first
  std::vector<GraspSearch> searches;  ///< one per group, those that gave no grasp too, in the order of the page
  int max_pictures = 5;               ///< of each group; further ones are only in the table
};

struct HumanLikeness {
  std::optional<double> value;  ///< percent; nullopt: the hand does not move, or there is no reference
  std::string reference;        ///< named beside every value, e.g. "free-finger recordings (simulated)"
};

/// A grasp that a path ends at.
struct ReachedGrasp {
  std::string arm;  ///< empty: only one arm grasps
  std::string id;
};

/// One planning run: a row of Table 2 is the mean over the runs of a planner.
struct PlanRun {
  std::string planner;   ///< "synergy" or "rrtconnect"
  std::string settings;  ///< a few words, e.g. "step 0.4 rad"; equal for the runs of one planner
  std::uint64_t seed = 0;
  PlanResult result;                          ///< path may be empty: it is not drawn from here
  std::optional<double> shortened_length;     ///< rad, joint metric, after the shortcuts; nullopt: unknown or unsolved
  std::vector<HumanLikeness> human_likeness;  ///< the first is the one of Table 2
  std::vector<ReachedGrasp> reached;          ///< one for each arm; empty: none
};

struct PathPart {
  std::string id;
  std::vector<PlanRun> runs;          ///< solved or not; the first is the run whose path is shown, when there is one
  std::vector<ReachedGrasp> reached;  ///< one for each arm; empty: unknown
  JointPath path;                     ///< shortcut and closing segment included; rows from start to grasp
  Eigen::VectorXd times;              ///< [N] s; empty: not timed
  int pregrasp = -1;                  ///< row of the pre-grasp, where the closing segment starts; -1: none
  int pictures = 4;                   ///< snapshots per view, start and end included
};

struct Verdict {
  std::string id;
  std::string kind;  ///< "grasp", "path", ...
  bool passed = false;
  std::string reason;  ///< of a failure
};

struct VerifyPart {
  std::vector<std::string> checks;  ///< sentences: what was checked, and how finely
  std::vector<Verdict> verdicts;
  int checked = 0;                        ///< objects, those without a row included
  std::optional<double> worst_clearance;  ///< m, over all paths
  std::string worst_pair;                 ///< the two bodies there; may be empty
};

/// A stored object behind the path, as `why` prints it.
struct ProvenanceItem {
  std::string id;
  std::string kind;
  std::string name;
  std::string command;
  std::vector<std::string> inputs;           ///< ids
  std::map<std::string, std::string> files;  ///< outside input file -> SHA-256
  std::string parameters;                    ///< JSON text
  std::uint64_t seed = 0;
  std::string program_version;
};

/// What differs from run to run. Stands between the comments run-log begin and run-log end, and nowhere else.
struct RunPart {
  /// One command as the log has it.
  struct Command {
    std::string name;
    std::string date;  ///< UTC
    double wall_seconds = 0.0;
    double cpu_seconds = 0.0;
    int threads = 1;
    std::string host;
  };
  std::string log;  ///< text, one line per run
  /// Planner -> mean s of CPU per run, shortcuts and loading not included: Table 2's second column.
  std::map<std::string, double> planning_seconds;
  std::vector<Command> commands;  ///< in the order of the log
};

/// Another arm's hand, where several grasp.
struct FurtherHand {
  robot::RobotModel hand;  ///< as ReportInput::hand
  GraspPart grasps;
};

struct ReportInput {
  std::string title = "Human-like grasping motions";
  std::string program_version;
  std::optional<DemonstrationPart> demonstrations;
  std::optional<TransitionPart> transitions;
  std::optional<SynergyPart> synergies;
  std::optional<robot::RobotModel> hand;   ///< rooted at the palm (robot::load_hand); missing: no drawings of hands
  std::optional<robot::RobotModel> robot;  ///< missing: no snapshots
  std::optional<robot::Scene> scene;       ///< missing: no grasp pictures, no snapshots
  std::optional<GraspPart> grasps;         ///< of `hand`
  std::vector<FurtherHand> further_hands;  ///< where several arms grasp at once
  std::optional<PathPart> path;
  std::optional<VerifyPart> verification;
  std::vector<ProvenanceItem> provenance;  ///< any order
  std::optional<RunPart> run;
};

inline constexpr const char* kRunLogBegin = "<!-- run-log begin -->";
inline constexpr const char* kRunLogEnd = "<!-- run-log end -->";

/// A picture of the page as a file of its own.
struct SvgFile {
  std::string name;     ///< "synergies_1.svg": anchor of its section, number in it
  std::string content;  ///< complete SVG document with its colours (light theme)
};

/// Every picture of the page that render_report made, in its order.
std::vector<SvgFile> svg_files(const std::string& page);

/// One self-contained HTML page (no script, nothing loaded from elsewhere). Equal input gives equal bytes. Throws
/// std::invalid_argument naming the field when sizes inside a part do not agree.
std::string render_report(const ReportInput& input);

}  // namespace opponens::report
