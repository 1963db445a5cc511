// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: which files below a PATH hold recordings.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "storage/readers/source.hpp"

namespace opponens::storage {

/// A file with one recording or several, and what is known of it without opening it.
struct RecordingFile {
  std::filesystem::path file;
  std::string id;
  std::map<std::string, std::string> facts;       ///< index columns, or parts of the file's name
  std::map<std::string, std::string> companions;  ///< as FileReport
  std::filesystem::path index;                    ///< that lists it; empty: found by its name
  long line = 0;                                  ///< in the index
};

/// In the order of the index, or sorted by name. Throws InputError when there is none.
std::vector<RecordingFile> find_recordings(const std::filesystem::path& path, const SourceDescription& source);

}  // namespace opponens::storage
