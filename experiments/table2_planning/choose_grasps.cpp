// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Chooses the predefined grasps of table2_planning: of a store's grasps of the object, the best two different ones of
// each group that the arm reaches from every jittered base in all the given scenes. Looks at no planner.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "experiments/table2_planning/grasp_file.hpp"
#include "experiments/table2_planning/problem.hpp"
#include "storage/codec.hpp"
#include "storage/store.hpp"

namespace opponens::table2 {
namespace {

struct Options {
  std::string robot, store, out, covers, hand = "Allegro right";
  std::vector<std::string> scenes;
  int count = 2;
  int seeds = 20;
};

struct Candidate {
  Grasp grasp;
  std::vector<int> reached;  ///< [scenes] jittered bases from which the arm reaches it
  int least = 0;
};

std::vector<Grasp> grasps_of(const storage::Store& store, const std::string& object) {
  std::vector<Grasp> grasps;
  for (const auto& entry : store.list("grasp")) {
    const storage::Record record = store.read(entry.id);
    const auto parameters = nlohmann::json::parse(record.provenance.parameters);
    if (parameters.at("world").at("object") == object) grasps.push_back(storage::decode_grasp(record));
  }
  return grasps;
}

/// Whether two grasps look different: the palm is elsewhere by 2 cm or turned by 20 degrees.
bool different(const Grasp& a, const Grasp& b) {
  constexpr double kApart = 0.02;    // m
  constexpr double kTurned = 0.349;  // rad
  const double turn = Eigen::AngleAxisd(a.X_OH.linear().transpose() * b.X_OH.linear()).angle();
  return (a.X_OH.translation() - b.X_OH.translation()).norm() > kApart || turn > kTurned;
}

std::vector<Candidate> candidates_of(const Options& options, std::string& object) {
  std::vector<Candidate> candidates;
  for (const std::string& scene : options.scenes) {
    Setting setting = load_setting({options.robot, scene, options.store, {}, options.covers});
    object = setting.object;
    if (candidates.empty()) {
      for (Grasp& grasp : grasps_of(storage::Store(options.store, false), object)) candidates.push_back({grasp, {}});
    }
    for (const Candidate& candidate : candidates) setting.grasps.push_back(candidate.grasp);
    for (Candidate& candidate : candidates) candidate.reached.push_back(0);
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const Problem problem(setting, static_cast<std::uint64_t>(seed));
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        candidates[i].reached.back() += problem.reasons()[i].empty() ? 1 : 0;
      }
    }
  }
  for (Candidate& c : candidates) c.least = *std::min_element(c.reached.begin(), c.reached.end());
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::pair(a.least, a.grasp.quality.epsilon.value_or(0.0)) >
           std::pair(b.least, b.grasp.quality.epsilon.value_or(0.0));
  });
  return candidates;
}

void choose(const Options& options) {
  PredefinedGrasps chosen{options.hand, "", {}};
  const std::vector<Candidate> candidates = candidates_of(options, chosen.object);
  const SynergySet synergies =
      load_setting({options.robot, options.scenes.front(), options.store, {}, options.covers}).synergies;
  for (const SynergyGroup& group : synergies.grasp) {
    const std::size_t first = chosen.grasps.size();
    int known = 0;
    for (const Candidate& candidate : candidates) {
      if (candidate.grasp.group != group.name) continue;
      ++known;
      const bool fresh = std::all_of(chosen.grasps.begin() + static_cast<std::ptrdiff_t>(first), chosen.grasps.end(),
                                     [&](const Grasp& other) { return different(candidate.grasp, other); });
      if (!fresh || chosen.grasps.size() - first >= static_cast<std::size_t>(options.count)) continue;
      chosen.grasps.push_back(candidate.grasp);
      std::printf("%s: epsilon %.4f, reached from", group.name.c_str(), candidate.grasp.quality.epsilon.value_or(0.0));
      for (const int reached : candidate.reached) std::printf(" %d", reached);
      std::printf(" of %d bases\n", options.seeds);
    }
    std::printf("%s: %d grasps to choose from\n", group.name.c_str(), known);
  }
  std::vector<std::string> joints = synergies.joint_names;
  save_grasps(options.out, chosen, joints);
}

}  // namespace
}  // namespace opponens::table2

int main(int count, char** arguments) {
  CLI::App app{"choose_grasps: predefined grasps for table2_planning"};
  opponens::table2::Options options;
  app.add_option("--robot", options.robot)->required();
  app.add_option("--scene", options.scenes)->required();
  app.add_option("--store", options.store)->required();
  app.add_option("--hand", options.hand, "what the file says of hand and object");
  app.add_option("--out", options.out)->required();
  app.add_option("--covers", options.covers, "folder that keeps what is made of meshes");
  app.add_option("--seeds", options.seeds);
  CLI11_PARSE(app, count, arguments);
  try {
    opponens::table2::choose(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "choose_grasps: %s\n", error.what());
    return 2;
  }
  return 0;
}
