// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/recording_source.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <utility>

#include "core/require.hpp"

namespace opponens::analysis {
namespace {

constexpr std::size_t kBatchRecordings = 256;
constexpr Eigen::Index kBatchValues = 4'000'000;  // 32 MB of samples; two batches are in memory

/// Consecutive recordings with the place of the first.
struct Batch {
  std::size_t begin = 0;
  std::vector<Demonstration> recordings;
};

using Work = std::function<bool(std::size_t, const Demonstration&)>;

bool work_on(const Batch& batch, int threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> good{true};
  const auto worker = [&] {
    for (std::size_t i = next++; i < batch.recordings.size(); i = next++) {
      if (!work(batch.begin + i, batch.recordings[i])) good = false;
    }
  };
  std::vector<std::future<void>> others;
  for (int i = 1; i < threads; ++i) others.push_back(std::async(std::launch::async, worker));
  worker();
  for (auto& other : others) other.get();
  return good;
}

}  // namespace

RecordingSource source_of(const std::vector<Demonstration>& demonstrations) {
  return {demonstrations.size(), [&demonstrations](std::size_t i) { return demonstrations.at(i); }};
}

bool for_each_recording(const RecordingSource& source, const std::vector<std::size_t>& indices, const Reading& reading,
                        const Work& work) {
  require(reading.threads >= 1, "for_each_recording: threads must be >= 1");
  const auto read_from = [&](std::size_t begin) {
    Batch batch{begin, {}};
    Eigen::Index values = 0;
    for (std::size_t i = begin; i < indices.size() && i < begin + kBatchRecordings && values < kBatchValues; ++i) {
      if (reading.progress) reading.progress(i, indices.size());
      batch.recordings.push_back(source.read(indices[i]));
      values += batch.recordings.back().q_h.size();
    }
    return batch;
  };
  const auto policy = reading.threads > 1 ? std::launch::async : std::launch::deferred;
  Batch batch = read_from(0);
  while (!batch.recordings.empty()) {
    auto done = std::async(policy, [&] { return work_on(batch, std::max(1, reading.threads - 1), work); });
    Batch following = read_from(batch.begin + batch.recordings.size());
    if (!done.get()) return false;
    batch = std::move(following);
  }
  return true;
}

}  // namespace opponens::analysis
