// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// MotionBenchMaker's UR5 problems, arm only: our planner and OMPL's RRTConnect on the same checker, each at the best of
// the given ranges, found on other seeds. One line of CSV per run on stdout, a summary on stderr.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <ompl/util/Console.h>
#include <CLI/CLI.hpp>

#include "core/require.hpp"
#include "experiments/table2_planning/cpu_time.hpp"
#include "experiments/table2_planning/ompl_baselines.hpp"
#include "motion/edge_check.hpp"
#include "motion/grown_scene.hpp"
#include "motion/syn_planner.hpp"
#include "robot/load_robot.hpp"
#include "robot/motion_request.hpp"
#include "verify/paths.hpp"

namespace opponens {
namespace {

namespace fs = std::filesystem;

constexpr double kMargin = 0.00075;        // m, as `opponens plan` keeps
constexpr double kResolution = 0.02;       // rad
constexpr std::int64_t kBudget = 1000000;  // configurations per run

struct Options {
  std::string robot;
  std::vector<std::string> requests;
  std::vector<double> ranges{0.2, 0.4, 0.8, 1.6, 3.2};
  int tuning_seeds = 3;
  int seeds = 10;
};

/// A request with its world.
struct Problem {
  std::string name;
  robot::Scene scene;
  std::unique_ptr<robot::CollisionChecker> checker;
  motion::World world;
  bool margin = true;  ///< kept from the scene: start and goals do
  table2::OmplQuery query;
  bool ends_free = false;  ///< start and at least one goal, inside the limits
};

/// MotionBenchMaker keeps the scene of request0001.yaml in scene0001.yaml beside it, and says nothing of the base
/// (docs/scene_files.md).
Problem load_problem(const robot::RobotModel& robot, const fs::path& request_file) {
  std::string scene_name = request_file.filename().string();
  const std::size_t at = scene_name.find("request");
  if (at == std::string::npos) throw InputError(request_file.string() + ": has no 'request' in its name");
  scene_name.replace(at, 7, "scene");
  const robot::MotionRequest request = robot::load_motion_request(request_file);
  Problem problem;
  problem.name = request_file.parent_path().filename().string() + "/" + request.name;
  problem.scene = robot::load_scene(request_file.parent_path() / scene_name);
  problem.scene.X_WR =
      Eigen::Translation3d(0, 0, 0.9144) * Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitZ());
  const Eigen::VectorXd zero = robot.clip(Eigen::VectorXd::Zero(robot.dof()));
  problem.query = {robot::complete(robot, request.start, zero).q,
                   {},
                   robot.joint_names(),
                   robot.lower(),
                   robot.upper(),
                   robot.weights()};
  for (const robot::JointState& goal : request.goals) {
    problem.query.goals.push_back(robot::complete(robot, goal, problem.query.start).q);
  }
  return problem;
}

bool ends_free(const robot::RobotModel& robot, const Problem& problem) {
  const auto valid = [&](const Eigen::VectorXd& q) { return robot.within_limits(q) && problem.checker->free(q); };
  return valid(problem.query.start) && std::any_of(problem.query.goals.begin(), problem.query.goals.end(), valid);
}

/// Bodies grown by the margin where start and a goal keep it, else as they are.
void make_world(const robot::RobotModel& robot, Problem& problem) {
  problem.checker = std::make_unique<robot::CollisionChecker>(robot, motion::grown_scene(problem.scene, kMargin));
  problem.ends_free = ends_free(robot, problem);
  if (!problem.ends_free) {
    problem.margin = false;
    problem.checker = std::make_unique<robot::CollisionChecker>(robot, problem.scene);
    problem.ends_free = ends_free(robot, problem);
  }
  problem.world = motion::make_world(*problem.checker, robot, kResolution);
}

struct Run {
  PlanResult planned;
  double cpu_seconds = 0.0;
};

constexpr const char* kPlanners[] = {"synergy", "rrtconnect", "ompl_rrtconnect"};

Run run_once(const std::string& planner, const Problem& problem, double range, std::uint64_t seed) {
  const table2::OmplQuery& query = problem.query;
  if (planner == "ompl_rrtconnect") {
    auto outcome = table2::plan_with_ompl(table2::OmplPlanner::rrtconnect, query, problem.world, range, kBudget, seed);
    return {std::move(outcome.planned), outcome.cpu_seconds};
  }
  motion::PlanQuery ours{{query.start, {}, -1}, {}, query.joint_names, query.lower, query.upper, query.weights};
  for (std::size_t i = 0; i < query.goals.size(); ++i) ours.goals.push_back({query.goals[i], {}, static_cast<int>(i)});
  motion::PlannerSettings settings;
  settings.variant = planner == "synergy" ? motion::Variant::synergy : motion::Variant::rrtconnect;
  settings.step = range;
  settings.max_checks = kBudget;
  settings.max_iterations = std::numeric_limits<std::int64_t>::max();
  Run run;
  const double begin = table2::thread_cpu_seconds();
  run.planned = motion::plan(ours, problem.world, settings, seed);
  run.cpu_seconds = table2::thread_cpu_seconds() - begin;
  return run;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// The range with the most solved runs, and among those with the least mean of checks, over all problems.
double best_range(const std::string& planner, const std::vector<Problem>& problems, const Options& options) {
  std::pair<int, double> best{-1, 0.0};
  double range_of_best = options.ranges.front();
  for (const double range : options.ranges) {
    int solved = 0;
    double checks = 0.0;
    for (const Problem& problem : problems) {
      if (!problem.ends_free) continue;
      for (int i = 0; i < options.tuning_seeds; ++i) {
        const Run run = run_once(planner, problem, range, 1000001 + static_cast<std::uint64_t>(i));
        solved += run.planned.status == PlanStatus::solved ? 1 : 0;
        checks += static_cast<double>(run.planned.collision_checks);
      }
    }
    std::fprintf(stderr, "%s, range %g: %d solved, %.0f checks in all\n", planner.c_str(), range, solved, checks);
    if (std::pair(solved, -checks) > best) {
      best = {solved, -checks};
      range_of_best = range;
    }
  }
  return range_of_best;
}

bool verified(verify::PathChecker& checker, const Problem& problem, const PlanResult& planned) {
  verify::PathClaim claim;
  claim.start = problem.query.start;
  claim.goal = problem.query.goals[static_cast<std::size_t>(planned.goal)];
  verify::PathCheckSettings settings;
  if (!problem.margin) settings.proof.clearance = 0.0;
  return checker.check(planned.path, claim, settings).ok;
}

struct Tally {
  int runs = 0, solved = 0, proven = 0;
  std::vector<double> milliseconds, checks;
};

void run(const Options& options) {
  const robot::RobotModel robot(robot::load_robot(options.robot));
  std::vector<Problem> problems;
  for (const std::string& file : options.requests) {
    problems.push_back(load_problem(robot, file));
    make_world(robot, problems.back());
  }
  const auto open = std::count_if(problems.begin(), problems.end(), [](const Problem& p) { return p.ends_free; });
  const auto margin = std::count_if(problems.begin(), problems.end(), [](const Problem& p) { return p.margin; });
  std::fprintf(stderr, "%zu requests, %td with free ends, %td of them with a margin of %g mm\n", problems.size(), open,
               margin, 1e3 * kMargin);
  std::map<std::string, double> ranges;
  for (const char* planner : kPlanners) ranges[planner] = best_range(planner, problems, options);
  std::map<std::string, Tally> tallies;
  std::printf("problem,planner,range_rad,seed,status,cpu_s,checks,length_rad,proven\n");
  for (const Problem& problem : problems) {
    if (!problem.ends_free) continue;
    verify::PathChecker checker(robot, problem.scene);
    for (int i = 1; i <= options.seeds; ++i) {
      for (const char* planner : kPlanners) {
        const Run run = run_once(planner, problem, ranges[planner], static_cast<std::uint64_t>(i));
        const bool solved = run.planned.status == PlanStatus::solved;
        const bool proven = solved && verified(checker, problem, run.planned);
        Tally& tally = tallies[planner];
        ++tally.runs;
        tally.solved += solved ? 1 : 0;
        tally.proven += proven ? 1 : 0;
        tally.milliseconds.push_back(1e3 * run.cpu_seconds);
        tally.checks.push_back(static_cast<double>(run.planned.collision_checks));
        std::printf("%s,%s,%g,%d,%s,%.6g,%lld,%.6g,%d\n", problem.name.c_str(), planner, ranges[planner], i,
                    status_name(run.planned.status).c_str(), run.cpu_seconds,
                    static_cast<long long>(run.planned.collision_checks), run.planned.length, proven ? 1 : 0);
      }
    }
  }
  for (const auto& [planner, tally] : tallies) {
    double total = 0.0;
    for (const double one : tally.milliseconds) total += one;
    std::fprintf(stderr,
                 "%s: range %g, solved %d of %d, proven %d; CPU median %.2f ms, mean %.2f ms; checks median %.0f\n",
                 planner.c_str(), ranges[planner], tally.solved, tally.runs, tally.proven, median(tally.milliseconds),
                 total / tally.runs, median(tally.checks));
  }
}

}  // namespace
}  // namespace opponens

int main(int count, char** arguments) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);  // it calls setting a seed more than once an error
  CLI::App app{"motion_bench_maker: MotionBenchMaker's UR5 problems beside OMPL"};
  opponens::Options options;
  app.add_option("--robot", options.robot)->required();
  app.add_option("--requests", options.requests)->required();
  app.add_option("--ranges", options.ranges, "rad")->delimiter(',');
  app.add_option("--tuning-seeds", options.tuning_seeds);
  app.add_option("--seeds", options.seeds);
  CLI11_PARSE(app, count, arguments);
  try {
    opponens::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "motion_bench_maker: %s\n", error.what());
    return 2;
  }
  return 0;
}
