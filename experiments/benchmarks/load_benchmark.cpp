// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// From files to a collision checker that answers: what each step costs, without kept covers and with them.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "robot/collision.hpp"
#include "robot/cover_file.hpp"
#include "robot/load_robot.hpp"
#include "robot/narrow_phase.hpp"
#include "robot/scene.hpp"

namespace {

namespace fs = std::filesystem;
using namespace opponens;

const fs::path kSource = OPPONENS_SOURCE_DIR;

/// A folder for covers of its own.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("opponens_load_benchmark." + std::to_string(::getpid()));
  Folder() { clear(); }
  ~Folder() { clear(); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  void clear() const {
    std::error_code error;
    fs::remove_all(path, error);
  }
};

void load(benchmark::State& state, const fs::path& file) {
  for (auto _ : state) benchmark::DoNotOptimize(robot::load_robot(file));
}

/// As a program without kept covers starts.
void load_and_check(benchmark::State& state, const fs::path& file) {
  const robot::Scene scene = robot::load_scene(kSource / "models/scenes/cylinder_shelf.yaml");
  for (auto _ : state) {
    const robot::RobotModel model(robot::load_robot(file));
    benchmark::DoNotOptimize(robot::CollisionChecker(model, scene));
  }
}

/// As `opponens` starts for the first time (kept: false) and ever after.
void load_with_covers_and_check(benchmark::State& state, const fs::path& file, bool kept) {
  const Folder folder;
  const robot::Scene scene = robot::load_scene(kSource / "models/scenes/cylinder_shelf.yaml");
  if (kept) benchmark::DoNotOptimize(with_covers(robot::load_robot(file), folder.path));
  for (auto _ : state) {
    const robot::RobotModel model(with_covers(robot::load_robot(file), folder.path));
    benchmark::DoNotOptimize(robot::CollisionChecker(model, scene));
    if (kept) continue;
    state.PauseTiming();
    folder.clear();
    state.ResumeTiming();
  }
}

/// The rest that exact questions need, of every mesh; a checker does this for a mesh when it is first near another
/// body.
void first_exact_questions(benchmark::State& state, const fs::path& file) {
  for (auto _ : state) {
    state.PauseTiming();
    std::vector<robot::CollisionShape> meshes;
    const robot::RobotDescription description = robot::load_robot(file);
    for (const robot::Link& link : description.links) {
      for (const robot::Geometry& geometry : link.collision) {
        if (geometry.shape.index() == std::variant_size_v<robot::Shape> - 1) meshes.emplace_back(geometry.shape);
      }
    }
    state.ResumeTiming();
    const robot::CollisionShape crumb(robot::Box{Eigen::Vector3d::Constant(1e-6)});
    for (const robot::CollisionShape& mesh : meshes) {
      const Eigen::Isometry3d X_MB(Eigen::Translation3d{mesh.center()});
      benchmark::DoNotOptimize(intersect(mesh, Eigen::Isometry3d::Identity(), crumb, X_MB));
    }
  }
}

/// A checker of a robot that others hold already: every search makes some.
void another_checker(benchmark::State& state, const fs::path& file) {
  const robot::RobotModel model(robot::load_robot(file));
  const robot::Scene scene = robot::load_scene(kSource / "models/scenes/cylinder_shelf.yaml");
  const robot::CollisionChecker held(model, scene);
  for (auto _ : state) benchmark::DoNotOptimize(robot::CollisionChecker(model, scene));
}

void add(const std::string& name, const fs::path& file) {
  const auto add_one = [&](const std::string& what, const auto& function) {
    benchmark::RegisterBenchmark((what + "/" + name).c_str(), function)->Unit(benchmark::kMillisecond);
  };
  add_one("load", [file](benchmark::State& state) { load(state, file); });
  add_one("load_and_check", [file](benchmark::State& state) { load_and_check(state, file); });
  for (const bool kept : {false, true}) {
    add_one(kept ? "load_kept_covers_and_check" : "load_and_keep_covers_and_check",
            [file, kept](benchmark::State& state) { load_with_covers_and_check(state, file, kept); });
  }
  add_one("first_exact_questions", [file](benchmark::State& state) { first_exact_questions(state, file); });
  add_one("another_checker", [file](benchmark::State& state) { another_checker(state, file); });
}

const bool kAdded = [] {
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 0);
  add("ours", kSource / "models/ur5_allegro/ur5_allegro_right.yaml");
  if (!fs::exists(fs::path(std::getenv("OPPONENS_SHARED_DATA")) / "data/robots")) return true;
  for (const std::string kind : {"urdf", "visual"}) {
    add("laboratory_" + kind, kSource / ("tests/data/robots/paper_lab_ur5_allegro_right_" + kind + ".yaml"));
  }
  return true;
}();

}  // namespace
