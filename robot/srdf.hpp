// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace opponens::robot {

struct SrdfGroup {
  std::string name;
  std::vector<std::string> joints;
  std::vector<std::string> links;
  std::vector<std::pair<std::string, std::string>> chains;  ///< base link, tip link
  std::vector<std::string> groups;                          ///< other groups that belong to it
};

struct SrdfEndEffector {
  std::string name;
  std::string parent_link;
  std::string group;
};

struct SrdfGroupState {
  std::string name;
  std::string group;
  std::map<std::string, std::vector<double>> joints;  ///< rad or m; a joint may have several values (planar, floating)
};

struct SrdfDisabledPair {
  std::string link1;
  std::string link2;
  std::string reason;  ///< as written: "Adjacent", "Never", ...; may be empty
};

/// What an SRDF (MoveIt's semantic robot description) says, by name and unchecked against any URDF.
struct Srdf {
  std::filesystem::path file;
  std::vector<SrdfGroup> groups;
  std::vector<SrdfEndEffector> end_effectors;
  std::vector<SrdfGroupState> group_states;
  std::vector<SrdfDisabledPair> disabled;
  std::map<std::string, int> ignored;  ///< tag that nobody reads -> how often
};

/// Throws InputError naming file and line when it is not XML, has no <robot>, or an element lacks an attribute.
Srdf read_srdf(const std::filesystem::path& file);

struct RobotDescription;

/// Adds the SRDF to the description's semantics and its disabled pairs to allowed_collisions. What is not used, and
/// links that the robot does not have, are named in the notes: an SRDF often is of a larger robot.
void apply_srdf(const Srdf& srdf, RobotDescription& description);

}  // namespace opponens::robot
