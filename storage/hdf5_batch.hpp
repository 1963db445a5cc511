// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the HDF5 part of a batch file, read by libhdf5. Needed for files without contents (written by
// others, or before there were any); it knows everything that docs/file_format.md allows.

#include <memory>
#include <string>
#include <vector>

#include "storage/contents.hpp"
#include "storage/posix_file.hpp"
#include "storage/record.hpp"

namespace opponens::storage {

/// The whole file in memory. Its bytes have to be known to be good: a truncated or flipped file can crash libhdf5.
/// Any thread may use it: it takes libhdf5's lock.
class Hdf5Batch {
 public:
  explicit Hdf5Batch(const ReadOnlyFile& file);
  ~Hdf5Batch();
  std::size_t size() const;
  ObjectHead head(std::size_t position) const;
  Record read(std::size_t position, const std::string& id) const;  ///< checks the content hash

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace opponens::storage
