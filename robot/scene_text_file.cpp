// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/scene_text_file.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/planning_scene_file.hpp"
#include "robot/scene_values.hpp"
#include "robot/text_file.hpp"

namespace opponens::robot {

namespace {

/// Walks over the text word by word and knows the line for its complaints.
class Words {
 public:
  explicit Words(const std::filesystem::path& file) : file_(file), text_(read_text_file(file, "a scene")) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(file_.string() + ":" + std::to_string(line_) + ": " +
                     (object_.empty() ? "" : "object '" + object_ + "': ") + message);
  }

  void enter(const std::string& object) { object_ = object; }

  /// The rest of the line, without blanks around it.
  std::string line() {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string rest = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    ++line_;
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!rest.empty() && blank(rest.back())) rest.pop_back();
    while (!rest.empty() && blank(rest.front())) rest.erase(rest.begin());
    return rest;
  }

  /// The next word; empty at the end of the file.
  std::string word() {
    while (position_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[position_])) != 0) {
      if (text_[position_++] == '\n') ++line_;
    }
    const std::size_t begin = position_;
    while (position_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[position_])) == 0) ++position_;
    return text_.substr(begin, position_ - begin);
  }

  /// How many words the line has that the next word stands in; nothing is taken.
  int words_in_next_line() {
    const std::size_t position = position_;
    const int line = line_;
    word();
    const int first = line_;
    int count = 1;
    while (!word().empty() && line_ == first) ++count;
    position_ = position;
    line_ = line;
    return count;
  }

  double number() { return number(word()); }

  double number(const std::string& text) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
      fail("expected a finite number, found '" + text + "'");
    }
    return value;
  }

  double positive() {
    const double value = number();
    if (value <= 0.0) fail("expected a positive number, found " + std::to_string(value));
    return value;
  }

  /// A count of things that take at least `bytes` each: a damaged one must not allocate more than the file can fill.
  int count(const std::string& of, std::size_t bytes) {
    const std::string text = word();
    const double value = number(text);
    const std::size_t left = text_.size() - position_;
    if (value < 0.0 || value != std::floor(value)) fail("expected a number of " + of);
    if (value * static_cast<double>(bytes) > static_cast<double>(left) + 1.0) {
      fail("announces " + text + " " + of + ", but only " + std::to_string(left) + " bytes follow");
    }
    return static_cast<int>(value);
  }

  Eigen::Vector3d vector() {
    Eigen::Vector3d v;
    for (int k = 0; k < 3; ++k) v[k] = number();
    return v;
  }

  Eigen::Isometry3d pose() {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = vector();
    Eigen::Vector4d xyzw;
    for (int k = 0; k < 4; ++k) xyzw[k] = number();
    if (std::abs(xyzw.norm() - 1.0) > kQuaternionTolerance) {
      fail("expected a unit quaternion (x, y, z, w), its norm is " + std::to_string(xyzw.norm()));
    }
    X.linear() = Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]).normalized().toRotationMatrix();
    return X;
  }

 private:
  std::filesystem::path file_;
  std::string text_;
  std::string object_;
  std::size_t position_ = 0;
  int line_ = 1;
};

Shape read_mesh_shape(Words& words, const std::filesystem::path& file) {
  constexpr std::size_t kBytesOfThreeNumbers = 6;
  TriangleMesh mesh;
  mesh.source = file.string();
  const int vertices = words.count("vertices", kBytesOfThreeNumbers);
  const int triangles = words.count("triangles", kBytesOfThreeNumbers);
  mesh.vertices.resize(3, vertices);
  mesh.triangles.resize(3, triangles);
  for (int i = 0; i < vertices; ++i) mesh.vertices.col(i) = words.vector();
  for (int i = 0; i < triangles; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double index = words.number();
      if (index < 0.0 || index >= vertices || index != std::floor(index)) words.fail("a triangle names no vertex");
      mesh.triangles(k, i) = static_cast<int>(index);
    }
  }
  mesh = merge_equal_vertices(mesh);
  if (mesh.triangles.cols() == 0) words.fail("a mesh without triangles");
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

Shape read_shape(Words& words, const std::filesystem::path& file) {
  const std::string type = words.word();
  if (type == "sphere") return Sphere{words.positive()};
  if (type == "mesh") return read_mesh_shape(words, file);
  if (type == "plane") words.fail("a plane has no thickness and no end; write a box instead");
  if (type == "box") {
    Eigen::Vector3d size;
    for (int k = 0; k < 3; ++k) size[k] = words.positive();
    return Box{size};
  }
  if (type != "cylinder" && type != "cone") {
    words.fail("expected box, sphere, cylinder, cone or mesh, found '" + type + "'");
  }
  const double radius = words.positive();
  const double length = words.positive();
  return type == "cone" ? cone(radius, length) : Shape(Cylinder{radius, length});
}

SceneBody read_object(Words& words, const std::filesystem::path& file, Scene& scene) {
  SceneBody body;
  body.name = words.line();
  if (body.name.empty()) words.fail("an object without a name");
  words.enter(body.name);
  // Files since MoveIt 1.1 go on with the object's position, those before with the number of its shapes.
  const bool with_pose = words.words_in_next_line() == 3;
  if (with_pose) body.X_WB = words.pose();
  constexpr std::size_t kBytesOfShape = 8;
  const int shapes = words.count("shapes", kBytesOfShape);
  if (shapes == 0) words.fail("needs at least one shape");
  for (int i = 0; i < shapes; ++i) {
    Geometry geometry{read_shape(words, file)};
    geometry.X_BG = words.pose();
    for (int k = 0; k < 4; ++k) words.number();  // colour
    body.geometry.push_back(std::move(geometry));
  }
  if (!with_pose) return body;
  const int subframes = words.count("subframes", kBytesOfShape);
  for (int i = 0; i < subframes; ++i) {
    words.word();
    words.pose();
  }
  if (subframes > 0) scene.notes.push_back("object '" + body.name + "': its subframes are ignored");
  return body;
}

}  // namespace

bool is_scene_text(const std::filesystem::path& file) { return file.extension() == ".scene"; }

Scene load_scene_text(const std::filesystem::path& file) {
  Words words(file);
  Scene scene;
  scene.name = words.line();
  if (scene.name.empty() || scene.name == "(noname)+") scene.name = file.stem().string();
  std::set<std::string> names;
  while (true) {
    words.enter("");
    const std::string mark = words.word();
    if (mark == ".") break;
    if (mark != "*") words.fail("expected '*' before an object or '.' at the end, found '" + mark + "'");
    scene.bodies.push_back(read_object(words, file, scene));
    if (!names.insert(scene.bodies.back().name).second) words.fail("there are two objects of that name");
  }
  scene.files.push_back(file);
  return scene;
}

}  // namespace opponens::robot
