// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// What checking a path costs, by samples at the planner's spacing, by the planner's continuous check, and by verify:
// the free part of recorded paths (shelf_paths.json, laboratory_shelf_paths.json), one segment after the other. One
// round checks all paths of a file; counters are per path.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "motion/continuous_check.hpp"
#include "motion/edge_check.hpp"
#include "recorded_paths.hpp"
#include "robot/collision.hpp"

namespace {

using namespace opponens;
using namespace opponens::benchmarks;

struct Case {
  Setting (*make)();
  const char* file;
  bool shared;
};
const Case kOurs{ours, "shelf_paths.json", false};
const Case kLaboratory{laboratory, "laboratory_shelf_paths.json", true};

/// check(from, to, configurations) of each segment returns whether it passes.
template <typename Check>
void check_paths(benchmark::State& state, const Recorded& recorded, const Check& check) {
  std::int64_t configurations = 0;
  std::int64_t failed = 0;
  for (auto _ : state) {
    configurations = 0;
    failed = 0;
    for (std::size_t i = 0; i < recorded.paths.size(); ++i) {
      const Eigen::MatrixXd& waypoints = recorded.paths[i].waypoints;
      bool passes = true;
      for (Eigen::Index row = 1; row <= recorded.claims[i].closing_from && passes; ++row) {
        passes = check(waypoints.row(row - 1).transpose(), waypoints.row(row).transpose(), configurations);
      }
      failed += passes ? 0 : 1;
    }
  }
  const auto paths = static_cast<double>(recorded.paths.size());
  using benchmark::Counter;
  state.counters["paths"] = paths;
  state.counters["failed"] = static_cast<double>(failed);
  state.counters["configurations"] = static_cast<double>(configurations) / paths;
  state.counters["cpu_s_per_path"] = Counter(paths, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

template <typename Use>
void with_case(benchmark::State& state, const Case& chosen, const Use& use) {
  if (chosen.shared && !std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) {
    state.SkipWithError("no shared data");
    return;
  }
  const Setting setting = chosen.make();
  use(setting, read_paths(chosen.file, setting.robot, "bottle"), robot::CollisionChecker(setting.robot, setting.scene));
}

void samples(benchmark::State& state, const Case& chosen, double resolution) {
  with_case(
      state, chosen, [&](const Setting& setting, const Recorded& recorded, const robot::CollisionChecker& checker) {
        const motion::World world = motion::make_world(checker, setting.robot, resolution);
        check_paths(state, recorded, [&](const Eigen::VectorXd& from, const Eigen::VectorXd& to, std::int64_t& count) {
          return !world.first_invalid(from, to, count);
        });
      });
}

void continuous(benchmark::State& state, const Case& chosen) {
  with_case(
      state, chosen, [&](const Setting& setting, const Recorded& recorded, const robot::CollisionChecker& checker) {
        const motion::ContinuousCheck check(checker, setting.robot);
        check_paths(state, recorded, [&](const Eigen::VectorXd& from, const Eigen::VectorXd& to, std::int64_t& count) {
          return !check.first_near(from, to, count);
        });
      });
}

void verified(benchmark::State& state, const Case& chosen) {
  with_case(state, chosen, [&](const Setting& setting, Recorded recorded, const robot::CollisionChecker&) {
    for (std::size_t i = 0; i < recorded.paths.size(); ++i) {  // without the closing segment
      recorded.paths[i].waypoints.conservativeResize(recorded.claims[i].closing_from + 1, Eigen::NoChange);
      recorded.claims[i].grasp = recorded.claims[i].goal;
    }
    verify::PathChecker checker(setting.robot, setting.scene);
    double failed = 0.0;
    for (auto _ : state) {
      failed = 0.0;
      for (std::size_t i = 0; i < recorded.paths.size(); ++i) {
        failed += checker.check(recorded.paths[i], recorded.claims[i]).ok ? 0.0 : 1.0;
      }
    }
    const auto paths = static_cast<double>(recorded.paths.size());
    using benchmark::Counter;
    state.counters["paths"] = paths;
    state.counters["failed"] = failed;
    state.counters["cpu_s_per_path"] = Counter(paths, Counter::kIsIterationInvariantRate | Counter::kInvert);
  });
}

BENCHMARK_CAPTURE(samples, ours_0_02_rad, kOurs, 0.02)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(samples, ours_0_002_rad, kOurs, 0.002)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(continuous, ours, kOurs)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(verified, ours, kOurs)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(samples, laboratory_meshes_0_02_rad, kLaboratory, 0.02)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(samples, laboratory_meshes_0_002_rad, kLaboratory, 0.002)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(continuous, laboratory_meshes, kLaboratory)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(verified, laboratory_meshes, kLaboratory)->Unit(benchmark::kMillisecond);

}  // namespace
