// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/demonstration.hpp"

namespace opponens::analysis {

/// Recordings that are read when they are needed, so that together they need not fit in memory.
struct RecordingSource {
  std::size_t count = 0;
  /// The i-th recording, the same whenever it is asked for. Called from one thread; what it throws ends the reading.
  std::function<Demonstration(std::size_t)> read;
};

/// The recordings of a vector, which must outlive the source.
RecordingSource source_of(const std::vector<Demonstration>& demonstrations);

/// Called from the thread that reads, before each recording; what it throws ends the reading.
using ReadProgress = std::function<void(std::size_t done, std::size_t total)>;

struct Reading {
  int threads = 1;        ///< one reads, the others work; with one, in turn
  ReadProgress progress;  ///< may be empty
};

/// Reads the recordings of the given indices in their order, a batch of bounded size ahead of the work. work(place,
/// recording): place in `indices`; runs on several threads at once, so it writes to places of its own. Work that
/// returns false ends the reading after its batch, and the result is false. Batches do not depend on the number of
/// threads.
bool for_each_recording(const RecordingSource& source, const std::vector<std::size_t>& indices, const Reading& reading,
                        const std::function<bool(std::size_t, const Demonstration&)>& work);

}  // namespace opponens::analysis
