// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/resources.hpp"
#include "cli/world.hpp"
#include "core/require.hpp"
#include "robot/load_robot.hpp"
#include "robot/motion_request.hpp"
#include "robot/yaml_file.hpp"
#include "storage/readers/csv.hpp"

namespace opponens::cli {
namespace {

namespace fs = std::filesystem;

struct Verdict {
  bool free;
  bool within_limits;
  robot::CollisionChecker::Clearance clearance;
  std::vector<robot::BodyPair> pairs;  ///< that collide
};

/// A scene with its checker, and what it was assumed or ignored to be.
struct Place {
  robot::Scene scene;
  robot::CollisionChecker checker;
};

Verdict verdict_of(const robot::RobotModel& robot, const robot::CollisionChecker& checker, const Eigen::VectorXd& q) {
  Verdict verdict{false, robot.within_limits(q), checker.clearance(q), checker.colliding_pairs(q)};
  verdict.free = verdict.pairs.empty();
  return verdict;
}

Json pair_json(const robot::BodyPair& pair) { return {pair.first, pair.second}; }

Json verdict_json(const Verdict& verdict) {
  Json pairs = Json::array();
  for (const auto& pair : verdict.pairs) pairs.push_back(pair_json(pair));
  const bool has_nearest = !verdict.clearance.pair.first.empty();
  return {{"free", verdict.free},
          {"clearance_m", number(verdict.clearance.distance)},
          {"nearest", has_nearest ? pair_json(verdict.clearance.pair) : Json(nullptr)},
          {"pairs", std::move(pairs)},
          {"within_limits", verdict.within_limits}};
}

/// "free       0.0123 m  hand - table", or the pairs that collide.
std::string verdict_text(const Verdict& verdict) {
  std::array<char, 64> head{};
  std::snprintf(head.data(), head.size(), "%-9s  %8.4f m  ", verdict.free ? "free" : "colliding",
                verdict.clearance.distance);
  std::vector<std::string> names;
  for (const auto& [first, second] : verdict.pairs) names.push_back(first + " - " + second);
  if (verdict.free && !verdict.clearance.pair.first.empty()) {
    names.push_back(verdict.clearance.pair.first + " - " + verdict.clearance.pair.second);
  }
  return head.data() + joined(names) + (verdict.within_limits ? "" : "  (beyond joint limits)");
}

Place place(const robot::RobotModel& robot, const fs::path& scene_file, const std::vector<double>& base) {
  robot::Scene scene = robot::load_scene(scene_file);
  if (!base.empty()) {
    const Eigen::Vector3d rpy = base.size() == 6 ? Eigen::Vector3d(base[3], base[4], base[5]) : Eigen::Vector3d::Zero();
    scene.X_WR = robot::pose_from_xyz_rpy({base[0], base[1], base[2]}, rpy);
  }
  robot::CollisionChecker checker(robot, scene);
  return {std::move(scene), std::move(checker)};
}

/// Sentences that were not said before, on stderr and into the document.
class Notes {
 public:
  void add(const std::vector<std::string>& sentences, const Console& console) {
    for (const std::string& sentence : sentences) {
      if (!said_.insert(sentence).second) continue;
      console.advise(sentence);
      list_.push_back(sentence);
    }
  }
  const Json& list() const { return list_; }

 private:
  std::set<std::string> said_;
  Json list_ = Json::array();
};

/// The columns of a table of configurations in the robot's joint order.
std::vector<std::size_t> columns_of(const storage::CsvReader& table, const robot::RobotModel& robot) {
  std::vector<std::size_t> columns;
  for (const std::string& joint : robot.joint_names()) columns.push_back(table.column(joint, "column of joint"));
  return columns;
}

std::vector<std::string> surplus_columns(const storage::CsvReader& table, const robot::RobotModel& robot) {
  const std::set<std::string> joints(robot.joint_names().begin(), robot.joint_names().end());
  std::vector<std::string> surplus;
  for (const std::string_view cell : table.header()) {
    const std::string name(cell);
    if (joints.count(name) == 0) surplus.push_back(name);
  }
  return surplus;
}

Json check_table(const CheckOptions& options, const robot::RobotModel& robot, const Console& console, Notes& notes) {
  const Place at = place(robot, find_file(options.scene), options.base);
  notes.add(warnings_of(robot, at.scene, at.checker), console);
  std::ifstream stream(options.configs, std::ios::binary);
  if (!stream || fs::is_directory(options.configs)) throw InputError(options.configs.string() + ": cannot be read");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  storage::CsvReader table(text, options.configs);
  if (const auto surplus = surplus_columns(table, robot); !surplus.empty()) {
    notes.add({options.configs.string() + ": columns that are no joints of the robot are left out: " + joined(surplus)},
              console);
  }
  const std::vector<std::size_t> columns = columns_of(table, robot);
  Progress progress(console, "check");
  Json configs = Json::array();
  std::int64_t free = 0;
  Eigen::VectorXd q(robot.dof());
  while (table.next()) {
    for (int i = 0; i < robot.dof(); ++i) q[i] = table.number(columns[static_cast<std::size_t>(i)]);
    const Verdict verdict = verdict_of(robot, at.checker, q);
    free += verdict.free ? 1 : 0;
    configs.push_back(verdict_json(verdict));
    console.say(options.configs.filename().string() + ":" + std::to_string(table.line()) + "  " +
                verdict_text(verdict));
    progress.update(static_cast<std::int64_t>(configs.size()), 0);
  }
  const auto count = static_cast<std::int64_t>(configs.size());
  console.say(std::to_string(count) + " configurations: " + std::to_string(free) + " free, " +
              std::to_string(count - free) + " colliding");
  return configs;
}

/// MotionBenchMaker keeps the scene of request0001.yaml in scene0001.yaml beside it.
fs::path scene_beside(const fs::path& request) {
  const std::string name = request.filename().string();
  const std::size_t at = name.find("request");
  if (at == std::string::npos) {
    throw InputError(request.string() + ": has no 'request' in its name to find its scene by; use --scene");
  }
  return request.parent_path() / (name.substr(0, at) + "scene" + name.substr(at + 7));
}

/// Zero, or the nearest position that the limits allow.
Eigen::VectorXd neutral(const robot::RobotModel& robot) { return robot.clip(Eigen::VectorXd::Zero(robot.dof())); }

struct CheckTally {
  std::int64_t requests = 0;
  std::int64_t start_free = 0;
  std::int64_t goals = 0;
  std::int64_t goals_free = 0;
};

/// Joints that a state lacks are taken from the start, of a start from the scene, and else as near zero as they may be.
Json check_request(const fs::path& file, const robot::RobotModel& robot, const Place& at, const Console& console,
                   CheckTally& tally) {
  const robot::MotionRequest request = robot::load_motion_request(file);
  const robot::JointState of_scene{at.scene.start_joints, at.scene.start};
  const robot::Completed start = complete(robot, request.start, complete(robot, of_scene, neutral(robot)).q);
  const Verdict start_verdict = verdict_of(robot, at.checker, start.q);
  std::set<std::string> unknown(start.unknown.begin(), start.unknown.end());
  console.say(file.string() + "  start  " + verdict_text(start_verdict));
  Json goals = Json::array();
  for (const robot::JointState& goal : request.goals) {
    const robot::Completed completed = complete(robot, goal, start.q);
    unknown.insert(completed.unknown.begin(), completed.unknown.end());
    const Verdict verdict = verdict_of(robot, at.checker, completed.q);
    ++tally.goals;
    tally.goals_free += verdict.free ? 1 : 0;
    goals.push_back(verdict_json(verdict));
    console.say(file.string() + "  goal   " + verdict_text(verdict));
  }
  ++tally.requests;
  tally.start_free += start_verdict.free ? 1 : 0;
  return {{"file", file.string()},
          {"group", request.group},
          {"start", verdict_json(start_verdict)},
          {"goals", std::move(goals)},
          {"joints_the_robot_lacks", std::vector<std::string>(unknown.begin(), unknown.end())},
          {"joints_assumed", start.assumed},
          {"notes", request.notes}};
}

void tell_joints(const Json& request, const Console& console, Notes& notes) {
  const std::vector<std::string> unknown = request.at("joints_the_robot_lacks");
  const std::vector<std::string> assumed = request.at("joints_assumed");
  std::vector<std::string> sentences = request.at("notes");
  if (!unknown.empty()) sentences.push_back("joints of the requests that the robot lacks: " + joined(unknown));
  if (!assumed.empty()) {
    sentences.push_back("joints that the requests lack, taken from the scene's start or as zero: " + joined(assumed));
  }
  notes.add(sentences, console);
}

Json check_requests(const CheckOptions& options, const robot::RobotModel& robot, const Console& console, Notes& notes,
                    Json& summary) {
  Json requests = Json::array();
  CheckTally tally;
  std::optional<Place> shared;
  if (!options.scene.empty()) shared.emplace(place(robot, find_file(options.scene), options.base));
  Progress progress(console, "check");
  for (const fs::path& file : options.requests) {
    std::optional<Place> own;
    if (!shared) own.emplace(place(robot, scene_beside(file), options.base));
    const Place& at = shared ? *shared : *own;
    requests.push_back(check_request(file, robot, at, console, tally));
    notes.add(warnings_of(robot, at.scene, at.checker), console);
    tell_joints(requests.back(), console, notes);
    progress.update(tally.requests, static_cast<std::int64_t>(options.requests.size()));
  }
  summary = {{"requests", tally.requests},
             {"start_free", tally.start_free},
             {"start_colliding", tally.requests - tally.start_free},
             {"goal_free", tally.goals_free},
             {"goal_colliding", tally.goals - tally.goals_free}};
  console.say(std::to_string(tally.requests) + " requests: start free " + std::to_string(tally.start_free) +
              ", colliding " + std::to_string(tally.requests - tally.start_free) + "; goals free " +
              std::to_string(tally.goals_free) + ", colliding " + std::to_string(tally.goals - tally.goals_free));
  return requests;
}

void require_wanted(const CheckOptions& options) {
  if (options.configs.empty() && options.requests.empty()) throw InputError("check needs --configs or --requests");
  if (!options.configs.empty() && !options.requests.empty()) {
    throw InputError("check takes --configs or --requests, not both");
  }
  if (!options.configs.empty() && options.scene.empty()) throw InputError("check --configs needs --scene");
  if (!options.base.empty() && options.base.size() != 3 && options.base.size() != 6) {
    throw InputError("--base: expected x,y,z or x,y,z,roll,pitch,yaw, found " + std::to_string(options.base.size()) +
                     " numbers");
  }
  for (const double value : options.base) {
    if (!std::isfinite(value)) throw InputError("--base: expected finite numbers");
  }
}

}  // namespace

int check(const CheckOptions& options, const Console& console) {
  require_wanted(options);
  const robot::RobotModel robot(robot::load_robot(find_file(options.robot)));
  Notes notes;
  Json result = document("check");
  result["joint_names"] = robot.joint_names();
  if (!options.configs.empty()) {
    result["configs"] = check_table(options, robot, console, notes);
  } else {
    Json summary;
    result["requests"] = check_requests(options, robot, console, notes, summary);
    result["summary"] = std::move(summary);
  }
  result["notes"] = notes.list();
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
