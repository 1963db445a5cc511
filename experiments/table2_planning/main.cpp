// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The paper's Table 2 on our scenes: each planner at the best of its ranges, found on other seeds.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <ompl/util/Console.h>
#include <CLI/CLI.hpp>

#include "experiments/table2_planning/output.hpp"

namespace opponens::table2 {
namespace {

struct Options {
  std::string robot = "models/ur5_allegro/ur5_allegro_right.yaml";
  std::string scene = "models/scenes/cylinder_shelf.yaml";
  std::string store, covers, grasps, out;
  std::vector<std::string> cases{"a", "b", "c", "d", "e", "ompl_rrtconnect", "ompl_lbkpiece1", "ompl_bitrrt"};
  std::vector<double> ranges{0.1, 0.2, 0.4, 0.8, 1.6, 3.2};
  std::string baseline = "a";
  int tuning_seeds = 20;
  double resolution = 0.02;
  double hand_weight = 1.0;
  RunSettings runs;
};

/// The best range of each case; the only one given needs no search.
std::vector<Trial> tuned(const Setting& setting, const Options& options, Report& report, std::string& csv) {
  std::vector<Trial> trials;
  for (const std::string& name : options.cases) {
    for (const double range : options.ranges) trials.push_back({parse_case(name), range});
  }
  if (options.ranges.size() == 1) return trials;
  RunSettings settings = options.runs;
  settings.seeds = options.tuning_seeds;
  settings.first_seed = 1000001;
  settings.verified_share = 0.0;
  report.tuned_with = settings;
  const Results results = run_all(setting, trials, settings);
  csv = csv_of(results.records);
  for (const Trial& trial : trials) report.tried.push_back(summarize(results.records, trial.what.name, trial.range));
  std::vector<Trial> best;
  for (const std::string& name : options.cases) {
    best.push_back({parse_case(name), best_range(results.records, name)});
  }
  return best;
}

void run(const Options& options) {
  Setting setting =
      load_setting({options.robot, options.scene, options.store, options.grasps, options.covers, options.hand_weight});
  setting.resolution = options.resolution;
  std::filesystem::create_directories(options.out);
  const std::filesystem::path out = options.out;
  Report report;
  report.scene = setting.scene.name;
  report.robot = setting.robot.description().name;
  report.grasps = std::filesystem::path(options.grasps).filename().string();
  report.likeness_reference = setting.free_motion ? setting.free_motion->name : "nothing: no free motions in the store";
  std::string tuning_csv;
  const std::vector<Trial> trials = tuned(setting, options, report, tuning_csv);
  if (!tuning_csv.empty()) write_text(out / "tuning.csv", tuning_csv);
  report.reported_with = options.runs;
  const Results results = run_all(setting, trials, options.runs);
  report.queries = results.queries;
  for (const Trial& trial : trials) {
    report.rows.push_back(summarize(results.records, trial.what.name, trial.range));
    if (trial.what.name != options.baseline) {
      report.comparisons.push_back(compare(results.records, trial.what.name, options.baseline));
    }
  }
  std::erase_if(report.comparisons, [](const Comparison& one) { return one.pairs == 0; });
  write_text(out / "runs.csv", csv_of(results.records));
  write_text(out / "result.json", json_of(report));
  write_text(out / "table.md", markdown_of(report));
  std::printf("%s", markdown_of(report).c_str());
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--robot", options.robot);
  app.add_option("--scene", options.scene);
  app.add_option("--store", options.store, "synergies and free motions of the hand")->required();
  app.add_option("--grasps", options.grasps, "predefined grasps of the scene's object")->required();
  app.add_option("--covers", options.covers, "folder that keeps what is made of meshes");
  app.add_option("--out", options.out)->required();
  app.add_option("--cases", options.cases, "a, b, c, d, e, ompl_rrtconnect, ompl_lbkpiece1, ompl_bitrrt; +full=P ...")
      ->delimiter(',');
  app.add_option("--ranges", options.ranges, "rad; one alone is taken without a search")->delimiter(',');
  app.add_option("--baseline", options.baseline, "case that the others are compared with");
  app.add_option("--tuning-seeds", options.tuning_seeds)->check(CLI::PositiveNumber);
  app.add_option("--seeds", options.runs.seeds)->check(CLI::PositiveNumber);
  app.add_option("--first-seed", options.runs.first_seed);
  app.add_option("--budget", options.runs.budget, "checks per run")->check(CLI::PositiveNumber);
  app.add_option("--threads", options.runs.threads)->check(CLI::PositiveNumber);
  app.add_option("--verify", options.runs.verified_share, "share of the seeds whose paths are proven");
  app.add_option("--resolution", options.resolution, "rad")->check(CLI::PositiveNumber);
  app.add_option("--hand-weight", options.hand_weight, "of every hand joint in the metric, all planners")
      ->check(CLI::PositiveNumber);
}

}  // namespace
}  // namespace opponens::table2

int main(int count, char** arguments) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);  // it calls setting a seed more than once an error
  CLI::App app{"table2_planning: the paper's Table 2 on our scenes"};
  opponens::table2::Options options;
  opponens::table2::add_options(app, options);
  CLI11_PARSE(app, count, arguments);
  try {
    opponens::table2::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "table2_planning: %s\n", error.what());
    return 2;
  }
  return 0;
}
