// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Speed of the statistics beside a plain sum over the same array: experiments/benchmarks/README.md.
#include <benchmark/benchmark.h>

#include "analysis/statistics.hpp"
#include "core/rng.hpp"

namespace opponens {
namespace {

const Eigen::MatrixXd& samples() {
  static const Eigen::MatrixXd result = [] {
    Rng rng = stream(1, "benchmark/samples");
    Eigen::MatrixXd q(2000000, 16);
    for (double& value : q.reshaped()) value = rng.uniform();
    return q;
  }();
  return result;
}

void set_rates(benchmark::State& state) {
  state.SetBytesProcessed(state.iterations() * samples().size() * static_cast<std::int64_t>(sizeof(double)));
  state.SetItemsProcessed(state.iterations() * samples().rows());
}

void plain_sum(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(samples().sum());
  set_rates(state);
}
BENCHMARK(plain_sum)->Unit(benchmark::kMillisecond);

void covariance(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(analysis::moments(samples()));
  set_rates(state);
}
BENCHMARK(covariance)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace opponens
