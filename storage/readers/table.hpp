// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the numbers of one recording as they lie in a file, before anything is made of them.

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "storage/readers/source.hpp"

namespace opponens::storage {

/// Rows of numbers: first the columns of TimeSource (none when there are no columns or cells of time), then one per
/// channel of the source.
struct Table {
  std::string part;                          ///< which part of the file it is; empty: all of it
  std::map<std::string, std::string> facts;  ///< what the file says of these rows: cell labels, run, group
  std::size_t width = 0;
  std::vector<double> values;  ///< [rows x width], row by row
  long first_line = 0;         ///< of a text: where row 0 stands, the others below it. 0: no lines
  std::size_t rows() const { return width == 0 ? 0 : values.size() / width; }
};
using TakeTable = std::function<void(Table&&)>;

/// Columns of time in a Table of this source.
std::size_t time_width(const SourceDescription& source);

/// Delimited text (TableFormat::csv, text). bytes: of the file, whose name is for messages.
void read_text_tables(const std::string& bytes, const std::filesystem::path& file, const SourceDescription& source,
                      const TakeTable& take);

/// MATLAB v5 and HDF5 files of other origin, in this process: call them in a child (run_limited).
std::vector<Table> read_matlab_tables(const std::filesystem::path& file, const SourceDescription& source);
std::vector<Table> read_hdf5_tables(const std::filesystem::path& file, const SourceDescription& source);

/// Tables as bytes that say how long each part is and end with a hash of all before, and back. from_bytes throws
/// InputError "file: what" when the bytes are not of that form or do not fit the source.
std::string to_bytes(const std::vector<Table>& tables);
std::vector<Table> from_bytes(const std::string& bytes, const std::filesystem::path& file,
                              const SourceDescription& source);

}  // namespace opponens::storage
