// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/simulate.hpp"

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/resources.hpp"
#include "cli/simulation_model_file.hpp"
#include "cli/stored.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {

int simulate(const SimulateOptions& options, const Console& console) {
  const auto file = find_file("models/human/grasp_types.yaml");
  const auto model = load_simulation_model(file);
  analysis::SimulationSettings settings;
  settings.repetitions = options.repetitions;
  const auto motions = analysis::simulate(model, settings, options.common.seed);

  storage::Store store(options.common.store, true);
  const RunLog log(store, "simulate", 1);
  const auto origin = provenance("simulate", {}, {file},
                                 {{"repetitions", options.repetitions}, {"rate", settings.rate}}, options.common.seed);
  std::vector<storage::Record> records;
  Eigen::Index samples = 0;
  int grasps = 0;
  for (const auto& motion : motions) {
    records.push_back(storage::encode(motion, origin));
    if (motion.labels.at("kind") != "grasp") continue;
    ++grasps;
    samples += motion.time.size();
  }
  const auto ids = store.commit(records);
  log.finish(ids);
  const auto free = motions.size() - static_cast<std::size_t>(grasps);
  console.say("simulated " + std::to_string(grasps) + " grasping movements (" + std::to_string(samples) + " samples, " +
              std::to_string(model.types.size()) + " grasp types) and " + std::to_string(free) +
              " free finger motions. They say nothing about humans.");
  Json result = document("simulate");
  result.update({{"recordings", grasps}, {"samples", samples}, {"free_recordings", free}, {"ids", ids}});
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
