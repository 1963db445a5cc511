// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rates of the grasp search, one core, CPU time: contact energies, closings that are scored and legal, certified
// grasps with pre-grasp. "laboratory": its Allegro with visual meshes on the ten YCB meshes, what GraspIt! was measured
// on (~2,080 energies, 22 legal closings, 1.46 uncertified grasps a second at its best; it is not packaged, so those
// figures are from reference/graspit_ycb.csv and not of this run). "ours": our Allegro of primitives and a cylinder.
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "analysis/synergy_box.hpp"
#include "core/rng.hpp"
#include "grasp/certificate.hpp"
#include "grasp/close_hand.hpp"
#include "grasp/free_joints.hpp"
#include "grasp/grasp_objective.hpp"
#include "grasp/grasp_search.hpp"
#include "grasp/hand_seed.hpp"
#include "grasp/quality.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"

namespace {

using namespace opponens;

struct Bench {
  robot::RobotModel hand;
  grasp::FreeJoints free = grasp::free_joints(hand);
  std::vector<std::unique_ptr<grasp::SearchWorld>> worlds{};
};

void add_world(Bench& bench, const robot::Shape& shape) {
  robot::Scene scene;
  scene.object = "object";
  scene.bodies.push_back({"object", Eigen::Isometry3d::Identity(), {{shape, Eigen::Isometry3d::Identity()}}});
  bench.worlds.push_back(
      std::make_unique<grasp::SearchWorld>(grasp::make_search_world(bench.hand, scene, "object", 1)));
}

const Bench& ours() {
  static const auto bench = [] {
    auto made = std::make_unique<Bench>(
        Bench{robot::RobotModel(robot::load_hand(OPPONENS_SOURCE_DIR "/models/ur5_allegro/allegro_right.yaml"))});
    add_world(*made, robot::Cylinder{0.03, 0.12});
    return made;
  }();
  return *bench;
}

const Bench& laboratory() {
  static const auto bench = [] {
    setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
    auto made = std::make_unique<Bench>(Bench{
        robot::RobotModel(robot::load_hand(OPPONENS_SOURCE_DIR "/experiments/graspit_ycb/laboratory_hand.yaml"))});
    for (const auto& folder : std::filesystem::directory_iterator(OPPONENS_SHARED_DATA "/data/objects/ycb")) {
      const std::string name = folder.path().filename().string();
      add_world(*made, robot::load_mesh(folder.path() / (name + ".obj")));
    }
    return made;
  }();
  return *bench;
}

const Bench* bench_of(benchmark::State& state, bool shared) {
  if (!shared) return &ours();
  if (std::filesystem::exists(OPPONENS_SHARED_DATA "/data/objects/ycb")) return &laboratory();
  state.SkipWithError("no shared data");
  return nullptr;
}

/// The cost that ranks seeds, at seeds as the search draws them.
void contact_energy(benchmark::State& state, bool shared) {
  const Bench* const bench = bench_of(state, shared);
  if (bench == nullptr) return;
  const SynergyBox& box = bench->free.group.box;
  std::int64_t count = 0;
  for (auto _ : state) {
    for (const auto& world : bench->worlds) {
      state.PauseTiming();
      grasp::GraspObjective objective(world->hand, world->surface, world->target, box);
      Rng rng = stream(1, "energy");
      std::vector<grasp::HandSeed> seeds;
      while (seeds.size() < 100) {
        if (auto seed = grasp::draw_seed({world->hand, world->surface, world->target, box}, rng))
          seeds.push_back(*seed);
      }
      state.ResumeTiming();
      for (const grasp::HandSeed& seed : seeds) {
        Eigen::VectorXd x = Eigen::VectorXd::Zero(objective.size());
        x.tail(seed.y.size()) = seed.y;
        benchmark::DoNotOptimize(objective.evaluate(seed, x, nullptr));
      }
      count += static_cast<std::int64_t>(seeds.size());
    }
  }
  state.counters["energies"] = benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsRate);
}

/// Seed drawn, hand closed, contacts found and scored, posture held to all limits; counted when it is legal.
void close_and_score(benchmark::State& state, bool shared) {
  const Bench* const bench = bench_of(state, shared);
  if (bench == nullptr) return;
  const SynergyBox& box = bench->free.group.box;
  const Eigen::VectorXd direction = grasp::closing_direction(box, bench->free.pre_grasp);
  std::int64_t legal = 0;
  std::int64_t index = 0;
  for (auto _ : state) {
    for (const auto& world : bench->worlds) {
      Rng rng = stream(1, "close/" + std::to_string(index++));
      const auto seed = grasp::draw_seed({world->hand, world->surface, world->target, box}, rng);
      if (!seed) continue;
      const grasp::ClosingScene scene{world->hand, world->surface, world->target, box, direction};
      const auto closed = grasp::close_hand(scene, {seed->X_OH, analysis::configuration(box, seed->y)});
      if (!closed) continue;
      const std::vector<Contact> contacts = grasp::find_contacts(scene, *closed, 0.001, 0.5);
      QualityConvention convention;
      convention.rho = world->target.rho;
      convention.origin = world->target.center_of_mass;
      benchmark::DoNotOptimize(grasp::evaluate(contacts, convention));
      grasp::GraspLimits limits{std::vector<bool>(world->hand.links().size(), false), 0.001, 0.01};
      for (const Contact& contact : contacts) limits.touching[world->hand.link_index(contact.link)] = true;
      legal += grasp::posture_fault(scene, world->checkers, *closed, limits).empty() ? 1 : 0;
    }
  }
  state.counters["legal"] = benchmark::Counter(static_cast<double>(legal), benchmark::Counter::kIsRate);
}

/// The whole search without improvement: every certified grasp with its pre-grasp counts, also those not kept.
void certified_grasps(benchmark::State& state, bool shared) {
  const Bench* const bench = bench_of(state, shared);
  if (bench == nullptr) return;
  grasp::SearchSettings settings;
  settings.max_trials = settings.min_trials = 64;
  settings.improvements = 0;
  std::int64_t found = 0;
  std::uint64_t seed = 1;
  for (auto _ : state) {
    for (const auto& world : bench->worlds) {
      auto result = grasp::search_grasps(*world, bench->free.group, bench->free.pre_grasp, settings, seed++);
      found += static_cast<std::int64_t>(result.grasps.size()) + result.rejected["a better one was kept"];
    }
  }
  state.counters["certified"] = benchmark::Counter(static_cast<double>(found), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(contact_energy, laboratory, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(close_and_score, laboratory, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(certified_grasps, laboratory, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(contact_energy, ours, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(close_and_score, ours, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(certified_grasps, ours, false)->Unit(benchmark::kMillisecond);

}  // namespace
