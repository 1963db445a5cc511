// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdint>
#include <cstring>
#include <unordered_map>

#include "robot/mesh.hpp"

namespace opponens::robot {

namespace {

using Key = std::array<double, 3>;
struct KeyHash {
  std::size_t operator()(const Key& key) const {
    std::array<std::uint64_t, 3> bits{};
    std::memcpy(bits.data(), key.data(), sizeof(bits));
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const std::uint64_t b : bits) hash = (hash ^ b ^ (b >> 32)) * 0x100000001b3ULL;
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

}  // namespace

TriangleMesh merge_equal_vertices(const TriangleMesh& mesh) {
  std::unordered_map<Key, int, KeyHash> known;
  std::vector<int> index(static_cast<std::size_t>(mesh.vertices.cols()));
  TriangleMesh merged{mesh.vertices, mesh.triangles, mesh.source, mesh.file};
  for (Eigen::Index v = 0; v < mesh.vertices.cols(); ++v) {
    const Eigen::Vector3d p = mesh.vertices.col(v).array() + 0.0;  // -0 becomes 0
    const int next = static_cast<int>(known.size());
    const auto [position, added] = known.try_emplace({p.x(), p.y(), p.z()}, next);
    if (added) merged.vertices.col(next) = p;
    index[static_cast<std::size_t>(v)] = position->second;
  }
  merged.vertices.conservativeResize(3, static_cast<Eigen::Index>(known.size()));
  Eigen::Index count = 0;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    Eigen::Vector3i corners;
    for (int k = 0; k < 3; ++k) corners[k] = index[static_cast<std::size_t>(mesh.triangles(k, f))];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    merged.triangles.col(count++) = corners;
  }
  merged.triangles.conservativeResize(3, count);
  return merged;
}

}  // namespace opponens::robot
