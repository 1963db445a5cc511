// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>

#include "cli/commands.hpp"
#include "cli/robot_facts.hpp"
#include "cli/robot_yaml.hpp"
#include "core/require.hpp"
#include "report/robot_drawing.hpp"

namespace opponens::cli {
namespace {

void check(const RobotOptions& options, const LoadedRobot& robot) {
  if (options.skeleton && robot.kind != RobotFileKind::urdf) {
    throw InputError("--skeleton starts from a URDF; " + robot.file.string() + " is a YAML file already");
  }
  if (options.allowed_collisions && options.samples == 0) {
    throw InputError("--allowed-collisions needs samples, found --samples 0");
  }
}

void draw_samples(const RobotOptions& options, const Console& console, RobotFacts& facts) {
  if (options.samples == 0) return;
  Progress progress(console, "self-collision");
  Rng rng = stream(options.seed, "self-collision");
  facts.samples = robot::sample_self_collisions(facts.robot.model, options.samples, progress.counter(), rng);
  facts.suggestion = robot::suggest_allowed(*facts.samples);
}

/// What a person asked to see: one of the YAML texts, or everything in words.
std::vector<std::string> lines_of(const RobotOptions& options, const RobotFacts& facts) {
  if (options.skeleton) return {skeleton_yaml(facts)};
  if (options.propose_contacts) return {contacts_yaml(facts.robot.model, *facts.proposal)};
  if (options.allowed_collisions) return {allowed_yaml(facts)};
  return robot_lines(facts);
}

/// With the proposed points when those were asked for.
void write_picture(const std::filesystem::path& path, const RobotFacts& facts) {
  const auto& description = facts.robot.model.description();
  std::ofstream file(path, std::ios::binary);
  file << report::draw_robot(facts.robot.model, facts.proposal ? facts.proposal->tips : description.tips,
                             facts.proposal ? facts.proposal->contact_points : description.contact_points);
  file.close();
  if (!file) throw InputError(path.string() + ": cannot write the picture there");
}

}  // namespace

int robot(const RobotOptions& options, const Console& console) {
  RobotFacts facts{load_any_robot(options.file, options.packages), options.seed};
  check(options, facts.robot);
  const auto& description = facts.robot.model.description();
  if (options.skeleton || options.propose_contacts) facts.proposal = robot::propose_contacts(facts.robot.model);
  if (!options.propose_contacts || console.json()) draw_samples(options, console, facts);
  if (!options.picture.empty()) {
    write_picture(options.picture, facts);
  }
  for (const std::string& line : lines_of(options, facts)) {
    console.say(!line.empty() && line.back() == '\n' ? line.substr(0, line.size() - 1) : line);
  }
  if (!options.picture.empty() && !options.skeleton && !options.propose_contacts && !options.allowed_collisions) {
    console.say("Picture: " + options.picture.string());
  }
  console.document(robot_json(facts).dump());
  return description.missing_meshes.empty() ? kDone : kNoAnswer;
}

}  // namespace opponens::cli
