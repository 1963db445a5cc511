// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/declare.hpp"

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "motion/syn_planner.hpp"

namespace opponens::cli {
namespace {

template <typename Options>
void add_world(CLI::App& app, Options& options, const char* robot_help, const char* objects_help) {
  app.add_option("--robot", options.robot, robot_help)->capture_default_str();
  app.add_option("--scene", options.scene, "Scene YAML")->capture_default_str();
  app.add_option("--object", options.objects, objects_help)->allow_extra_args(false);
}

/// What a grasp is held to, and the errors that it is tried under.
void declare_grasp_limits(CLI::App& app, GraspOptions& options) {
  app.add_option("--mu", options.mu, "Friction coefficient")->check(CLI::Range(0.0, 10.0))->capture_default_str();
  app.add_option("--edges", options.edges, "Edges of a friction cone")->check(CLI::Range(3, 64))->capture_default_str();
  app.add_option("--slack-bound", options.slack_bound, "Of a grasp that is called along the synergies, rad")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  app.add_option("--max-penetration", options.max_penetration, "Of the hand into the object, m")
      ->check(CLI::Range(1e-5, 0.01))
      ->capture_default_str();
  app.add_option("--clearance", options.clearance, "Of the pre-grasp from the object, m")
      ->check(CLI::Range(0.0, 0.2))
      ->capture_default_str();
  app.add_option("--noise-position", options.noise.position, "Error of the object's position, m (one sigma per axis)")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--noise-angle", options.noise.angle, "Error of the object's turn, rad (one sigma per axis)")
      ->check(CLI::Range(0.0, 3.2))
      ->capture_default_str();
  app.add_option("--noise-friction", options.noise.friction, "Error of the friction coefficient (one sigma)")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--noise-samples", options.noise.samples, "Disturbed cases per grasp; 0: no quality under errors")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
}

}  // namespace

void add_store(CLI::App& app, Common& common) {
  app.add_option("--store", common.store, "Directory of the store")->required();
}

void add_seed(CLI::App& app, std::uint64_t& seed) {
  app.add_option("--seed", seed, "Seed of every random choice; equal seeds give equal bytes")->capture_default_str();
}

void add_threads(CLI::App& app, int& threads) {
  app.add_option("--threads", threads, "Threads; 0 = all cores. Results do not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

void declare_grasp(CLI::App& app, GraspOptions& options) {
  add_store(app, options.common);
  add_world(app, options, "robot.yaml; FILE#ARM: an arm of a robot with several",
            "Body of the scene to grasp; default: the one the scene names");
  add_seed(app, options.common.seed);
  add_threads(app, options.common.threads);
  app.add_option("--group", options.group, "Synergy group, or all")->capture_default_str();
  app.add_option("--count", options.count, "Grasps to keep per group")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI::Option* const most =
      app.add_option("--max-trials", options.max_trials, "Trials per group at most, when fewer than --count are found")
          ->check(CLI::Range(1, 100000000))
          ->capture_default_str();
  CLI::Option* const least =
      app.add_option("--min-trials", options.min_trials, "Trials per group at least, though --count are found sooner")
          ->check(CLI::Range(0, 100000000))
          ->capture_default_str();
  app.add_option("--trials", options.trials, "Exactly so many trials per group")
      ->check(CLI::Range(1, 100000000))
      ->excludes(most)
      ->excludes(least);
  CLI::Option* const improvements =
      app.add_option("--improvements", options.improvements,
                     "Closings from neighbouring poses of each of the best grasps; 0: none")
          ->check(CLI::Range(0, 1000000))
          ->capture_default_str();
  app.add_flag("--free-joints", options.free_joints, "Search over all joints of the hand, not along synergies");
  CLI::Option* const tips =
      app.add_flag("--tips", options.tips, "Precision grasps: the finger tips alone touch, optimised for --goal")
          ->excludes(improvements)
          ->excludes(least);
  app.add_option("--goal", options.goal, "What precision grasps are optimised for: min_weight (l*) or epsilon")
      ->check(CLI::IsMember({"min_weight", "epsilon"}))
      ->needs(tips)
      ->capture_default_str();
  app.add_option("--import", options.import, "Check and store the grasps of this file; no search")->excludes(tips);
  declare_grasp_limits(app, options);
}

void declare_plan(CLI::App& app, PlanOptions& options) {
  add_store(app, options.common);
  add_world(
      app, options, "robot.yaml; FILE#ARM: an arm of a robot with several; FILE#both: both at once",
      "Body of the scene to grasp; with FILE#both of both arms, or of one as ARM=NAME (may be repeated); default: "
      "the one the scene names");
  add_seed(app, options.common.seed);
  add_threads(app, options.common.threads);
  app.add_option("--planner", options.planner,
                 "synergy (Algorithms 2-4), rrtconnect (multi-goal baseline), or an ablation: synergy_sampling (boxes "
                 "for targets only), pregrasp_box (no boxes for the goals' trees)")
      ->check(CLI::IsMember(std::vector<std::string>(motion::kVariantNames.begin(), motion::kVariantNames.end())))
      ->capture_default_str();
  app.add_option("--pairs", options.pairs, "Goals of both arms at once (FILE#both): pairs of grasps kept at most")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--runs", options.runs, "Queries with seeds seed, seed+1, ...")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--time-limit", options.time_limit,
                 "Seconds per run, more than 0; left out: no limit (the search stops on counts)")
      ->check(CLI::Range(0.0, 1e6))
      ->check([](const std::string& seconds) {
        return std::stod(seconds) > 0.0 ? "" : "no search finds anything in 0 s; for no limit leave the option out";
      });
  app.add_option("--max-checks", options.max_checks, "Configurations checked per run, asked once a pass; 0 = no limit")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--step", options.step, "Longest step of a tree, rad, over all joints")
      ->check(CLI::Range(1e-3, 100.0))
      ->capture_default_str();
  app.add_option("--resolution", options.resolution, "Spacing of checked configurations, rad, over all joints")
      ->check(CLI::Range(1e-4, 100.0))
      ->capture_default_str();
  const auto own = [&app](const std::string& of, const std::string& what, GroupLengths& lengths, double least) {
    app.add_option("--arm-" + of, lengths.arm, what + " over the arm's joints alone, rad; default: none of its own")
        ->check(CLI::Range(least, 100.0));
    app.add_option("--hand-" + of, lengths.hand, what + " over the hand's joints alone, rad; default: none of its own")
        ->check(CLI::Range(least, 100.0));
  };
  own("step", "Longest step", options.own_step, 1e-3);
  own("resolution", "Spacing of checked configurations", options.own_resolution, 1e-4);
  app.add_flag("--diagnose", options.diagnose, "Tell of runs that succeeded, too, what the search met");
  app.add_flag("--smooth", options.smooth, "Smooth the whole path after the shortcuts; some tenths of a second a path");
  app.add_option("--speed", options.speed, "Share of the joints' velocity and acceleration limits that is used")
      ->check(CLI::Range(0.001, 1.0))
      ->capture_default_str();
}

void declare_check(CLI::App& app, CheckOptions& options) {
  app.add_option("--robot", options.robot, "robot.yaml; an arm without a hand is enough")->capture_default_str();
  app.add_option("--scene", options.scene,
                 "Scene (docs/scene_files.md); default with --requests: the file beside each, scene... for request...");
  app.add_option("--configs", options.configs, "CSV with one configuration a line; its header names the joints");
  app.add_option("--requests", options.requests, "MoveIt or MotionBenchMaker motion plan requests");
  app.add_option(
         "--base", options.base,
         "Pose of the robot's root in the scene, x,y,z or x,y,z,roll,pitch,yaw (m, rad); default: the scene's own")
      ->delimiter(',');
}

void declare_quality(CLI::App& app, QualityOptions& options) {
  app.add_option("FILE", options.file, "Contact sets, JSON (docs/cli.md)")->required();
  app.add_option("--norm", options.norm,
                 "Total normal force 1, each contact's normal force 1, or both, in place of the file's")
      ->check(CLI::IsMember({"L1", "Linf", "both"}));
  app.add_option("--model", options.model, "Contact model, in place of the file's")
      ->check(CLI::IsMember({"frictionless", "point_with_friction", "soft_finger"}));
  app.add_option("--cone", options.cone, "Pyramids of edges, or the exact round cones, in place of the file's")
      ->check(CLI::IsMember({"pyramid", "quadratic"}));
  app.add_option("--unit", options.unit, "An edge's normal force or its force has length 1, in place of the file's")
      ->check(CLI::IsMember({"normal", "force"}));
  app.add_option("--edges", options.edges, "Edges of a pyramid, in place of the file's")->check(CLI::Range(3, 1024));
  app.add_option("--mu", options.mu, "Friction coefficient of all contacts, in place of the file's")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--gap", options.quadratic_gap, "Relative gap at which epsilon of quadratic cones is good enough")
      ->check(CLI::Range(1e-6, 0.5))
      ->capture_default_str();
  app.add_option("--at-least", options.at_least, "Give up on a set, state below_incumbent, once epsilon is less");
  app.add_flag("!--no-volume", options.volume, "Leave out the volume, which costs most of the time");
  app.add_flag("--certificate", options.certificate, "Print the certificates, not only whether there are any");
}

}  // namespace opponens::cli
