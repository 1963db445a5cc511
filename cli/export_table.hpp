// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "storage/record.hpp"
#include "storage/robomimic.hpp"

namespace opponens::cli {

/// A recording, a mapped recording, or a path (as executed: `motion` with its times) as one movement.
storage::Episode episode_of(const std::string& id, const storage::Record& record);

/// Text of a CSV cell, quoted only where it has to be.
std::string cell(const std::string& text);
/// With 17 digits, so that it comes back bit for bit.
void append_number(std::string& text, double value);

/// A folder of CSV files: movements as one file each (time_s, then the joints in rad), synergy sets as one file per
/// group, and index.csv with a line for each file. Numbers have 17 digits, so that they come back bit for bit.
class TableFolder {
 public:
  /// Makes the folder. Throws InputError when it is there and not empty.
  explicit TableFolder(std::filesystem::path folder);
  void add(const std::string& id, const storage::Record& record);
  /// A file of its own; about: its columns of the index, among them id, kind and name where it has them.
  void write(const std::string& file, const std::string& text, std::map<std::string, std::string> about);
  void finish();  ///< writes index.csv

 private:
  std::filesystem::path folder_;
  std::vector<std::map<std::string, std::string>> index_;
  std::set<std::string> columns_;  // of the index, beside those that every file has
};

}  // namespace opponens::cli
