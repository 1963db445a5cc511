// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robot_facts.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <variant>

#include "analysis/intervals.hpp"
#include "cli/resources.hpp"
#include "core/require.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "robot/text_file.hpp"
#include "robot/yaml_file.hpp"

namespace opponens::cli {
namespace {

namespace fs = std::filesystem;

RobotFileKind kind_of(const fs::path& file) {
  const std::string text = robot::read_text_file(file, "a robot.yaml, a hand.yaml or a URDF");
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (file.extension() == ".xacro" || text.find("<xacro:") != std::string::npos) {
    throw InputError(file.string() + ": is xacro, expected a URDF; make one with: xacro FILE > robot.urdf");
  }
  if (file.extension() == ".urdf" || (first != std::string::npos && text[first] == '<')) return RobotFileKind::urdf;
  const robot::YamlValue yaml = robot::YamlValue::load(file);
  if (yaml.is_map() && yaml.has("palm_link")) return RobotFileKind::hand_yaml;
  if (yaml.is_map() && (yaml.has("hand") || yaml.has("arms"))) return RobotFileKind::robot_yaml;
  throw InputError(file.string() + ": is neither a robot.yaml (key hand), a hand.yaml (key palm_link) nor a URDF");
}

bool any_shape(const robot::RobotDescription& description) {
  return !description.missing_meshes.empty() ||
         std::any_of(description.links.begin(), description.links.end(),
                     [](const robot::Link& link) { return !link.collision.empty(); });
}

robot::RobotDescription load_urdf(const fs::path& file, robot::UrdfSettings& settings) {
  robot::RobotDescription description = robot::load_urdf(file, settings);
  if (any_shape(description)) return description;
  settings.geometry = robot::LinkGeometry::visual;
  description = robot::load_urdf(file, settings);
  if (any_shape(description)) description.notes.push_back("no link has a <collision>: the <visual> shapes are used");
  return description;
}

std::string kind_name(RobotFileKind kind) {
  if (kind == RobotFileKind::robot_yaml) return "robot";
  return kind == RobotFileKind::hand_yaml ? "hand" : "urdf";
}

Json points_json(const robot::RobotModel& model, const std::vector<robot::SurfacePoint>& points) {
  Json list = Json::array();
  for (const auto& point : points) {
    list.push_back({{"name", point.name},
                    {"finger", point.finger},
                    {"link", model.links()[static_cast<std::size_t>(point.link)].name},
                    {"p", array(point.p_L)},
                    {"n", array(point.n_L)}});
  }
  return list;
}

Json joints_json(const robot::RobotModel& model) {
  const auto& description = model.description();
  const auto& arm = description.arm_joints;
  const auto& hand = description.hand_joints;
  const auto holds = [](const auto& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  Json joints = Json::array();
  for (const auto& joint : description.joints) {
    const bool moves = joint.type != robot::JointType::fixed;
    Json json{{"name", joint.name},
              {"type", name_of(joint.type)},
              {"parent", description.links[static_cast<std::size_t>(joint.parent)].name},
              {"child", description.links[static_cast<std::size_t>(joint.child)].name},
              {"lower", moves ? number(joint.lower) : Json(nullptr)},
              {"upper", moves ? number(joint.upper) : Json(nullptr)},
              {"velocity", moves ? number(joint.velocity) : Json(nullptr)},
              {"acceleration",
               moves ? number(joint.acceleration.value_or(robot::kAccelerationRate * joint.velocity)) : Json(nullptr)},
              {"mimic", nullptr},
              {"group", nullptr}};
    if (joint.mimic) {
      json["mimic"] = {
          {"joint", joint.mimic->joint}, {"multiplier", joint.mimic->multiplier}, {"offset", joint.mimic->offset}};
    }
    if (holds(arm, joint.name)) json["group"] = "arm";
    if (holds(hand, joint.name)) json["group"] = "hand";
    joints.push_back(std::move(json));
  }
  return joints;
}

Json links_json(const robot::RobotModel& model) {
  Json links = Json::array();
  for (const auto& link : model.links()) {
    const LinkSurface surface = surface_of(link);
    links.push_back({{"name", link.name},
                     {"boxes", surface.boxes},
                     {"spheres", surface.spheres},
                     {"cylinders", surface.cylinders},
                     {"meshes", surface.meshes},
                     {"triangles", surface.triangles},
                     {"open_meshes", surface.open}});
  }
  return links;
}

Json srdf_json(const robot::Srdf& srdf) {
  Json json{{"file", srdf.file.string()},
            {"groups", Json::array()},
            {"end_effectors", Json::array()},
            {"group_states", Json::array()},
            {"disabled_pairs", srdf.disabled.size()}};
  for (const auto& group : srdf.groups) {
    Json chains = Json::array();
    for (const auto& [base, tip] : group.chains) chains.push_back({base, tip});
    json["groups"].push_back({{"name", group.name},
                              {"joints", group.joints},
                              {"links", group.links},
                              {"chains", chains},
                              {"groups", group.groups}});
  }
  for (const auto& effector : srdf.end_effectors) {
    json["end_effectors"].push_back(
        {{"name", effector.name}, {"parent_link", effector.parent_link}, {"group", effector.group}});
  }
  for (const auto& state : srdf.group_states) {
    json["group_states"].push_back({{"name", state.name}, {"group", state.group}, {"joints", state.joints}});
  }
  return json;
}

Json pairs_json(const robot::RobotModel& model, const std::vector<robot::LinkPairHits>& pairs) {
  Json list = Json::array();
  for (const auto& pair : pairs) {
    const auto [first, second] = names_of(model, pair);
    list.push_back({first, second});
  }
  return list;
}

Json self_collision_json(const RobotFacts& facts) {
  if (!facts.samples) return nullptr;
  const auto& samples = *facts.samples;
  const analysis::Interval interval = analysis::proportion_interval(samples.colliding, samples.samples, 0.95);
  Json pairs = Json::array();
  std::vector<robot::LinkPairHits> adjacent;
  for (const auto& pair : samples.pairs) {
    if (pair.adjacent) adjacent.push_back(pair);
    if (pair.hits == 0 && !pair.at_rest) continue;
    const auto [first, second] = names_of(facts.robot.model, pair);
    pairs.push_back({{"links", {first, second}},
                     {"share", static_cast<double>(pair.hits) / samples.samples},
                     {"at_rest", pair.at_rest},
                     {"adjacent", pair.adjacent},
                     {"allowed", pair.allowed}});
  }
  return {{"samples", samples.samples},
          {"seed", facts.seed},
          {"colliding", samples.colliding},
          {"share", static_cast<double>(samples.colliding) / samples.samples},
          {"interval", {interval.low, interval.high}},
          {"confidence", 0.95},
          {"pairs", pairs},
          {"never_at_most", robot::never_bound(samples.samples)},
          {"suggested",
           {{"adjacent", pairs_json(facts.robot.model, adjacent)},
            {"always", pairs_json(facts.robot.model, facts.suggestion.always)},
            {"default", pairs_json(facts.robot.model, facts.suggestion.at_rest)},
            {"often", pairs_json(facts.robot.model, facts.suggestion.often)},
            {"never", pairs_json(facts.robot.model, facts.suggestion.never)}}}};
}

}  // namespace

LoadedRobot load_any_robot(const std::string& file, const std::vector<fs::path>& packages) {
  const NamedRobot named = named_robot(file);
  const fs::path& found = named.file;
  const RobotFileKind kind = kind_of(found);
  if (!packages.empty() && kind != RobotFileKind::urdf) {
    throw InputError("--packages is for a URDF; " + found.string() + " names its own (key packages)");
  }
  if (!named.arm.empty() && kind != RobotFileKind::robot_yaml) {
    throw InputError("'#" + named.arm + "' chooses an arm of a robot.yaml; " + found.string() + " is none");
  }
  robot::UrdfSettings settings;
  settings.packages.roots = packages;
  settings.missing_meshes = robot::MissingMeshes::list;
  robot::RobotDescription description =
      kind == RobotFileKind::robot_yaml  ? robot::load_robot(found, named.arm, settings.missing_meshes)
      : kind == RobotFileKind::hand_yaml ? robot::load_hand(found, settings.missing_meshes)
                                         : load_urdf(found, settings);
  return {kind, found, settings, robot::RobotModel(std::move(description))};
}

LinkSurface surface_of(const robot::Link& link) {
  LinkSurface surface;
  for (const auto& geometry : link.collision) {
    surface.boxes += std::holds_alternative<robot::Box>(geometry.shape) ? 1 : 0;
    surface.spheres += std::holds_alternative<robot::Sphere>(geometry.shape) ? 1 : 0;
    surface.cylinders += std::holds_alternative<robot::Cylinder>(geometry.shape) ? 1 : 0;
    const auto* mesh = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&geometry.shape);
    if (mesh == nullptr) continue;
    ++surface.meshes;
    surface.triangles += (*mesh)->triangles.cols();
    if (!robot::is_closed(**mesh)) surface.open.push_back((*mesh)->file.filename().string());
  }
  return surface;
}

std::string name_of(robot::JointType type) {
  if (type == robot::JointType::fixed) return "fixed";
  return type == robot::JointType::revolute ? "revolute" : "prismatic";
}

std::pair<std::string, std::string> names_of(const robot::RobotModel& model, const robot::LinkPairHits& pair) {
  return {model.links()[static_cast<std::size_t>(pair.first)].name,
          model.links()[static_cast<std::size_t>(pair.second)].name};
}

Json robot_json(const RobotFacts& facts) {
  const auto& model = facts.robot.model;
  const auto& description = model.description();
  Json result = document("robot");
  result["file"] = facts.robot.file.string();
  result["kind"] = kind_name(facts.robot.kind);
  result["name"] = description.name;
  result["joints"] = joints_json(model);
  result["groups"] = {{{"name", "arm"}, {"joints", description.arm_joints}, {"tip_link", description.arm_tip_link}},
                      {{"name", "hand"}, {"joints", description.hand_joints}, {"palm_link", description.palm_link}}};
  result["srdf"] = Json::array();
  for (const auto& srdf : description.semantics) result["srdf"].push_back(srdf_json(srdf));
  result["tips"] = points_json(model, description.tips);
  result["contact_points"] = points_json(model, description.contact_points);
  result["links"] = links_json(model);
  result["missing_meshes"] = Json::array();
  for (const auto& missing : description.missing_meshes) {
    result["missing_meshes"].push_back({{"link", missing.link}, {"mesh", missing.mesh}, {"reason", missing.reason}});
  }
  result["notes"] = description.notes;
  result["self_collision"] = self_collision_json(facts);
  result["proposal"] = nullptr;
  if (facts.proposal) {
    result["proposal"] = {{"tips", points_json(model, facts.proposal->tips)},
                          {"contact_points", points_json(model, facts.proposal->contact_points)},
                          {"notes", facts.proposal->notes}};
  }
  return result;
}

}  // namespace opponens::cli
