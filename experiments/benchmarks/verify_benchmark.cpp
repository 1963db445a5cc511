// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Proving recorded paths (shelf_paths.json: record_paths.py on a store of `opponens demo` and `opponens plan`; the
// laboratory's by the same on its robot). One round checks all paths of the file; counters are per path. Building the
// trees of a robot and a scene is timed by itself. OPPONENS_BENCHMARK_PATHS: only so many paths of each file.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <nlohmann/json.hpp>

#include "robot/load_robot.hpp"
#include "verify/paths.hpp"

namespace {

using namespace opponens;

struct Recorded {
  std::vector<JointPath> paths;
  std::vector<verify::PathClaim> claims;
};

Recorded read_paths(const std::string& file, const robot::RobotModel& robot, const std::string& object) {
  std::ifstream stream(file);
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
    claim.object = object;
    for (const auto& link : one.at("contact_links")) claim.contact_links.insert(link.get<std::string>());
    recorded.paths.push_back(path);
    recorded.claims.push_back(claim);
  }
  return recorded;
}

struct Setting {
  robot::RobotModel robot;
  robot::Scene scene = robot::load_scene(OPPONENS_SOURCE_DIR "/models/scenes/bottle_shelf.yaml");
};

Setting ours() {
  return {robot::RobotModel(robot::load_robot(OPPONENS_SOURCE_DIR "/models/ur5_allegro/ur5_allegro_right.yaml"))};
}

Setting laboratory() {
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  return {robot::RobotModel(
      robot::load_robot(OPPONENS_SOURCE_DIR "/tests/data/robots/paper_lab_ur5_allegro_right_visual.yaml"))};
}

bool absent(benchmark::State& state, bool shared) {
  if (!shared || std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) return false;
  state.SkipWithError("no shared data");
  return true;
}

void build(benchmark::State& state, Setting (*make)(), bool shared) {
  if (absent(state, shared)) return;
  const Setting setting = make();
  for (auto _ : state) verify::PathChecker checker(setting.robot, setting.scene);
}

void check(benchmark::State& state, Setting (*make)(), const char* file, bool shared) {
  if (absent(state, shared)) return;
  const Setting setting = make();
  const Recorded recorded =
      read_paths(std::string(OPPONENS_SOURCE_DIR "/experiments/benchmarks/") + file, setting.robot, "bottle");
  verify::PathChecker checker(setting.robot, setting.scene);
  double configurations = 0.0;
  double distances = 0.0;
  double failed = 0.0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < recorded.paths.size(); ++i) {
      const auto verdict = checker.check(recorded.paths[i], recorded.claims[i]);
      configurations += static_cast<double>(verdict.checked);
      distances += static_cast<double>(verdict.distances);
      failed += verdict.ok ? 0.0 : 1.0;
      if (!verdict.ok) state.SetLabel("path " + std::to_string(i) + ": " + verdict.reasons.front());
    }
  }
  const auto paths = static_cast<double>(recorded.paths.size());
  using benchmark::Counter;
  state.counters["paths"] = paths;
  state.counters["failed"] = Counter(failed, Counter::kAvgIterations);
  state.counters["configurations"] = Counter(configurations / paths, Counter::kAvgIterations);
  state.counters["distances"] = Counter(distances / paths, Counter::kAvgIterations);
  state.counters["cpu_s_per_path"] = Counter(paths, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

BENCHMARK_CAPTURE(build, ours, ours, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, laboratory_meshes, laboratory, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(check, ours, ours, "shelf_paths.json", false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(check, laboratory_meshes, laboratory, "laboratory_shelf_paths.json", true)
    ->Unit(benchmark::kMillisecond);

}  // namespace
