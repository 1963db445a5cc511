// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <numbers>

#include "analysis/intervals.hpp"
#include "cli/console.hpp"
#include "cli/robot_facts.hpp"
#include "report/text.hpp"

namespace opponens::cli {
namespace {

using Lines = std::vector<std::string>;
using Row = std::vector<std::string>;
using report::fixed;

/// Rows with columns as wide as their widest cell; the first row is the head.
void append_table(Lines& lines, const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += "  " + row[i];
      if (i + 1 < row.size()) line += std::string(widths[i] - row[i].size(), ' ');
    }
    lines.push_back(line.substr(0, line.find_last_not_of(' ') + 1));
  }
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// Degrees or millimetres: this is text for a person.
std::string value_of(const robot::Joint& joint, double value) {
  if (joint.type == robot::JointType::prismatic) return fixed(1000.0 * value, 1) + " mm";
  return fixed(value * 180.0 / std::numbers::pi, 1) + " deg";
}

std::string role_of(const robot::RobotDescription& description, const robot::Joint& joint) {
  const auto holds = [&](const auto& names) {
    return std::find(names.begin(), names.end(), joint.name) != names.end();
  };
  if (joint.mimic) {
    const std::string factor = report::compact(joint.mimic->multiplier, 4);
    const std::string offset = joint.mimic->offset == 0.0 ? "" : " + (" + value_of(joint, joint.mimic->offset) + ")";
    return "mimics " + joint.mimic->joint + " x " + factor + offset;
  }
  if (holds(description.arm_joints)) return "arm";
  return holds(description.hand_joints) ? "hand" : "rests";
}

void append_joints(Lines& lines, const robot::RobotDescription& description) {
  std::vector<Row> rows{{"joint", "type", "lower", "upper", "velocity", "role"}};
  for (const auto& joint : description.joints) {
    if (joint.type == robot::JointType::fixed) continue;
    rows.push_back({joint.name, name_of(joint.type), value_of(joint, joint.lower), value_of(joint, joint.upper),
                    value_of(joint, joint.velocity) + "/s", role_of(description, joint)});
  }
  lines.push_back("Joints that move: " + std::to_string(rows.size() - 1) +
                  " (fixed: " + std::to_string(description.joints.size() - (rows.size() - 1)) + ")");
  append_table(lines, rows);
}

void append_links(Lines& lines, const robot::RobotModel& model) {
  std::vector<Row> rows{{"link", "boxes", "spheres", "cylinders", "meshes", "triangles", ""}};
  const auto shown = [](long long count) { return count == 0 ? std::string("-") : std::to_string(count); };
  long long triangles = 0;
  for (const auto& link : model.links()) {
    if (link.collision.empty()) continue;
    const LinkSurface surface = surface_of(link);
    triangles += surface.triangles;
    rows.push_back({link.name, shown(surface.boxes), shown(surface.spheres), shown(surface.cylinders),
                    shown(surface.meshes), shown(surface.triangles),
                    surface.open.empty() ? "" : "open, so nothing lies inside: " + joined(surface.open)});
  }
  lines.push_back("Links with geometry: " + std::to_string(rows.size() - 1) + " of " +
                  std::to_string(model.links().size()) + ", " + std::to_string(triangles) + " triangles");
  if (rows.size() > 1) append_table(lines, rows);
}

std::string per_finger(const std::vector<robot::SurfacePoint>& points) {
  Lines order;
  std::map<std::string, int> count;
  for (const auto& point : points) {
    if (++count[point.finger] == 1) order.push_back(point.finger);
  }
  Lines parts;
  for (const auto& finger : order) parts.push_back(finger + " " + std::to_string(count[finger]));
  return parts.empty() ? "none; --propose-contacts finds some" : joined(parts);
}

void append_hand(Lines& lines, const robot::RobotDescription& description) {
  if (!description.arm_joints.empty()) {
    lines.push_back("Arm: " + counted(description.arm_joints.size(), "joint") +
                    (description.arm_tip_link.empty() ? "" : ", ends at " + description.arm_tip_link) + ": " +
                    joined(description.arm_joints));
  }
  lines.push_back("Hand: " + counted(description.hand_joints.size(), "joint") + ", palm " + description.palm_link +
                  (description.hand_joints.empty() ? "" : ": " + joined(description.hand_joints)));
  Lines tips;
  for (const auto& tip : description.tips) {
    tips.push_back(tip.name + " (" + description.links[static_cast<std::size_t>(tip.link)].name + ")");
  }
  lines.push_back("Tips: " + (tips.empty() ? std::string("none; --propose-contacts finds some") : joined(tips)));
  lines.push_back("Contact points: " + per_finger(description.contact_points));
  for (const auto& srdf : description.semantics) {
    Lines names;
    for (const auto& group : srdf.groups) names.push_back(group.name);
    lines.push_back("SRDF " + srdf.file.filename().string() + ": " + counted(srdf.disabled.size(), "disabled pair") +
                    ", groups: " + (names.empty() ? "none" : joined(names)) + ", " +
                    counted(srdf.end_effectors.size(), "end effector") + ", " +
                    counted(srdf.group_states.size(), "group state"));
  }
}

void append_pairs(Lines& lines, const RobotFacts& facts, const std::vector<robot::LinkPairHits>& pairs,
                  const std::string& what) {
  if (pairs.empty()) return;
  lines.push_back("  " + what + ": " + counted(pairs.size(), "pair"));
  for (const auto& pair : pairs) {
    const auto [first, second] = names_of(facts.robot.model, pair);
    lines.push_back("    [" + first + ", " + second + "]  " +
                    report::percent(static_cast<double>(pair.hits) / facts.samples->samples));
  }
}

/// The three pairs that are checked and meet most.
void append_most_frequent(Lines& lines, const RobotFacts& facts) {
  std::vector<robot::LinkPairHits> pairs = facts.samples->pairs;
  std::erase_if(pairs, [](const auto& pair) { return pair.allowed || pair.hits == 0; });
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.hits > b.hits; });
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, pairs.size()); ++i) {
    const auto [first, second] = names_of(facts.robot.model, pairs[i]);
    text += (text.empty() ? "" : ", ") + first + " and " + second + " " +
            report::percent(static_cast<double>(pairs[i].hits) / facts.samples->samples);
  }
  if (!text.empty()) lines.push_back("  most often: " + text);
}

void append_self_collision(Lines& lines, const RobotFacts& facts) {
  if (!facts.samples) return;
  const auto& samples = *facts.samples;
  const std::string drawn = counted(static_cast<std::size_t>(samples.samples), "random configuration");
  if (samples.pairs.empty()) {
    lines.push_back("Self-collision: no two links have geometry");
    return;
  }
  const auto interval = analysis::proportion_interval(samples.colliding, samples.samples, 0.95);
  lines.push_back("Self-collision: " + report::percent(static_cast<double>(samples.colliding) / samples.samples) +
                  " of " + drawn + " (95 % interval " + report::percent(interval.low) + " to " +
                  report::percent(interval.high) + "; seed " + std::to_string(facts.seed) + ")" +
                  (facts.robot.model.description().missing_meshes.empty() ? "" : ", without the missing meshes"));
  append_most_frequent(lines, facts);
  const auto count = [&](auto member) { return std::count_if(samples.pairs.begin(), samples.pairs.end(), member); };
  const auto adjacent = count([](const auto& pair) { return pair.adjacent; });
  const auto listed = count([](const auto& pair) { return pair.allowed && !pair.adjacent; });
  lines.push_back("Pairs of links: " + std::to_string(samples.pairs.size()) + ", adjacent (allowed unlisted) " +
                  std::to_string(adjacent) + ", allowed by the files " + std::to_string(listed) +
                  ". Of the others --allowed-collisions prints as YAML:");
  append_pairs(lines, facts, facts.suggestion.always, "always colliding");
  append_pairs(lines, facts, facts.suggestion.at_rest, "colliding with all joints at zero");
  append_pairs(lines, facts, facts.suggestion.often, "often colliding, not suggested");
  lines.push_back("  never colliding: " + counted(facts.suggestion.never.size(), "pair") + " (never in " + drawn +
                  ": with 95 % confidence a pair does in at most " +
                  report::percent(robot::never_bound(samples.samples), 2) + ")");
}

std::string kind_words(RobotFileKind kind) {
  if (kind == RobotFileKind::robot_yaml) return "arm and hand";
  return kind == RobotFileKind::hand_yaml ? "hand alone" : "URDF alone; --skeleton makes a hand.yaml of it";
}

}  // namespace

std::vector<std::string> robot_lines(const RobotFacts& facts) {
  const auto& description = facts.robot.model.description();
  Lines lines{description.name + " (" + kind_words(facts.robot.kind) + ")"};
  append_hand(lines, description);
  append_joints(lines, description);
  append_links(lines, facts.robot.model);
  if (!description.missing_meshes.empty()) {
    lines.push_back("Missing meshes: " + std::to_string(description.missing_meshes.size()) +
                    "; other commands refuse this robot");
    for (const auto& missing : description.missing_meshes) {
      lines.push_back("  link " + missing.link + ": " + missing.mesh + " " + missing.reason);
    }
  }
  if (!description.notes.empty()) lines.push_back("Ignored or assumed:");
  for (const auto& note : description.notes) lines.push_back("  " + note);
  append_self_collision(lines, facts);
  return lines;
}

}  // namespace opponens::cli
