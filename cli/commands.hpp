// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.hpp"
#include "core/grasp.hpp"

namespace opponens::cli {

inline constexpr int kDone = 0;
inline constexpr int kNoAnswer = 1;
inline constexpr int kInvalid = 2;
inline constexpr int kStoreDamaged = 3;
inline constexpr int kInterrupted = 130;

/// Options of every command.
struct Common {
  std::filesystem::path store{};
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all cores
};

struct SimulateOptions {
  Common common{};
  int repetitions = 12;
};
struct IngestOptions {
  Common common{};
  std::vector<std::filesystem::path> paths{};
  std::string source{};
  bool dry_run = false;
};
struct RetargetOptions {
  Common common{};
  std::string hand = "models/ur5_allegro/allegro_right.yaml";
  std::string urdf{};  ///< in place of the one that the hand.yaml names; empty: that one
  std::string mapping = "paper";
  std::optional<double> hand_length{};  ///< m, of wearers whose recordings do not tell it
};
struct AnalyzeOptions {
  Common common{};
  double alpha = 0.05;
  double beta = 0.05;
  std::string transition{};    ///< likeness | changepoint; empty: likeness
  double resolution = 0.0087;  ///< rad, of the sensors
  int min_window = 0;          ///< samples; 0: effective dof + 1
  std::string box_root = "n";
  std::string group_by = "family";
  int order = 0;
  std::string space = "rad";
  std::string phase = "both";  ///< both | none
  std::string input{};         ///< hand | glove; empty: hand when there is any
};
struct CompareOptions {
  Common common{};
  std::vector<std::string> ids{};  ///< two synergy sets; left out: the newest
  std::filesystem::path with{};    ///< store of the second; empty: the same store
};
struct GraspOptions {
  Common common{};
  std::string robot = "models/ur5_allegro/ur5_allegro_right.yaml";
  std::string scene = "models/scenes/bottle_shelf.yaml";
  std::vector<std::string> objects{};  ///< to grasp: one, as the scene calls it; empty: the scene's own
  std::string group = "all";
  int count = 5;
  int max_trials = 2000;
  int min_trials = 128;
  int improvements = 15;
  std::optional<int> trials{};      ///< exactly so many, in place of both bounds
  double mu = 0.5;                  ///< friction coefficient
  int edges = 8;                    ///< of a friction cone
  double slack_bound = 0.3;         ///< rad, of a synergy grasp
  double max_penetration = 0.001;   ///< m, of the hand into the object
  double clearance = 0.01;          ///< m, of the pre-grasp from the object
  bool free_joints = false;         ///< search over all joints, not along synergies
  bool tips = false;                ///< precision grasps: finger tips alone touch
  std::string goal = "min_weight";  ///< of precision grasps: min_weight or epsilon
  GraspNoise noise{};               ///< samples 0: no quality under errors
  std::string import{};             ///< file of grasps made elsewhere; empty: search
};
/// Lengths of their own for the joints of arm and hand, rad.
struct GroupLengths {
  std::optional<double> arm{};
  std::optional<double> hand{};
};
struct PlanOptions {
  Common common{};
  std::string robot = "models/ur5_allegro/ur5_allegro_right.yaml";
  std::string scene = "models/scenes/bottle_shelf.yaml";
  std::vector<std::string> objects{};  ///< NAME, or ARM=NAME; empty: the scene's own
  int pairs = 64;                      ///< goals of two arms together that are kept at most
  std::string planner = "synergy";
  int runs = 1;
  std::optional<double> time_limit{};  ///< s
  std::int64_t max_checks = 0;         ///< 0: none
  double step = 0.4;                   ///< rad
  double resolution = 0.02;            ///< rad
  GroupLengths own_step{};             ///< of arm and hand
  GroupLengths own_resolution{};
  bool diagnose = false;  ///< tell of successes too what the search met
  double speed = 0.5;     ///< share of the joints' velocity and acceleration limits
  bool smooth = false;    ///< the whole path by least squares, after the shortcuts
};
struct VerifyOptions {
  Common common{};
  double clearance = 0.0005;       ///< m
  double max_penetration = 0.001;  ///< m
};
struct ReportOptions {
  Common common{};
  std::filesystem::path out = "report.html";
  std::filesystem::path svg{};  ///< folder for the pictures; empty: none are written
};
struct ShowOptions {
  Common common{};
  std::string id{};    ///< empty: list everything
  std::string kind{};  ///< list this kind only
};
struct ExportOptions {
  Common common{};
  std::vector<std::string> ids{};  ///< empty: all
  std::string kind{};              ///< only this kind
  std::filesystem::path single_file{};
  std::string format{};
  std::filesystem::path out{};
  double period = 0.0;  ///< s, of a trajectory's points; 0: its knots
};
struct MergeOptions {
  Common common{};
  std::vector<std::filesystem::path> stores{};
};
struct RepairOptions {
  Common common{};
  bool dry_run = false;
};
struct StaleOptions {
  Common common{};
  std::vector<std::filesystem::path> files{};  ///< folders with outside files
};
struct CheckOptions {
  std::string robot = "models/ur5_allegro/ur5_allegro_right.yaml";
  std::string scene{};                            ///< empty: the file beside each request
  std::vector<double> base{};                     ///< x, y, z m (and roll, pitch, yaw rad); empty: the scene's own
  std::filesystem::path configs{};                ///< CSV
  std::vector<std::filesystem::path> requests{};  ///< MoveIt motion plan requests
};
struct QualityOptions {
  std::filesystem::path file{};
  std::string norm{};                ///< L1, Linf or both; empty, here and below: the file's
  std::string model{};               ///< of the contacts
  std::string cone{};                ///< pyramid or quadratic
  std::string unit{};                ///< normal or force
  std::optional<int> edges{};        ///< of a pyramid
  std::optional<double> mu{};        ///< of all contacts
  bool volume = true;                ///< costs a hull by qhull
  bool certificate = false;          ///< print it, not only whether there is one
  double quadratic_gap = 1e-3;       ///< relative, of quadratic cones' epsilon
  std::optional<double> at_least{};  ///< give up below this epsilon
};
struct MeshOptions {
  std::vector<std::string> files{};
  std::string unit = "m";
  bool intersections = false;
  std::filesystem::path repair{};  ///< STL to write; empty: only check
  int simplify = 0;                ///< triangles wanted; 0: all
};
struct RobotOptions {
  std::string file{};  ///< robot.yaml, hand.yaml or URDF
  std::uint64_t seed = 1;
  int samples = 1000;
  std::vector<std::filesystem::path> packages{};  ///< folders searched for package://NAME, of a URDF
  bool skeleton = false;
  bool propose_contacts = false;
  bool allowed_collisions = false;
  std::filesystem::path picture{};  ///< SVG to write; empty: none
};
struct DemoOptions {
  std::filesystem::path out = "demo";
  std::uint64_t seed = 1;
  int threads = 0;
};

// Each runs one command and returns its exit code; errors are exceptions (see main.cpp).
int simulate(const SimulateOptions& options, const Console& console);
int ingest(const IngestOptions& options, const Console& console);
int ingest_single_files(const IngestOptions& options, const Console& console);  ///< ingest without a source YAML
int retarget(const RetargetOptions& options, const Console& console);
int analyze(const AnalyzeOptions& options, const Console& console);
int compare(const CompareOptions& options, const Console& console);
int grasp(const GraspOptions& options, const Console& console);
int plan(const PlanOptions& options, const Console& console);
int verify(const VerifyOptions& options, const Console& console);
int report(const ReportOptions& options, const Console& console);
int show(const ShowOptions& options, const Console& console);
int why(const ShowOptions& options, const Console& console);
int export_objects(const ExportOptions& options, const Console& console);
int merge(const MergeOptions& options, const Console& console);
int repair(const RepairOptions& options, const Console& console);
int stale(const StaleOptions& options, const Console& console);
int check(const CheckOptions& options, const Console& console);
int quality(const QualityOptions& options, const Console& console);
int mesh(const MeshOptions& options, const Console& console);
int robot(const RobotOptions& options, const Console& console);
int demo(const DemoOptions& options, const Console& console);

}  // namespace opponens::cli
