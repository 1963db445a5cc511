// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: work on files that can bring down the library that reads them.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace opponens::storage {

struct ChildLimits {
  std::uint64_t memory = std::uint64_t{2} << 30;  ///< B, beyond what this process has. Not under AddressSanitizer
  std::uint64_t output = std::uint64_t{2} << 30;  ///< B that may come back
  double seconds = 60.0;                          ///< of wall clock and of CPU
  int memory_fill = 0;                            ///< byte that memory holds before it is written; 0: as it comes
  std::function<bool()> interrupted{};            ///< asked while the child works: yes ends it (ReadingInterrupted)
};

/// Runs work in a child process and returns what it returned there; an InputError or StorageError thrown there is an
/// InputError here. The child writes no files and says nothing on stdout or stderr. Throws InputError "file: the reader
/// of KIND files ..." when the child dies, takes too long, or sends back what cannot be.
/// Work whose answer depends on memory that it has not written gives two answers under two memory_fills.
/// The caller must be single-threaded, or work must need no lock that another thread may hold.
std::string run_limited(const std::filesystem::path& file, const std::string& kind,
                        const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace opponens::storage
