// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/json.hpp"
#include "core/grasp.hpp"
#include "storage/store.hpp"

namespace opponens::cli {

/// A grasp as `grasp --json` prints it; joints: names of its hand's joints.
Json grasp_json(const std::string& id, const Grasp& grasp, const std::vector<std::string>& joints);

/// Grasps of a store as documents for other programs (docs/cli.md, export): the form of `grasp --json`, with what the
/// grasp was made for, the convention of its quality, and the wrenches of every contact.
class GraspDocuments {
 public:
  explicit GraspDocuments(const storage::Store& store) : store_(store) {}

  /// The document of a stored grasp: joints by name, poses row-major, contacts with their edge wrenches
  /// [force; torque / rho] (grasp/quality.hpp: contact_wrenches). nullopt when the store does not hold the synergy set
  /// that the grasp was made from: nothing else names its joints.
  std::optional<Json> of(const std::string& id, const storage::Record& record);

 private:
  const std::vector<std::string>* joints_of(const storage::Record& record);

  const storage::Store& store_;
  std::map<std::string, std::vector<std::string>> joints_;  // of the synergy sets met so far, by id
};

}  // namespace opponens::cli
