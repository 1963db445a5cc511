// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cli/json.hpp"
#include "robot/scene.hpp"

namespace opponens::cli {

/// The object of each driven arm (one for a robot without names of arms). arguments: NAME; where several arms are
/// driven also ARM=NAME, which comes before a NAME for all. Nothing given: the scene's own object. Throws InputError
/// naming the choices.
std::vector<std::string> objects_of_arms(const std::vector<std::string>& arguments,
                                         const std::vector<std::string>& arms, const robot::Scene& scene,
                                         const std::string& scene_file);

/// The same arguments again, from the parameter "world" of a stored object: "object", or "objects" by arm.
std::vector<std::string> object_arguments(const Json& world);

}  // namespace opponens::cli
