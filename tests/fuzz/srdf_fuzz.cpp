// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// An SRDF, and what it says about a robot of three links.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/require.hpp"
#include "robot/robot_model.hpp"
#include "robot/srdf.hpp"
#include "tests/fuzz/scratch.hpp"

using namespace opponens::robot;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = opponens::fuzz::spill("fuzz.srdf", {reinterpret_cast<const char*>(data), size});
  RobotDescription robot;
  for (const char* name : {"a", "b", "c"}) robot.links.push_back({name, -1, {}});
  try {
    apply_srdf(read_srdf(file), robot);
    for (const auto& [first, second] : robot.allowed_collisions) {
      if (first < 0 || first >= second || second > 2) std::abort();
    }
  } catch (const opponens::InputError&) {
  }
  return 0;
}
