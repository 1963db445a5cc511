// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Scenes: ours and MoveIt's as YAML, MoveIt's text form, requests, and an import by one of ours. The first byte
// chooses. Whatever is accepted has bodies of different names with shapes that are finite.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>

#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/motion_request.hpp"
#include "robot/scene.hpp"
#include "tests/fuzz/scratch.hpp"

using namespace opponens::robot;
using opponens::fuzz::spill;

namespace {

void check(const Scene& scene) {
  std::set<std::string> names;
  for (const SceneBody& body : scene.bodies) {
    bool good = names.insert(body.name).second && !body.geometry.empty() && body.X_WB.matrix().allFinite();
    for (const Geometry& geometry : body.geometry) {
      good = good && geometry.X_BG.matrix().allFinite();
      if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&geometry.shape)) {
        good = good && (*mesh)->triangles.minCoeff() >= 0 && (*mesh)->triangles.maxCoeff() < (*mesh)->vertices.cols();
      }
    }
    if (!good) std::abort();
  }
  if (scene.start.size() != static_cast<Eigen::Index>(scene.start_joints.size())) std::abort();
}

void read(int kind, std::string_view text) {
  if (kind == 0) return check(load_scene(spill("scene.yaml", text)));
  if (kind == 1) return check(load_scene(spill("moveit.scene", text)));
  if (kind == 2) return static_cast<void>(load_motion_request(spill("request.yaml", text)));
  spill("moveit.yaml", text);
  check(load_scene(spill("ours.yaml", "name: ours\nimport: moveit.yaml\npackages: {p: .}\n")));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  spill("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  try {
    read(data[0] % 4, {reinterpret_cast<const char*>(data) + 1, size - 1});
  } catch (const opponens::InputError&) {
  }
  return 0;
}
