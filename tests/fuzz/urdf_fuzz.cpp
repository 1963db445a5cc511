// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// A URDF alone. Whatever is accepted is a tree whose numbers are finite, and a robot.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/require.hpp"
#include "robot/load_robot.hpp"
#include "tests/fuzz/scratch.hpp"

using namespace opponens::robot;

namespace {

bool is_sound(const RobotDescription& robot) {
  bool good = robot.links.size() == robot.joints.size() + 1;
  for (const Joint& joint : robot.joints) {
    good = good && joint.parent < joint.child && joint.X_PJ.matrix().allFinite() && joint.lower <= joint.upper;
    good = good && (joint.type == JointType::fixed || std::abs(joint.axis.norm() - 1.0) < 1e-9);
  }
  return good;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = opponens::fuzz::spill("fuzz.urdf", {reinterpret_cast<const char*>(data), size});
  UrdfSettings settings;
  settings.missing_meshes = MissingMeshes::list;
  try {
    const RobotDescription robot = load_urdf(file, settings);
    if (!is_sound(robot)) std::abort();
    const RobotModel model(robot);
    if (model.link_poses(model.rest()).size() != robot.links.size()) std::abort();
  } catch (const opponens::InputError&) {
  }
  return 0;
}
