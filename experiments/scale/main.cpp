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

bool equal(const analysis::Coverage& a, const analysis::Coverage& b) {
  return a.in_sample == b.in_sample && a.held_out == b.held_out && a.nominal == b.nominal &&
         a.interval->low == b.interval->low && a.interval->high == b.interval->high;
}

bool equal(const analysis::GroupReport& a, const analysis::GroupReport& b) {
  bool same = a.samples == b.samples && a.k == b.k && a.cumulative_variance == b.cumulative_variance &&
              equal(a.coverage.full, b.coverage.full) && equal(a.coverage.kept, b.coverage.kept) &&
              a.intervals.size() == b.intervals.size();
  for (std::size_t i = 0; same && i < a.intervals.size(); ++i) {
    same = a.intervals[i].low == b.intervals[i].low && a.intervals[i].high == b.intervals[i].high;
  }
  return same;
}

/// Every number of both: the synergies by the hash that they would be stored under.
bool equal(const analysis::Analysis& a, const analysis::Analysis& b) {
  bool same = storage::content_hash(storage::encode(a.synergies, {})) ==
              storage::content_hash(storage::encode(b.synergies, {}));
  same = same && a.groups.size() == b.groups.size() && a.transitions.size() == b.transitions.size();
  for (std::size_t i = 0; same && i < a.groups.size(); ++i) same = equal(a.groups[i], b.groups[i]);
  for (std::size_t i = 0; same && i < a.transitions.size(); ++i) {
    const auto& x = a.transitions[i];
    const auto& y = b.transitions[i];
    same = x.likeness.index == y.likeness.index && x.changepoint.index == y.changepoint.index &&
           x.likeness.time_s == y.likeness.time_s;
  }
  return same;
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
  memory.back().q_h(0, 0) += 1e-9;  // what the comparison is worth: one sample of all, a little off
  const auto other = analysis::analyze(memory, {});
  return streamed && direct && other && equal(*streamed, *direct) && !equal(*streamed, *other);
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
