// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover_file.hpp"

#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

namespace opponens::robot {

namespace {

namespace fs = std::filesystem;

/// Raised whenever mesh_cover gives other results or the layout changes (CoverFile.KeepsItsVersion).
constexpr std::uint32_t kVersion = 2;
constexpr std::string_view kMagic = "opponens cover\n";
constexpr std::uint32_t kByteOrder = 0x01020304;  ///< numbers are stored as the processor holds them

using Digest = std::array<char, 32>;

Digest sha256(std::string_view bytes) {
  Digest digest{};
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), reinterpret_cast<unsigned char*>(digest.data()), &size, EVP_sha256(),
                 nullptr) != 1 ||
      size != digest.size()) {
    throw std::runtime_error("libcrypto: SHA-256 is not available");
  }
  return digest;
}

std::string hex(const Digest& digest) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const char byte : digest) {
    text += kDigits[static_cast<unsigned char>(byte) >> 4U];
    text += kDigits[static_cast<unsigned char>(byte) & 15U];
  }
  return text;
}

std::string_view view(const Digest& digest) { return {digest.data(), digest.size()}; }

template <typename T>
void put(std::string& bytes, const T* values, std::size_t count) {
  static_assert(std::is_arithmetic_v<T>);
  bytes.append(reinterpret_cast<const char*>(values), sizeof(T) * count);
}
template <typename T>
void put(std::string& bytes, T value) {
  put(bytes, &value, 1);
}

/// Takes numbers from the front of a text that is long enough.
template <typename T>
void take(std::string_view& bytes, T* values, std::size_t count) {
  static_assert(std::is_arithmetic_v<T>);
  if (count > 0) std::memcpy(values, bytes.data(), sizeof(T) * count);
  bytes.remove_prefix(sizeof(T) * count);
}
template <typename T>
T take(std::string_view& bytes) {
  T value{};
  take(bytes, &value, 1);
  return value;
}

void put(std::string& bytes, const HullVertices& hull) {
  for (const PaddedPoints* points : {&hull.all, &hull.few}) {
    put(bytes, points->count);
    put(bytes, points->xyz.data(), points->xyz.size());
  }
  put(bytes, hull.rounding);
}

void take(std::string_view& bytes, HullVertices& hull) {
  for (PaddedPoints* points : {&hull.all, &hull.few}) {
    points->count = take<int>(bytes);
    points->xyz.resize(3 * static_cast<std::size_t>(points->count));
    take(bytes, points->xyz.data(), points->xyz.size());
  }
  hull.rounding = take<double>(bytes);
}

/// What a cover depends on, hashed.
Digest key_of(const TriangleMesh& mesh, const SphereTreeSettings& settings) {
  std::string bytes(kMagic);
  put(bytes, kByteOrder);
  put(bytes, kVersion);
  put(bytes, settings.leaves);
  put(bytes, settings.radius);
  put(bytes, static_cast<std::int64_t>(mesh.vertices.cols()));
  put(bytes, static_cast<std::int64_t>(mesh.triangles.cols()));
  put(bytes, mesh.vertices.data(), static_cast<std::size_t>(mesh.vertices.size()));
  put(bytes, mesh.triangles.data(), static_cast<std::size_t>(mesh.triangles.size()));
  return sha256(bytes);
}

/// Magic, key, count of nodes, nodes, their pieces, hull, and the SHA-256 of all that.
std::string encode(const Digest& key, const MeshCover& cover) {
  std::string bytes(kMagic);
  bytes += view(key);
  put(bytes, static_cast<std::uint64_t>(cover.tree.nodes.size()));
  for (const SphereTree::Node& node : cover.tree.nodes) {
    put(bytes, node.center.data(), 3);
    put(bytes, node.radius);
    put(bytes, node.first_child);
    put(bytes, node.children);
  }
  for (const HullVertices& piece : cover.pieces) put(bytes, piece);
  put(bytes, cover.hull);
  return bytes += view(sha256(bytes));
}

/// nullopt unless the bytes are what encode() made of this key: with the right sum, the counts are right as well.
std::optional<MeshCover> decode(std::string_view bytes, const Digest& key) {
  const std::size_t header = kMagic.size() + key.size() + sizeof(std::uint64_t);
  if (bytes.size() < header + sizeof(Digest)) return std::nullopt;
  const std::string_view sum = bytes.substr(bytes.size() - sizeof(Digest));
  bytes.remove_suffix(sizeof(Digest));
  if (!bytes.starts_with(kMagic) || bytes.substr(kMagic.size(), key.size()) != view(key)) return std::nullopt;
  if (view(sha256(bytes)) != sum) return std::nullopt;
  bytes.remove_prefix(kMagic.size() + key.size());
  MeshCover cover;
  cover.tree.nodes.resize(take<std::uint64_t>(bytes));
  for (SphereTree::Node& node : cover.tree.nodes) {
    take(bytes, node.center.data(), 3);
    node.radius = take<double>(bytes);
    node.first_child = take<int>(bytes);
    node.children = take<int>(bytes);
  }
  cover.pieces.resize(cover.tree.nodes.size());
  for (HullVertices& piece : cover.pieces) take(bytes, piece);
  take(bytes, cover.hull);
  return cover;
}

std::optional<MeshCover> read(const fs::path& file, const Digest& key) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes;
  std::array<char, 1U << 16U> block;  // NOLINT: filled before it is read
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0) {
    bytes.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  return decode(bytes, key);
}

/// Without a word when it cannot be done.
void write(const fs::path& file, const std::string& bytes) {
  static std::atomic<unsigned> number = 0;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  fs::path aside = file;
  aside += '.';
  aside += std::to_string(::getpid());
  aside += '.';
  aside += std::to_string(number++);
  std::ofstream stream(aside, std::ios::binary | std::ios::trunc);
  if (!stream) return;
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (stream) fs::rename(aside, file, error);
  if (!stream || error) fs::remove(aside, error);
}

std::shared_ptr<const MeshCover> cached_cover(const TriangleMesh& mesh, const fs::path& folder) {
  if (folder.empty()) return std::make_shared<const MeshCover>(mesh_cover(mesh));
  const Digest key = key_of(mesh, {});
  const fs::path file = folder / (hex(key) + ".cover");
  if (auto known = read(file, key)) return std::make_shared<const MeshCover>(std::move(*known));
  MeshCover made = mesh_cover(mesh);
  write(file, encode(key, made));
  return std::make_shared<const MeshCover>(std::move(made));
}

using Mesh = std::shared_ptr<const TriangleMesh>;

/// covered: what has become of the meshes met before.
void cover(std::vector<Geometry>& geometry, const fs::path& folder, std::map<Mesh, Mesh>& covered) {
  for (Geometry& one : geometry) {
    auto* const mesh = std::get_if<Mesh>(&one.shape);
    if (mesh == nullptr || *mesh == nullptr || (*mesh)->cover.get() != nullptr || (*mesh)->triangles.cols() == 0)
      continue;
    Mesh& known = covered[*mesh];
    if (known == nullptr) {
      auto copy = std::make_shared<TriangleMesh>(**mesh);
      copy->cover.keep(cached_cover(*copy, folder));
      known = std::move(copy);
    }
    *mesh = known;
  }
}

}  // namespace

RobotDescription with_covers(RobotDescription robot, const fs::path& folder) {
  std::map<Mesh, Mesh> covered;
  for (Link& link : robot.links) cover(link.collision, folder, covered);
  return robot;
}

Scene with_covers(Scene scene, const fs::path& folder) {
  std::map<Mesh, Mesh> covered;
  for (SceneBody& body : scene.bodies) cover(body.geometry, folder, covered);
  return scene;
}

}  // namespace opponens::robot
