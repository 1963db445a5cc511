// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: from the numbers of a file to recordings.

#include <string>
#include <vector>

#include "storage/readers/find_recordings.hpp"
#include "storage/readers/source.hpp"
#include "storage/readers/table.hpp"

namespace opponens::storage {

/// What had to be found in all recordings before any can be read.
struct Survey {
  std::vector<Pair> raw;          ///< [channels] least and largest count, where a channel's calibration needs it
  std::vector<std::size_t> kept;  ///< channels that are stored
};

/// Makes the recordings of one table: one, or one per trial when the source splits where time goes back.
void interpret(const Table& table, const RecordingFile& file, const std::string& sha256,
               const SourceDescription& source, const Survey& survey, const TakeRecording& take);

/// Labels that the facts of file and table give. Throws InputError when a fact is missing.
std::map<std::string, std::string> labels_of(const Table& table, const RecordingFile& file,
                                             const SourceDescription& source);

/// Time of each row in s, from the table's columns, the rate, or, for postures, the row's number.
Eigen::VectorXd times_of(const Table& table, const RecordingFile& file, const SourceDescription& source);

}  // namespace opponens::storage
