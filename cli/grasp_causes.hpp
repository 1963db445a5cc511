// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "cli/json.hpp"
#include "robot/scene.hpp"

namespace opponens::cli {

/// Trials that were rejected for reasons that a person would do the same about.
struct Cause {
  std::string name;    ///< "collision with shelf", "out of the arm's reach", ...
  std::string advice;  ///< what may help; empty where nothing is known to
  std::int64_t trials = 0;
  std::map<std::string, std::int64_t> reasons;  ///< as the search and Algorithm 1 word them
};

/// The causes behind counted reasons, the commonest first. A collision counts for the scene body that is named in it.
std::vector<Cause> causes_of(const std::map<std::string, std::int64_t>& rejected, const robot::Scene& scene,
                             const std::string& object);

/// "81 % collision with shelf, 12 % out of the arm's reach, 7 % not force closure": at most five, the rest as "other".
std::string shares(const std::vector<Cause>& causes, std::int64_t trials);

Json causes_json(const std::vector<Cause>& causes, std::int64_t trials);

}  // namespace opponens::cli
