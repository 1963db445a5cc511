// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>

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

/// Collects vertices and triangles as the file has them.
class Collector {
 public:
  explicit Collector(const std::filesystem::path& file) : file_(file) {}

  void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 X = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(*scene.mMeshes[node.mMeshes[i]], X);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(scene, *node.mChildren[i], X);
  }

  TriangleMesh finish(const Eigen::Vector3d& scale) const {
    TriangleMesh mesh;
    mesh.source = file_.string();
    mesh.file = file_;
    mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices_.size()));
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      mesh.vertices.col(static_cast<Eigen::Index>(i)) = vertices_[i].cwiseProduct(scale);
    }
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      mesh.triangles.col(static_cast<Eigen::Index>(i)) = triangles_[i];
    }
    if (!mesh.vertices.allFinite()) fail(file_, "has vertices that are not finite once scaled");
    // A mirroring scale turns the triangles inside out. The product of the factors may vanish, their signs do not.
    if ((scale.array() < 0.0).count() % 2 == 1) mesh.triangles.row(1).swap(mesh.triangles.row(2));
    return mesh;
  }

 private:
  void add_mesh(const aiMesh& mesh, const aiMatrix4x4& X) {
    const int first = static_cast<int>(vertices_.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D v = X * mesh.mVertices[i];
      vertices_.emplace_back(v.x, v.y, v.z);
      if (!vertices_.back().allFinite())
        fail(file_, "vertex " + std::to_string(vertices_.size() - 1) + " is not finite");
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;  // points and lines; polygons were triangulated
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) fail(file_, "a triangle names a vertex that does not exist");
      }
      triangles_.emplace_back(Eigen::Vector3i::Constant(first) + Eigen::Vector3i(static_cast<int>(face.mIndices[0]),
                                                                                 static_cast<int>(face.mIndices[1]),
                                                                                 static_cast<int>(face.mIndices[2])));
    }
  }

  std::filesystem::path file_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

}  // namespace

std::shared_ptr<const TriangleMesh> load_mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale) {
  TriangleMesh mesh = merge_equal_vertices(read_mesh(file, scale));
  if (mesh.triangles.cols() == 0) fail(file, "has no triangles");
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

TriangleMesh read_mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale) {
  require(scale.allFinite() && (scale.array() != 0.0).all(), "read_mesh: scale must be finite and not zero");
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
  Collector collector(file);
  collector.add_node(*scene, *scene->mRootNode, aiMatrix4x4());
  TriangleMesh mesh = collector.finish(scale);
  if (mesh.triangles.cols() == 0) fail(file, "has no triangles");
  return mesh;
}

}  // namespace opponens::robot
