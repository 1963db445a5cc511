// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// FRoGGeR's published grasps (Li et al. 2024): reproduced, and compared with ours. README.md beside this file.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "core/require.hpp"
#include "experiments/frogger_grasps/reproduce.hpp"
#include "experiments/frogger_grasps/search.hpp"
#include "robot/load_robot.hpp"
#include "storage/codec.hpp"
#include "storage/store.hpp"

namespace opponens {
namespace {

struct Options {
  std::filesystem::path shared;
  std::filesystem::path hand;
  std::filesystem::path csv;
  std::filesystem::path store;  ///< with a synergy set of the hand; empty: free joints
  std::string tips = "ball";
  std::string goal = "min-weight";
  bool no_table = false;
  int seeds = 20;
  int enough = 3;
};

std::vector<SynergyGroup> groups_of(const Options& options, const robot::RobotModel& hand) {
  if (options.store.empty()) {
    SynergyGroup group;
    group.name = "free";
    group.phase = "grasp";
    group.box = frogger_joint_box(hand);
    return {group};
  }
  const storage::Store store(options.store, false);
  const auto entries = store.list("synergy_set");
  if (entries.empty()) throw InputError(options.store.string() + ": holds no synergy set");
  const SynergySet set = storage::decode_synergy_set(store.read(entries.back().id));
  if (set.joint_names != hand.joint_names()) {
    throw InputError(options.store.string() + ": its last synergy set is of other joints than " +
                     options.hand.string());
  }
  return set.grasp;
}

int run(const Options& options, bool reproducing) {
  const Folders folders{options.shared / "reference/frogger", options.shared / "data/objects/ycb", options.hand};
  if (!std::filesystem::exists(folders.reference)) throw InputError(folders.reference.string() + ": is not there");
  const robot::RobotModel hand(robot::load_hand(options.hand));
  std::ofstream csv(options.csv);
  if (!csv) throw InputError(options.csv.string() + ": cannot be written");
  csv.precision(10);
  if (reproducing) {
    std::printf("not force closure: %d\n", reproduce(folders, hand, csv));
    return 0;
  }
  Comparison comparison;
  comparison.seeds = options.seeds;
  comparison.table = !options.no_table;
  comparison.groups = groups_of(options, hand);
  grasp::PrecisionSettings& settings = comparison.settings;
  settings.count = 1;
  settings.enough = options.enough;
  settings.max_trials = 200;
  settings.goal = options.goal == "epsilon" ? grasp::PrecisionGoal::epsilon : grasp::PrecisionGoal::min_weight;
  // A fixed point leaves its ball 3 mm of depth, as theirs; a ball that touches anywhere needs none.
  settings.tips = options.tips == "point" ? grasp::TipModel::fixed_point : grasp::TipModel::ball;
  settings.max_penetration = options.tips == "point" ? 0.003 : 0.001;
  compare(folders, hand, comparison, csv);
  return 0;
}

}  // namespace
}  // namespace opponens

int main(int argc, char** argv) {
  try {
    CLI::App app("FRoGGeR's published grasps, reproduced and compared with ours");
    app.require_subcommand(1);
    opponens::Options options;
    CLI::App* reproduce = app.add_subcommand("reproduce", "score the published grasps");
    CLI::App* search = app.add_subcommand("search", "find one grasp per seed and object, and compare");
    for (CLI::App* command : {reproduce, search}) {
      command->add_option("--shared", options.shared, "folder that holds reference/frogger and data/objects/ycb")
          ->required();
      command->add_option("--hand", options.hand, "hand.yaml")->required();
      command->add_option("--csv", options.csv, "file to write, one row per grasp")->required();
    }
    search->add_option("--store", options.store, "store with a synergy set of the hand's joints; default: free joints");
    search->add_option("--tips", options.tips, "ball or point")->check(CLI::IsMember({"ball", "point"}));
    search->add_option("--goal", options.goal, "min-weight or epsilon")
        ->check(CLI::IsMember({"min-weight", "epsilon"}));
    search->add_option("--seeds", options.seeds, "seeds 1 to this")->check(CLI::PositiveNumber);
    search->add_option("--enough", options.enough, "grasps found per seed, the best is kept")
        ->check(CLI::PositiveNumber);
    search->add_flag("--no-table", options.no_table, "leave out the table that FRoGGeR had");
    CLI11_PARSE(app, argc, argv);
    return opponens::run(options, reproduce->parsed());
  } catch (const std::exception& error) {
    std::cerr << "frogger_grasps: " << error.what() << '\n';
    return 2;
  }
}
