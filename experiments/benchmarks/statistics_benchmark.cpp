// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Speed of the statistics beside a plain sum over the same array: experiments/benchmarks/README.md.
#include <numeric>

#include <benchmark/benchmark.h>

#include "analysis/phase_transition.hpp"
#include "analysis/simulate.hpp"
#include "analysis/statistics.hpp"
#include "core/rng.hpp"

namespace opponens {
namespace {

/// 256 MB: larger than any cache.
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

void sum_in_order(benchmark::State& state) {
  const double* begin = samples().data();
  for (auto _ : state) benchmark::DoNotOptimize(std::accumulate(begin, begin + samples().size(), 0.0));
  set_rates(state);
}
BENCHMARK(sum_in_order)->Unit(benchmark::kMillisecond)->UseRealTime();

void sum_vectorised(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(samples().sum());
  set_rates(state);
}
BENCHMARK(sum_vectorised)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Argument: threads.
void covariance(benchmark::State& state) {
  const auto threads = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(analysis::moments(samples(), 1.0, threads));
  set_rates(state);
}
BENCHMARK(covariance)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void covariance_of_rows(benchmark::State& state) {
  static const analysis::RowMajorSamples rows = samples();
  for (auto _ : state) benchmark::DoNotOptimize(analysis::moments_of_rows(rows));
  set_rates(state);
}
BENCHMARK(covariance_of_rows)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Eigen's matrix product on chunks that stay in the cache, centred on the first row.
void covariance_eigen_chunks(benchmark::State& state) {
  constexpr Eigen::Index kChunk = 512;
  const Eigen::MatrixXd& q = samples();
  for (auto _ : state) {
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(16, 16);
    Eigen::RowVectorXd sums = Eigen::RowVectorXd::Zero(16);
    Eigen::MatrixXd centred(kChunk, 16);
    for (Eigen::Index row = 0; row < q.rows(); row += kChunk) {
      const Eigen::Index rows = std::min(kChunk, q.rows() - row);
      centred.topRows(rows) = q.middleRows(row, rows).rowwise() - q.row(0);
      sums += centred.topRows(rows).colwise().sum();
      products.selfadjointView<Eigen::Lower>().rankUpdate(centred.topRows(rows).transpose());
    }
    benchmark::DoNotOptimize(products);
    benchmark::DoNotOptimize(sums);
  }
  set_rates(state);
}
BENCHMARK(covariance_eigen_chunks)->Unit(benchmark::kMillisecond)->UseRealTime();

/// 84 samples of 16 joints: two minimum-jerk legs with noise, both curves of all splits.
void likeness_curve(benchmark::State& state) {
  Rng rng = stream(1, "benchmark/recording");
  Demonstration recording;
  recording.id = "benchmark";
  recording.time = Eigen::VectorXd::LinSpaced(84, 0.0, 1.66);
  recording.q_h.resize(84, 16);
  for (Eigen::Index j = 0; j < 16; ++j) {
    recording.joint_names.push_back("joint " + std::to_string(j));
    const double opening = rng.normal();
    const double closing = rng.normal();
    for (int i = 0; i < 84; ++i) {
      recording.q_h(i, j) = opening * analysis::minimum_jerk(i / 40.0) +
                            closing * analysis::minimum_jerk((i - 40.0) / 43.0) + 0.02 * rng.normal();
    }
  }
  for (auto _ : state) benchmark::DoNotOptimize(analysis::transition_curves(recording, {}));
}
BENCHMARK(likeness_curve)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace opponens
