// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robot_yaml.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "cli/console.hpp"
#include "core/require.hpp"
#include "report/text.hpp"
#include "robot/propose_mapping.hpp"

namespace opponens::cli {
namespace {

/// A name as YAML takes it in a flow list: quoted where it could be read as something else.
std::string quoted(const std::string& name) {
  static const std::set<std::string> kWords = {"", "y", "n", "yes", "no", "on", "off", "true", "false", "null", "~"};
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '-'; };
  const bool safe = !kWords.contains(lower) && std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
                    std::all_of(name.begin(), name.end(), plain);
  if (safe) return name;
  std::string result = "'";
  for (const char c : name) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

std::string vector_yaml(const Eigen::Vector3d& v) {
  std::string text;
  for (const double value : v) text += (text.empty() ? "[" : ", ") + report::compact(value, 9);
  return text + "]";
}

std::string list_yaml(const std::vector<std::string>& names) {
  std::string text = "[";
  std::size_t line = 0;
  for (const std::string& name : names) {
    const std::string item = quoted(name);
    if (text.size() > 1) text += ",";
    if (text.size() - line + item.size() > 105) {
      line = text.size();
      text += "\n        ";
    }
    text += (text.size() > 1 ? " " : "") + item;
  }
  return text + "]";
}

void append_points(std::string& text, const robot::RobotModel& model, const std::vector<robot::SurfacePoint>& points,
                   bool named) {
  for (const auto& point : points) {
    text += "  - {" + (named ? "name: " + quoted(point.name) + ", " : std::string()) +
            "finger: " + quoted(point.finger) +
            ", link: " + quoted(model.links()[static_cast<std::size_t>(point.link)].name) +
            ", point: " + vector_yaml(point.p_L) + ", normal: " + vector_yaml(point.n_L) + "}\n";
  }
}

void append_pairs(std::string& text, const robot::RobotModel& model, const std::vector<robot::LinkPairHits>& pairs,
                  const std::string& comment) {
  if (pairs.empty()) return;
  text += "  # " + comment + "\n";
  for (const auto& pair : pairs) {
    const auto [first, second] = names_of(model, pair);
    text += "  - [" + quoted(first) + ", " + quoted(second) + "]\n";
  }
}

std::string mapping_yaml(const robot::HandMapping& mapping) {
  const Eigen::Matrix3d& R = mapping.R_robot_human;
  const Eigen::Vector3d rpy(std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
                            std::atan2(R(1, 0), R(0, 0)));
  std::string text = "mapping:\n  palm_rpy: " + vector_yaml(rpy) + "  # human palm axes in this palm: x out of it, z " +
                     "along the fingers\n  copied:\n";
  for (const auto& copy : mapping.copied) {
    text += "    - {joint: " + quoted(copy.joint) + ", channel: " + copy.channel +
            (copy.gain < 0.0 ? ", gain: -1}\n" : "}\n");
  }
  text += "  fitted: " + list_yaml(mapping.fitted) + "\n  fingertips: {";
  for (const auto& [tip, human] : mapping.fingertips) {
    const auto from = mapping.measured_from.find(tip);
    text += (text.back() == '{' ? "" : ", ") + quoted(tip) + ": " +
            (from == mapping.measured_from.end() ? human : "{tip: " + human + ", from: " + quoted(from->second) + "}");
  }
  return text + "}\n";
}

std::string robot_comment(const RobotFacts& facts, const std::string& urdf) {
  const auto& description = facts.robot.model.description();
  if (description.arm_joints.empty()) {
    return "# A robot.yaml puts this hand on an arm: docs/robot_files.md.\n";
  }
  return "# The joints above the palm, as the arm of a robot.yaml:\n# name: " + quoted(description.name) +
         "\n# arm: {urdf: " + quoted(urdf) + ", joints: [" + joined(description.arm_joints) +
         "]}\n# hand: NAME_OF_THIS_FILE.yaml\n";
}

}  // namespace

std::string contacts_yaml(const robot::RobotModel& model, const robot::ContactProposal& proposal) {
  std::string text;
  for (const std::string& note : proposal.notes) text += "# " + note + "\n";
  text += proposal.tips.empty() ? "tips: []\n" : "tips:\n";
  append_points(text, model, proposal.tips, false);
  text += proposal.contact_points.empty() ? "contact_points: []\n" : "contact_points:\n";
  append_points(text, model, proposal.contact_points, true);
  return text;
}

std::string allowed_yaml(const RobotFacts& facts) {
  require(facts.samples.has_value(), "allowed_yaml needs samples");
  const int samples = facts.samples->samples;
  const auto& suggestion = facts.suggestion;
  const auto& model = facts.robot.model;
  const std::string drawn =
      std::to_string(samples) + " random configurations (seed " + std::to_string(facts.seed) + ")";
  std::string text = "# Links of one joint or one rigid body are allowed without being listed.\n";
  for (const auto& pair : suggestion.often) {
    const auto [first, second] = names_of(model, pair);
    text += "# Not listed, to be looked at: " + first + " and " + second + " meet in " +
            report::percent(static_cast<double>(pair.hits) / samples) + "\n";
  }
  const bool none = suggestion.always.empty() && suggestion.at_rest.empty() && suggestion.never.empty();
  text += none ? "allowed_collisions: []\n" : "allowed_collisions:\n";
  append_pairs(text, model, suggestion.always, "always colliding, in " + drawn);
  append_pairs(text, model, suggestion.at_rest, "colliding with all joints at zero");
  append_pairs(text, model, suggestion.never,
               "never colliding in " + drawn + ": with 95 % confidence a pair does in at most " +
                   report::percent(robot::never_bound(samples), 2) + " of them");
  return text;
}

std::string skeleton_yaml(const RobotFacts& facts) {
  require(facts.proposal.has_value(), "skeleton_yaml needs a proposal");
  const auto& model = facts.robot.model;
  const auto& description = model.description();
  const std::string urdf = std::filesystem::absolute(facts.robot.file).lexically_normal().string();
  std::string text = "# hand.yaml to start from, made by: opponens robot " + facts.robot.file.filename().string() +
                     " --skeleton\n# Guesses, to be looked at: the palm, the fingers' names, the points, the mapping "
                     "(docs/add_your_hand.md).\n";
  for (const std::string& note : description.notes) text += "# " + note + "\n";
  for (const auto& missing : description.missing_meshes) {
    text += "# missing: link " + missing.link + ": " + missing.mesh + " " + missing.reason + "\n";
  }
  text += "urdf: " + quoted(urdf) + "\n";
  std::vector<std::string> packages;
  for (const auto& folder : facts.robot.settings.packages.roots) {
    packages.push_back(std::filesystem::absolute(folder).lexically_normal().string());
  }
  if (!packages.empty()) text += "packages: " + list_yaml(packages) + "\n";
  if (facts.robot.settings.geometry == robot::LinkGeometry::visual) text += "collision: visual\n";
  text += "palm_link: " + quoted(description.palm_link) + "\njoints: " + list_yaml(description.hand_joints) + "\n" +
          contacts_yaml(model, *facts.proposal);
  if (const auto mapping = robot::propose_mapping(model)) {
    text += mapping_yaml(*mapping);
  } else {
    text +=
        "# mapping: `opponens retarget` needs one (docs/robot_files.md); a right hand whose fingers are called thumb,\n"
        "#   index, middle, ring or little would have been given one\n";
  }
  const auto& always = facts.suggestion.always;
  if (!always.empty()) text += "allowed_collisions:\n";
  append_pairs(text, model, always, "always colliding");
  return text + robot_comment(facts, urdf);
}

}  // namespace opponens::cli
