// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Two-stage collision verdicts against the truth, configuration by configuration (README.md).
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "comparisons.hpp"
#include "core/rng.hpp"
#include "made_scenes.hpp"
#include "robot/load_robot.hpp"

namespace opponens::experiments {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::int64_t configurations = 1000000;
  int threads = 1;
  std::uint64_t seed = 1;
  std::string only;  ///< robot's name; empty: all
};

/// A robot and its hand alone. The checkers without a scene keep the covers and hulls of its meshes in memory.
struct Contestant {
  std::string name;
  double share;  ///< of all configurations, relative; the truth about visual meshes takes long
  robot::RobotModel robot;
  robot::RobotModel hand;
  robot::CollisionChecker kept{robot, {}};

  Contestant(std::string its_name, double its_share, const fs::path& file)
      : name(std::move(its_name)),
        share(its_share),
        robot(robot::load_robot(file)),
        hand(robot::hand_of(robot.description())) {}
};

/// The kinds of configurations and their shares.
struct Kind {
  const char* name;
  double share;
  bool flying;
  Tally (*compare)(const Subject&, std::int64_t, Rng&);
};
constexpr std::array<Kind, 5> kKinds{{{"uniform", 0.25, false, compare_uniform},
                                      {"motion", 0.3, false, compare_motions},
                                      {"contact", 0.2, false, compare_contacts},
                                      {"hand", 0.15, true, compare_flying},
                                      {"hand contact", 0.1, true, compare_flying_contacts}}};

std::vector<Contestant> contestants(const std::string& only) {
  struct Source {
    const char* name;
    double share;
    const char* file;
    bool shared;
  };
  constexpr std::array<Source, 5> kSources{
      {{"ours", 3.0, "models/ur5_allegro/ur5_allegro_right.yaml", false},
       {"lab urdf", 3.0, "tests/data/robots/paper_lab_ur5_allegro_right_urdf.yaml", true},
       {"lab visual", 1.0, "tests/data/robots/paper_lab_ur5_allegro_right_visual.yaml", true},
       {"example", 3.0, "tests/data/robots/example_ur5_allegro_right.yaml", true},
       {"dual", 1.0, "models/dual_ur5_allegro/dual_ur5_allegro.yaml", false}}};
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 0);
  const char* const data = std::getenv("OPPONENS_SHARED_DATA");
  std::vector<Contestant> all;
  all.reserve(kSources.size());
  for (const Source& source : kSources) {
    if (!only.empty() && only != source.name) continue;
    if (source.shared && !fs::exists(fs::path(data) / "data/robots")) {
      std::printf("%s: left out, its files are not in OPPONENS_SHARED_DATA\n", source.name);
      continue;
    }
    all.emplace_back(source.name, source.share, fs::path(OPPONENS_SOURCE_DIR) / source.file);
  }
  return all;
}

std::vector<robot::Scene> scenes() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(OPPONENS_SOURCE_DIR) / "models/scenes")) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<robot::Scene> all;
  for (const fs::path& file : files) all.push_back(robot::load_scene(file));
  for (robot::Scene& scene : made_scenes()) all.push_back(std::move(scene));
  return all;
}

void print(const std::string& scene, const std::string& robot, const std::string& kind, const Tally& tally) {
  const double n = std::max<double>(1.0, static_cast<double>(tally.configurations));
  std::printf("%-16s %-10s %-12s %14lld %9.1f %% %10.2f %12lld\n", scene.c_str(), robot.c_str(), kind.c_str(),
              static_cast<long long>(tally.configurations), 100.0 * static_cast<double>(tally.free) / n,
              static_cast<double>(tally.pairs_asked) / n, static_cast<long long>(tally.different));
  if (tally.different > 0) std::printf("  %s\n", tally.example.c_str());
}

void add(Tally& sum, const Tally& tally) {
  sum.configurations += tally.configurations;
  sum.free += tally.free;
  sum.different += tally.different;
  sum.pairs_asked += tally.pairs_asked;
  if (tally.different > 0) sum.example = tally.example;
}

/// Whether a robot is in collision wherever its joints are, as in a scene that was made for another one's stand.
bool stuck(const Subject& subject) {
  Rng rng(1);
  return compare_uniform(subject, 500, rng).free == 0;
}

/// All kinds for one robot in one scene; of a robot that is stuck its hand alone.
std::array<Tally, kKinds.size()> compare(const Contestant& contestant, const robot::Scene& scene, double count,
                                         std::uint64_t seed) {
  const Subject whole(contestant.robot, scene);
  const Subject hand(contestant.hand, scene);
  std::array<Tally, kKinds.size()> tallies;
  const bool hand_only = stuck(whole);
  double shares = 0.0;
  for (const Kind& kind : kKinds) shares += kind.flying || !hand_only ? kind.share : 0.0;
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    const Kind& kind = kKinds[k];
    if (hand_only && !kind.flying) continue;
    Rng rng = stream(seed, scene.name + "/" + contestant.name + "/" + kind.name);
    tallies[k] =
        kind.compare(kind.flying ? hand : whole, static_cast<std::int64_t>(count * kind.share / shares) + 1, rng);
  }
  return tallies;
}

/// Prints the table and returns its sums.
Tally compare_everything(const Options& options) {
  const std::vector<Contestant> robots = contestants(options.only);
  const std::vector<robot::Scene> all_scenes = scenes();
  double shares = 0.0;
  for (const Contestant& contestant : robots) shares += contestant.share * static_cast<double>(all_scenes.size());
  const std::size_t tasks = robots.size() * all_scenes.size();
  std::vector<std::array<Tally, kKinds.size()>> results(tasks);
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < tasks; i = next++) {
        const Contestant& contestant = robots[i % robots.size()];
        const double count = static_cast<double>(options.configurations) * contestant.share / shares;
        results[i] = compare(contestant, all_scenes[i / robots.size()], count, options.seed);
        std::fprintf(stderr, "%s in %s done\n", contestant.name.c_str(), all_scenes[i / robots.size()].name.c_str());
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (int t = 0; t < options.threads; ++t) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
  std::printf("%-16s %-10s %-12s %14s %11s %10s %12s\n", "scene", "robot", "kind", "configurations", "free", "asked",
              "differences");
  Tally sum;
  for (std::size_t i = 0; i < tasks; ++i) {
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
      if (results[i][k].configurations == 0) continue;
      print(all_scenes[i / robots.size()].name, robots[i % robots.size()].name, kKinds[k].name, results[i][k]);
      add(sum, results[i][k]);
    }
  }
  print("all", "all", "all", sum);
  return sum;
}

}  // namespace
}  // namespace opponens::experiments

int main(int argc, char** argv) {
  opponens::experiments::Options options;
  CLI::App app("Compares the verdicts of the two-stage collision checker with the truth");
  app.add_option("--configs", options.configurations, "Configurations in all")->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads, "Threads")->check(CLI::Range(1, 256));
  app.add_option("--seed", options.seed, "Seed");
  app.add_option("--robot", options.only, "Only this one: ours, 'lab urdf', 'lab visual', example, dual");
  CLI11_PARSE(app, argc, argv);
  try {
    const opponens::experiments::Tally sum = opponens::experiments::compare_everything(options);
    return sum.different == 0 && sum.configurations > 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
