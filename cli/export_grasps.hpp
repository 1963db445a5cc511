// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/export_table.hpp"
#include "cli/json.hpp"

namespace opponens::cli {

/// The three tables of all grasps of an export: grasps.csv (a row a grasp: the document's values, nested ones with dots
/// and numbers from 0 in their columns' names; empty where a grasp lacks one), contacts.csv (a row a contact) and
/// wrenches.csv (a row an edge wrench).
class GraspTables {
 public:
  /// document: of GraspDocuments.
  void add(const Json& document);
  /// Writes nothing when no grasp was added.
  void write_to(TableFolder& folder) const;

 private:
  using Row = std::vector<std::pair<std::string, std::string>>;  ///< column, cell

  std::vector<Row> grasps_;
  std::string contacts_;
  std::string wrenches_;
};

}  // namespace opponens::cli
