// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Writes a store of many simulated hand motions (README.md); with --check, analyses it from the store and from memory.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "analysis/analyze.hpp"
#include "analysis/simulate.hpp"
#include "core/rng.hpp"
#include "storage/codec.hpp"
#include "storage/store.hpp"

namespace opponens {
namespace {

constexpr int kJoints = 16;
constexpr int kFamilies = 4;
constexpr std::size_t kBatch = 512;  // recordings in one commit

struct Options {
  std::filesystem::path store;
  std::size_t recordings = 100000;
  int samples = 1000;
  std::uint64_t seed = 1;
  bool check = false;
};

Eigen::VectorXd normals(Rng& rng) {
  Eigen::VectorXd result(kJoints);
  for (double& value : result) value = rng.normal();
  return result;
}

/// A hand opens along one direction and closes to its family's posture; both vary from recording to recording.
Demonstration recording(const Options& options, std::size_t number) {
  const std::string family = std::to_string(1 + number % kFamilies);
  Rng common = stream(options.seed, "scale/opening");
  const Eigen::VectorXd opening = 0.4 * normals(common);
  Rng of_family = stream(options.seed, "scale/family/" + family);
  const Eigen::VectorXd closing = 0.5 * normals(of_family);
  Rng rng = stream(options.seed, "scale/recording/" + std::to_string(number));
  const Eigen::VectorXd first = opening + 0.1 * normals(rng);
  const Eigen::VectorXd second = closing + 0.1 * normals(rng);
  const double change = rng.uniform(0.35, 0.65);
  Demonstration result;
  result.id = "scale_" + std::to_string(number);
  result.origin = Origin::simulated;
  result.labels = {{"subject", "simulated-1"}, {"family", family}, {"kind", "grasp"}};
  result.time = Eigen::VectorXd::LinSpaced(options.samples, 0.0, 2.0);
  result.known_transition = 2.0 * change;
  for (int j = 0; j < kJoints; ++j) result.joint_names.push_back("joint_" + std::to_string(j));
  result.q_h.resize(options.samples, kJoints);
  for (int i = 0; i < options.samples; ++i) {
    const double u = static_cast<double>(i) / (options.samples - 1);
    const double opened = analysis::minimum_jerk(u / change);
    const double closed = analysis::minimum_jerk((u - change) / (1.0 - change));
    for (int j = 0; j < kJoints; ++j) result.q_h(i, j) = opened * first[j] + closed * second[j] + 0.01 * rng.normal();
  }
  return result;
}

void write_store(const Options& options) {
  storage::Store store(options.store, true);
  storage::Provenance provenance;
  provenance.command = "experiments/scale";
  provenance.parameters = R"({"hand": "none: written by experiments/scale"})";
  provenance.seed = options.seed;
  for (std::size_t begin = 0; begin < options.recordings; begin += kBatch) {
    std::vector<storage::Record> records;
    for (std::size_t i = begin; i < std::min(begin + kBatch, options.recordings); ++i) {
      records.push_back(storage::encode(recording(options, i), provenance));
      records.back().kind = "hand_demonstration";
    }
    store.commit(records);
    std::fprintf(stderr, "\r%zu of %zu recordings", begin + records.size(), options.recordings);
  }
  std::fprintf(stderr, "\n");
}

bool equal(const analysis::Analysis& a, const analysis::Analysis& b) {
  bool same = a.groups.size() == b.groups.size() && a.transitions.size() == b.transitions.size();
  for (std::size_t i = 0; same && i < a.groups.size(); ++i) {
    const auto& x = a.groups[i];
    const auto& y = b.groups[i];
    same = x.cumulative_variance == y.cumulative_variance && x.samples == y.samples &&
           x.coverage.full.in_sample == y.coverage.full.in_sample &&
           x.coverage.kept.held_out == y.coverage.kept.held_out &&
           x.coverage.full.interval->low == y.coverage.full.interval->low &&
           x.intervals.front().low == y.intervals.front().low;
  }
  for (std::size_t i = 0; same && i < a.transitions.size(); ++i) {
    same = a.transitions[i].likeness.index == b.transitions[i].likeness.index;
  }
  return same && a.synergies.pre_grasp.basis.axes == b.synergies.pre_grasp.basis.axes;
}

/// From the store on two threads, and from memory on one: every number must be the same.
bool check(const Options& options) {
  const storage::Store store(options.store, false);
  const auto entries = store.list("hand_demonstration");
  const analysis::RecordingSource source{
      entries.size(), [&](std::size_t i) { return storage::decode_demonstration(store.read(entries[i].id)); }};
  const auto streamed = analysis::analyze(source, {}, {2, {}});
  std::vector<Demonstration> memory;
  for (std::size_t i = 0; i < options.recordings; ++i) memory.push_back(recording(options, i));
  const auto direct = analysis::analyze(memory, {});
  memory.pop_back();
  const auto fewer = analysis::analyze(memory, {});
  return streamed && direct && fewer && equal(*streamed, *direct) && !equal(*streamed, *fewer);
}

}  // namespace
}  // namespace opponens

int main(int argc, char** argv) {
  opponens::Options options;
  CLI::App app("Writes a store of simulated hand motions of 16 joints");
  app.add_option("STORE", options.store, "Directory of the store")->required();
  app.add_option("--recordings", options.recordings, "Number of recordings")->check(CLI::PositiveNumber);
  app.add_option("--samples", options.samples, "Samples of each")->check(CLI::Range(50, 1000000));
  app.add_option("--seed", options.seed, "Seed");
  app.add_flag("--check", options.check, "Then analyse it from the store and from memory, and compare");
  CLI11_PARSE(app, argc, argv);
  opponens::write_store(options);
  if (!options.check) return 0;
  const bool same = opponens::check(options);
  std::printf("analysis from the store and from memory: %s\n", same ? "equal" : "DIFFERENT");
  return same ? 0 : 1;
}
