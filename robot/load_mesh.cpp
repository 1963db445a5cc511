// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <unordered_map>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "core/require.hpp"
#include "robot/mesh.hpp"

namespace opponens::robot {

namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 30;  ///< larger files are refused, not attempted
constexpr std::size_t kStlHeaderBytes = 84;
constexpr std::size_t kStlTriangleBytes = 50;

[[noreturn]] void fail(const std::filesystem::path& file, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  throw InputError("mesh " + file.string() + ": " + message);
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// A binary STL says how many triangles follow; believing a damaged count would allocate gigabytes. The file's size
/// has to agree with it, or the file has to be the text form.
void check_stl_size(const std::filesystem::path& file, std::uintmax_t bytes) {
  std::array<char, kStlHeaderBytes> header{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(header.data(), static_cast<std::streamsize>(header.size()));
  const auto read = static_cast<std::size_t>(stream.gcount());
  const char* const text_end = header.data() + read;
  const char* const first = std::find_if(static_cast<const char*>(header.data()), text_end,
                                         [](unsigned char c) { return std::isspace(c) == 0; });
  const bool solid = text_end - first >= 5 && std::strncmp(first, "solid", 5) == 0;
  const bool text = solid && std::find(static_cast<const char*>(header.data()), text_end, '\0') == text_end;
  if (read < kStlHeaderBytes) {
    if (!text) fail(file, "is " + std::to_string(bytes) + " bytes long, too short for an STL file");
    return;
  }
  std::uint32_t count = 0;
  std::memcpy(&count, header.data() + 80, sizeof(count));
  if (bytes == kStlHeaderBytes + kStlTriangleBytes * std::uintmax_t{count} || text) return;
  fail(file, "binary STL announces " + std::to_string(count) + " triangles, which take " +
                 std::to_string(kStlHeaderBytes + kStlTriangleBytes * std::uintmax_t{count}) +
                 " bytes, but the file has " + std::to_string(bytes));
}

/// Collects triangles; a vertex is new when its position differs in any bit from those before.
class Collector {
 public:
  Collector(const std::filesystem::path& file, const Eigen::Vector3d& scale) : file_(file), scale_(scale) {}

  void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 X = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(*scene.mMeshes[node.mMeshes[i]], X);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(scene, *node.mChildren[i], X);
  }

  std::shared_ptr<const TriangleMesh> finish() const {
    if (triangles_.empty()) fail(file_, "has no triangles");
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->source = file_.string();
    mesh->file = file_;
    mesh->vertices.resize(3, static_cast<Eigen::Index>(vertices_.size()));
    mesh->triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      mesh->vertices.col(static_cast<Eigen::Index>(i)) = vertices_[i].cwiseProduct(scale_);
    }
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      mesh->triangles.col(static_cast<Eigen::Index>(i)) = triangles_[i];
    }
    // A mirroring scale turns the triangles inside out.
    if (scale_.prod() < 0.0) mesh->triangles.row(1).swap(mesh->triangles.row(2));
    return mesh;
  }

 private:
  using Key = std::array<float, 3>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      std::array<std::uint32_t, 3> bits{};
      std::memcpy(bits.data(), key.data(), sizeof(bits));
      std::uint64_t hash = 0xcbf29ce484222325ULL;
      for (const std::uint32_t b : bits) hash = (hash ^ b) * 0x100000001b3ULL;
      return static_cast<std::size_t>(hash ^ (hash >> 32));
    }
  };

  void add_mesh(const aiMesh& mesh, const aiMatrix4x4& X) {
    std::vector<int> index(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) index[i] = vertex(X * mesh.mVertices[i]);
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;  // points and lines; polygons were triangulated
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) fail(file_, "a triangle names a vertex that does not exist");
      }
      const Eigen::Vector3i corners(index[face.mIndices[0]], index[face.mIndices[1]], index[face.mIndices[2]]);
      // A triangle that uses a vertex twice has no area and its other edges cancel: without it the surface is the same.
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
      triangles_.push_back(corners);
    }
  }

  int vertex(const aiVector3D& v) {
    const Key key{v.x + 0.0F, v.y + 0.0F, v.z + 0.0F};  // -0 becomes 0
    const Eigen::Vector3d p(key[0], key[1], key[2]);
    if (!p.allFinite()) fail(file_, "vertex " + std::to_string(vertices_.size()) + " is not finite");
    const auto [position, added] = known_.try_emplace(key, static_cast<int>(vertices_.size()));
    if (added) vertices_.push_back(p);
    return position->second;
  }

  std::filesystem::path file_;
  Eigen::Vector3d scale_;
  std::unordered_map<Key, int, KeyHash> known_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

}  // namespace

std::shared_ptr<const TriangleMesh> load_mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale) {
  require(scale.allFinite() && scale.prod() != 0.0, "load_mesh: scale must be finite and not zero");
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) fail(file, "no such file");
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error) fail(file, error.message());
  if (bytes > kMaxFileBytes) fail(file, "is larger than 1 GiB");
  const std::string extension = lower_extension(file);
  if (extension != ".stl" && extension != ".obj" && extension != ".dae") {
    fail(file, "expected an STL, OBJ or DAE file");
  }
  if (extension == ".stl") check_stl_size(file, bytes);
  Assimp::Importer importer;
  // Robot descriptions take the axes of a DAE file as they are written; assimp would turn z up into y up.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    fail(file, std::string("cannot be read: ") + importer.GetErrorString());
  }
  Collector collector(file, scale);
  collector.add_node(*scene, *scene->mRootNode, aiMatrix4x4());
  return collector.finish();
}

}  // namespace opponens::robot
