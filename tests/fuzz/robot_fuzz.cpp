// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// A robot.yaml beside whole URDFs of an arm and a hand and a hand.yaml; or the hand.yaml beside the rest. The first
// byte chooses. Whatever is accepted is a robot.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/require.hpp"
#include "robot/load_robot.hpp"
#include "tests/fuzz/scratch.hpp"

using namespace opponens::robot;
using opponens::fuzz::spill;

namespace {

std::string chain(const std::string& names) {
  std::string text = "<robot name='r'>";
  for (const char name : names) text += std::string("<link name='") + name + "'/>";
  for (std::size_t i = 1; i < names.size(); ++i) {
    text += std::string("<joint name='") + names[i - 1] + names[i] + "' type='revolute'><parent link='" + names[i - 1] +
            "'/><child link='" + names[i] + "'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>";
  }
  return text + "</robot>";
}

void spill_robot() {
  spill("arm.urdf", chain("abc"));
  spill("hand.urdf", chain("pqr"));
  spill("robot.yaml",
        "arm: {urdf: arm.urdf, joints: [ab, bc]}\nhand: hand.yaml\nmount: {parent: c, xyz: [0, 0, 0.1]}\n");
  spill("hand.yaml", "urdf: hand.urdf\npalm_link: p\njoints: [pq, qr]\n");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::array<const char*, 2> kNames{"robot.yaml", "hand.yaml"};
  if (size == 0) return 0;
  spill_robot();
  spill(kNames.at(data[0] % kNames.size()), {reinterpret_cast<const char*>(data) + 1, size - 1});
  try {
    const RobotModel robot(load_robot(opponens::fuzz::scratch() / "robot.yaml"));
    if (!(robot.lower().array() <= robot.upper().array()).all()) std::abort();
  } catch (const opponens::InputError&) {
  }
  return 0;
}
