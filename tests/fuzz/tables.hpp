// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <string>

#include "core/require.hpp"
#include "storage/readers/interpret.hpp"

namespace opponens::storage::fuzz {

/// Reads text as a source says; the bytes may be anything, an InputError is the only exception allowed, and whatever is
/// accepted has to be a recording: finite, of the right shape, time increasing.
inline void read(const std::string& bytes, const SourceDescription& source) {
  const RecordingFile file{"fuzz.txt", "fuzz", {{"object", "cup"}}, {}, {}, 0};
  Survey survey{std::vector<Pair>(source.channels.size(), Pair{0.0, 1000.0}), {}};
  for (std::size_t i = 0; i < source.channels.size(); ++i) survey.kept.push_back(i);
  try {
    read_text_tables(bytes, file.file, source, [&](Table&& table) {
      interpret(table, file, "", source, survey, [&](Recording&& recording) {
        const Demonstration& motion = recording.demonstration;
        const Eigen::Index rows = motion.q_h.rows();
        bool good = rows >= 2 && motion.time.size() == rows && motion.q_h.allFinite() && motion.time.allFinite() &&
                    motion.q_h.cols() == static_cast<Eigen::Index>(source.channels.size());
        for (Eigen::Index i = 1; i < rows && good; ++i) good = motion.time[i] > motion.time[i - 1];
        if (!good) std::abort();
      });
    });
  } catch (const InputError&) {
  }
}

}  // namespace opponens::storage::fuzz
