// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The two-stage collision checker beside plain FCL, on the motions that a planner asks about in front of the shelf and
// on configurations next to contact. Both answer the same questions in the same iteration; the counters are what
// counts: microseconds of CPU time for each configuration that the peer evaluates, and the ratios.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "fcl_peer.hpp"
#include "motion/edge_check.hpp"
#include "robot/collision.hpp"
#include "shelf_motions.hpp"

namespace opponens::benchmarks {
namespace {

constexpr std::size_t kMotions = 300;
constexpr double kNextToContact = 1e-3;  ///< of a motion, between the two configurations kept on either side

std::filesystem::path data(const char* file) { return std::filesystem::path(OPPONENS_SOURCE_DIR) / file; }

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Adds the CPU time of a call to a total.
template <typename Work>
void timed(double& seconds, const Work& work) {
  const double begin = cpu_seconds();
  work();
  seconds += cpu_seconds() - begin;
}

struct Contestants {
  ShelfProblem problem;
  robot::CollisionChecker checker;
  robot::CollisionChecker portable;
  FclPeer peer;
  std::vector<robot::ConfigurationBatch> motions;
  robot::ConfigurationBatch near_contact;

  explicit Contestants(const char* robot_yaml)
      : problem(shelf_problem(data(robot_yaml), data("models/scenes/cylinder_shelf.yaml"))),
        checker(problem.robot, problem.scene),
        portable(problem.robot, problem.scene, {}, {.portable = true}),
        peer(problem.robot, problem.scene) {
    const std::vector<Motion> recorded = record_motions(problem, kMotions);
    std::vector<Eigen::VectorXd> next_to_contact;
    for (const Motion& motion : recorded) {
      motions.emplace_back(configurations_of(motion, problem.robot.weights()));
      if (const auto row = checker.first_colliding(motions.back())) {
        for (const auto& q : either_side(motion.from, motions.back().row(*row).transpose()))
          next_to_contact.push_back(q);
      }
    }
    near_contact.resize(static_cast<Eigen::Index>(next_to_contact.size()), problem.robot.dof());
    for (std::size_t i = 0; i < next_to_contact.size(); ++i) {
      near_contact.row(static_cast<Eigen::Index>(i)) = next_to_contact[i];
    }
  }

  /// Bisection between a free and a colliding configuration: one of each, kNextToContact of their distance apart.
  std::vector<Eigen::VectorXd> either_side(Eigen::VectorXd free, Eigen::VectorXd colliding) const {
    for (double apart = 1.0; apart > kNextToContact; apart *= 0.5) {
      const Eigen::VectorXd middle = 0.5 * (free + colliding);
      (checker.free(middle) ? free : colliding) = middle;
    }
    return {free, colliding};
  }
};

/// differing: verdicts that are not the peer's. FCL's iterations tell shapes that touch within its tolerance of 1e-6 m
/// apart or not by which of the two it is given first, and the peer's trees give them in changing order: a few.
void report(benchmark::State& state, double peer, double ours, double limit, std::int64_t configurations,
            std::int64_t differing) {
  const double each = 1e6 / static_cast<double>(configurations);
  state.counters["peer_us"] = peer * each;
  state.counters["ours_us"] = ours * each;
  state.counters["ratio"] = peer / ours;
  state.counters["differing"] = static_cast<double>(differing) / static_cast<double>(configurations);
  if (limit > 0.0) state.counters["of_limit"] = ours / limit;
}

/// Every motion, up to its first colliding configuration. The limit is the first stage alone on the same batches.
void along_motions(benchmark::State& state, const char* robot_yaml, bool portable) {
  Contestants all(robot_yaml);
  const robot::CollisionChecker& checker = portable ? all.portable : all.checker;
  double peer = 0.0;
  double ours = 0.0;
  double limit = 0.0;
  std::int64_t configurations = 0;
  std::int64_t free = 0;
  std::int64_t differing = 0;
  robot::CollisionCounts counts;
  for (const auto& motion : all.motions)
    benchmark::DoNotOptimize(checker.first_colliding(motion));  // makes FCL's trees
  for (auto _ : state) {
    for (const auto& motion : all.motions) {
      Eigen::Index first = 0;
      timed(peer, [&] {
        while (first < motion.rows() && all.peer.free(motion.row(first).transpose())) ++first;
      });
      const bool collides = first < motion.rows();
      configurations += first + (collides ? 1 : 0);
      free += first;
      std::optional<int> row;
      timed(ours, [&] { row = checker.first_colliding(motion, &counts); });
      differing += row.value_or(static_cast<int>(motion.rows())) != first;
      const robot::ConfigurationBatch asked = motion.topRows(std::min<Eigen::Index>(motion.rows(), first + 1));
      timed(limit, [&] { benchmark::DoNotOptimize(checker.cleared_rows(asked)); });
    }
  }
  report(state, peer, ours, limit, configurations, differing);
  state.counters["free_share"] = static_cast<double>(free) / static_cast<double>(configurations);
  state.counters["pairs_asked"] = static_cast<double>(counts.pairs) / static_cast<double>(counts.configurations);
}

/// One configuration at a time, half of them free and half colliding, all next to contact.
void single_near_contact(benchmark::State& state, const char* robot_yaml) {
  Contestants all(robot_yaml);
  double peer = 0.0;
  double ours = 0.0;
  std::int64_t configurations = 0;
  std::int64_t differing = 0;
  for (Eigen::Index i = 0; i < all.near_contact.rows(); ++i) all.checker.free(all.near_contact.row(i).transpose());
  for (auto _ : state) {
    std::vector<bool> verdicts;
    timed(peer, [&] {
      for (Eigen::Index i = 0; i < all.near_contact.rows(); ++i) {
        verdicts.push_back(all.peer.free(all.near_contact.row(i).transpose()));
      }
    });
    timed(ours, [&] {
      for (Eigen::Index i = 0; i < all.near_contact.rows(); ++i) {
        differing += all.checker.free(all.near_contact.row(i).transpose()) != verdicts[static_cast<std::size_t>(i)];
      }
    });
    configurations += all.near_contact.rows();
  }
  report(state, peer, ours, 0.0, configurations, differing);
  state.counters["configurations"] = static_cast<double>(all.near_contact.rows());
}

const char* const kOwn = "models/ur5_allegro/ur5_allegro_right.yaml";
const char* const kPrimitives = "tests/data/robots/paper_lab_ur5_allegro_right_urdf.yaml";
const char* const kMeshes = "tests/data/robots/paper_lab_ur5_allegro_right_visual.yaml";

void add_benchmarks() {
  const auto add = [](const char* name, const char* robot) {
    const std::string kind(name);
    benchmark::RegisterBenchmark(("along_motions/" + kind).c_str(), along_motions, robot, false);
    benchmark::RegisterBenchmark(("along_motions_portable/" + kind).c_str(), along_motions, robot, true);
    benchmark::RegisterBenchmark(("single_near_contact/" + kind).c_str(), single_near_contact, robot);
  };
  add("own_primitives", kOwn);
  if (!std::filesystem::exists(OPPONENS_SHARED_DATA)) return;  // the laboratory's robot is not part of the repository
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 0);
  add("laboratory_primitives", kPrimitives);
  add("laboratory_visual_meshes", kMeshes);
}

const bool kAdded = (add_benchmarks(), true);

}  // namespace
}  // namespace opponens::benchmarks
