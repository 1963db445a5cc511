// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the files that URDFs and planning scenes name.

#include <filesystem>
#include <string>

#include "robot/read_urdf.hpp"

namespace opponens::robot {

/// Where a file lies, or why that cannot be told.
struct ResourcePlace {
  std::filesystem::path path;
  std::string problem;              ///< what the name does wrong ("does not exist: ..."); empty: it is a regular file
  bool leaves_its_package = false;  ///< never to be passed over: no honest file does
};

/// Follows package://NAME/..., file://... or a path that is absolute or relative to the folder of `file`, which names
/// it. A package's files lie inside the package: neither `..` nor a link leads out.
ResourcePlace find_resource(const std::string& name, const std::filesystem::path& file, const PackagePaths& packages);

}  // namespace opponens::robot
