// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/scene.hpp"

#include <algorithm>

#include "core/require.hpp"

namespace opponens::robot {

const SceneBody& Scene::body(const std::string& body_name) const {
  const auto found =
      std::find_if(bodies.begin(), bodies.end(), [&](const SceneBody& body) { return body.name == body_name; });
  require(found != bodies.end(), [&] { return "scene '" + name + "' has no body '" + body_name + "'"; });
  return *found;
}

}  // namespace opponens::robot
