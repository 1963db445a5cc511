// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The nearest vertex of a forest in 22 dimensions, beside OMPL's structures in the same run; and a whole plan in a
// world whose checks cost nothing, which is what the planner itself costs.
#include <benchmark/benchmark.h>
#include <ompl/datastructures/NearestNeighborsGNAT.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>

#include <memory>
#include <vector>

#include "core/rng.hpp"
#include "motion/joint_metric.hpp"
#include "motion/sample_forest.hpp"
#include "motion/syn_planner.hpp"

namespace {

using namespace opponens;

constexpr int kDimension = 22;
constexpr std::size_t kQueries = 256;

/// A tree as a planner grows it: steps of at most 0.4 rad towards uniform targets. Arm +-pi, hand 1.5 rad wide.
struct Cloud {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(kDimension);
  std::vector<Eigen::VectorXd> vertices;
  std::vector<Eigen::VectorXd> queries;

  static Eigen::VectorXd uniform(Rng& rng) {
    Eigen::VectorXd q(kDimension);
    for (int j = 0; j < kDimension; ++j) q[j] = j < 6 ? rng.uniform(-3.1416, 3.1416) : rng.uniform(0.0, 1.5);
    return q;
  }

  explicit Cloud(int size) {
    Rng rng = stream(1, "benchmark/nearest");
    motion::SampleForest forest(weights);
    vertices.push_back(uniform(rng));
    forest.add_root(vertices.back());
    while (forest.size() < size) {
      const Eigen::VectorXd target = uniform(rng);
      const auto near = forest.nearest(target);
      const Eigen::VectorXd q_near = forest.vertex(near.vertex);
      vertices.emplace_back(q_near + 0.4 / near.distance * (target - q_near));
      forest.add(vertices.back(), near.vertex);
    }
    for (std::size_t i = 0; i < kQueries; ++i) queries.push_back(uniform(rng));
  }
};

void ours(benchmark::State& state) {
  const Cloud cloud(static_cast<int>(state.range(0)));
  motion::SampleForest forest(cloud.weights);
  for (const auto& q : cloud.vertices) forest.add_root(q);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(forest.nearest(cloud.queries[i++ % kQueries]));
}

/// OMPL's, over configurations as an OMPL planner keeps them: pointers to values.
template <template <typename> class Structure>
void ompl_structure(benchmark::State& state) {
  const Cloud cloud(static_cast<int>(state.range(0)));
  Structure<const double*> structure;
  structure.setDistanceFunction([&](const double* const& a, const double* const& b) {
    double sum = 0.0;
    for (int j = 0; j < kDimension; ++j) sum += cloud.weights[j] * (b[j] - a[j]) * (b[j] - a[j]);
    return std::sqrt(sum);
  });
  for (const auto& q : cloud.vertices) structure.add(q.data());
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(structure.nearest(cloud.queries[i++ % kQueries].data()));
}

template <typename T>
using Gnat = ompl::NearestNeighborsGNAT<T>;
template <typename T>
using Linear = ompl::NearestNeighborsLinear<T>;

/// A search that never ends, without checks: time per configuration that a usual spacing would have checked, which is
/// to be small beside a check of 8 us.
void plan_without_checks(benchmark::State& state) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kDimension);
  Eigen::VectorXd lower = Eigen::VectorXd::Zero(kDimension);
  Eigen::VectorXd upper = Eigen::VectorXd::Constant(kDimension, 1.5);
  lower.head(6).setConstant(-3.1416);
  upper.head(6).setConstant(3.1416);
  motion::World world;
  world.free = [](const Eigen::MatrixXd& batch, std::int64_t&) {
    return std::vector<bool>(static_cast<std::size_t>(batch.rows()), true);
  };
  // A wall: nothing passes joint 0 at 0.
  world.first_invalid = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                            std::int64_t& checks) -> std::optional<double> {
    checks += static_cast<std::int64_t>(motion::distance(ones, a, b) / 0.02) + 1;
    return (a[0] < 0.0) != (b[0] < 0.0) ? std::optional(0.5) : std::nullopt;
  };
  SynergyBox box;
  box.center = Eigen::VectorXd::Constant(16, 0.7);
  box.scale = Eigen::VectorXd::Ones(16);
  box.axes = Eigen::MatrixXd::Identity(16, 4);
  box.half_width = Eigen::VectorXd::Constant(4, 0.6);
  const PlanningGroup hand{"hand", std::vector<std::string>(16), 6, 16};
  Eigen::VectorXd start = Eigen::VectorXd::Constant(kDimension, 0.5);
  Eigen::VectorXd goal = start;
  start[0] = -2.0;
  motion::PlannerSettings settings;
  settings.max_iterations = state.range(0);
  std::int64_t checks = 0;
  for (auto _ : state) {
    checks += motion::plan(start, box, {{goal, box, 0}}, std::vector<std::string>(kDimension), hand, lower, upper, ones,
                           world, settings, 1)
                  .collision_checks;
  }
  state.counters["us_per_check"] =
      benchmark::Counter(1e-6 * static_cast<double>(checks), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["checks"] = static_cast<double>(checks) / static_cast<double>(state.iterations());
}

BENCHMARK(ours)->Name("nearest/ours")->Arg(100)->Arg(1000)->Arg(10000)->Arg(100000)->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(ompl_structure, Gnat)
    ->Name("nearest/ompl_gnat")
    ->Arg(100)
    ->Arg(1000)
    ->Arg(10000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(ompl_structure, Linear)
    ->Name("nearest/ompl_linear")
    ->Arg(100)
    ->Arg(1000)
    ->Arg(10000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(plan_without_checks)->Arg(100)->Arg(2000)->Unit(benchmark::kMillisecond);

}  // namespace
