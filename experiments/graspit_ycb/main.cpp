// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Grasps of the ten YCB meshes by the laboratory's Allegro, beside the published best of GraspIt! on the same meshes.
// One line of CSV for each object, hand (free joints, or the groups of a store) and seed.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "experiments/graspit_ycb/peer.hpp"
#include "grasp/free_joints.hpp"
#include "grasp/grasp_search.hpp"
#include "grasp/quality.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "storage/codec.hpp"
#include "storage/store.hpp"

namespace {

using namespace opponens;

struct Options {
  std::string shared;
  std::string store;
  std::vector<std::string> objects;
  int seeds = 5;
  int trials = 640;
  int improvements = 40;
};

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double mean(const std::vector<double>& values) {
  return values.empty() ? 0.0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Of those with a value: GraspIt!'s that face normals leave open do not count against it.
double mean_of_closed(std::vector<double> values) {
  std::erase_if(values, [](double value) { return value <= 0.0; });
  return mean(values);
}

/// Epsilon with the normals of the triangles that hold the contact points; 0 where that is no closure.
double by_face_normals(const Grasp& grasp, const robot::MeshDistance& object) {
  std::vector<Contact> contacts = grasp.contacts;
  const robot::TriangleMesh& mesh = object.mesh();
  for (Contact& contact : contacts) {
    const Eigen::Vector3i t = mesh.triangles.col(object.query(contact.p_OC).triangle);
    const Eigen::Vector3d a = mesh.vertices.col(t[0]);
    const Eigen::Vector3d ab = mesh.vertices.col(t[1]) - a;
    const Eigen::Vector3d ac = mesh.vertices.col(t[2]) - a;
    contact.n_O = -ab.cross(ac).normalized();
  }
  const GraspQuality quality = grasp::evaluate(contacts, grasp.quality.convention);
  return quality.force_closure() ? quality.epsilon.value_or(0.0) : 0.0;
}

/// What the fingers may do: a name, and for each group its box and the pre-grasp box.
struct Hand {
  std::string name;
  std::vector<grasp::FreeJoints> groups;
};

std::vector<Hand> hands_of(const Options& options, const robot::RobotModel& hand) {
  std::vector<Hand> hands{{"free", {grasp::free_joints(hand)}}};
  if (options.store.empty()) return hands;
  const storage::Store store(options.store, false);
  const auto sets = store.list("synergy_set");
  if (sets.empty()) throw std::runtime_error(options.store + ": no synergies; run: opponens analyze");
  const SynergySet set = storage::decode_synergy_set(store.read(sets.back().id));
  Hand named{"synergies", {}};
  for (const SynergyGroup& group : set.grasp) named.groups.push_back({group, set.pre_grasp.box});
  hands.push_back(named);
  return hands;
}

/// All groups share the trials; the best five different grasps of all are the answer.
void run(const Options& options, const grasp::SearchWorld& world, const Hand& hand, int seed, const std::string& object,
         const experiments::PeerResult& peer) {
  grasp::SearchSettings settings;
  const auto groups = static_cast<int>(hand.groups.size());
  settings.max_trials = settings.min_trials = std::max(1, options.trials / groups);
  settings.improvements = std::max(1, options.improvements / groups);
  const double start = cpu_seconds();
  std::vector<Grasp> found;
  std::int64_t closures = 0;
  for (const auto& [group, pre_grasp] : hand.groups) {
    auto result = grasp::search_grasps(world, group, pre_grasp, settings, static_cast<std::uint64_t>(seed));
    closures += static_cast<std::int64_t>(result.grasps.size()) + result.rejected["a better one was kept"];
    for (Grasp& one : result.grasps) found.push_back(std::move(one));
  }
  const double cpu = cpu_seconds() - start;
  std::vector<double> own;
  std::vector<double> faces;
  int along = 0;
  for (const std::size_t i : grasp::distinct_grasps(found, 5, settings.distances)) {
    own.push_back(found[i].quality.epsilon.value_or(0.0));
    faces.push_back(by_face_normals(found[i], *world.target.distance));
    along += found[i].synergy_grasp ? 1 : 0;
  }
  const double bar = std::max(mean_of_closed(peer.by_face_normal), mean(peer.by_qhull));
  std::printf("%s,%s,%d,%d,%.2f,%lld,%.1f,%zu,%d,%.4f,%.4f,%.4f,%.4f,%s\n", object.c_str(), hand.name.c_str(), seed,
              settings.max_trials * groups, cpu, static_cast<long long>(closures), static_cast<double>(closures) / cpu,
              own.size(), along, mean(own), mean(faces), mean_of_closed(peer.by_face_normal), mean(peer.by_qhull),
              mean(faces) > bar && faces.size() == 5 ? "better" : "NOT better");
  std::fflush(stdout);
}

void run_all(const Options& options) {
  setenv("OPPONENS_SHARED_DATA", options.shared.c_str(), 1);
  const std::filesystem::path shared = options.shared;
  const auto peer = experiments::read_peer(shared / "reference/graspit_ycb.csv");
  const robot::RobotModel hand(robot::load_hand(OPPONENS_SOURCE_DIR "/experiments/graspit_ycb/laboratory_hand.yaml"));
  const std::vector<Hand> hands = hands_of(options, hand);
  std::puts(
      "object,hand,seed,trials,cpu_s,certified,certified_per_s,kept,along_synergies,eps_top5,eps_top5_facenormal,"
      "graspit_facenormal,graspit_qt,verdict");
  for (const auto& [object, result] : peer) {
    if (!options.objects.empty() && std::count(options.objects.begin(), options.objects.end(), object) == 0) continue;
    robot::Scene scene;
    scene.object = object;
    const auto mesh = robot::load_mesh(shared / "data/objects/ycb" / object / (object + ".obj"));
    scene.bodies.push_back({object, Eigen::Isometry3d::Identity(), {{mesh, Eigen::Isometry3d::Identity()}}});
    const double start = cpu_seconds();
    const grasp::SearchWorld world = grasp::make_search_world(hand, scene, object, 1);
    std::fprintf(stderr, "%s: %.2f s of CPU to prepare\n", object.c_str(), cpu_seconds() - start);
    for (const Hand& one : hands) {
      for (int seed = 1; seed <= options.seeds; ++seed) run(options, world, one, seed, object, result);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Grasps of the YCB meshes beside GraspIt!'s best");
  app.add_option("--shared", options.shared, "Folder with reference/graspit_ycb.csv, data/objects and data/robots")
      ->required();
  app.add_option("--store", options.store, "Also along the newest synergies of this store");
  app.add_option("--object", options.objects, "Only these objects");
  app.add_option("--seeds", options.seeds, "Seeds 1 to N")->capture_default_str();
  app.add_option("--trials", options.trials, "Trials of each seed")->capture_default_str();
  app.add_option("--improvements", options.improvements, "Closings from neighbouring poses of each of the best ten")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    run_all(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
  return 0;
}
