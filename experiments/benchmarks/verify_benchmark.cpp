// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Proving recorded paths (shelf_paths.json: record_paths.py on a store of `opponens demo` and `opponens plan`; the
// laboratory's by the same on its robot). One round checks all paths of the file; counters are per path. Building the
// trees of a robot and a scene is timed by itself. OPPONENS_BENCHMARK_PATHS: only so many paths of each file.
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "recorded_paths.hpp"
#include "verify/paths.hpp"

namespace {

using namespace opponens;
using namespace opponens::benchmarks;

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
  const Recorded recorded = read_paths(file, setting.robot, "bottle");
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
