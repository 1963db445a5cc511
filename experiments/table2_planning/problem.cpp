// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/table2_planning/problem.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "experiments/table2_planning/grasp_file.hpp"
#include "motion/closing_segment.hpp"
#include "motion/edge_check.hpp"
#include "motion/goal_configurations.hpp"
#include "motion/grown_scene.hpp"
#include "robot/cover_file.hpp"
#include "robot/load_robot.hpp"
#include "storage/codec.hpp"
#include "storage/store.hpp"

namespace opponens::table2 {
namespace {

/// m, as `opponens plan`: the search asks of bodies this much larger, a little more than the clearance that is proven.
constexpr double kMargin = 0.00075;

Eigen::VectorXd start_of(const robot::RobotModel& robot, const robot::Scene& scene) {
  Eigen::VectorXd q(robot.dof());
  for (int j = 0; j < robot.dof(); ++j) {
    const std::string& name = robot.joint_names()[static_cast<std::size_t>(j)];
    const auto found = std::find(scene.start_joints.begin(), scene.start_joints.end(), name);
    if (found == scene.start_joints.end()) throw InputError(scene.name + ": its start lacks joint " + name);
    q[j] = scene.start[found - scene.start_joints.begin()];
  }
  return q;
}

SynergySet newest_synergies(const storage::Store& store) {
  const auto sets = store.list_as_produced("synergy_set");
  if (sets.empty()) throw InputError(store.directory().string() + ": no synergies; run: opponens analyze");
  return storage::decode_synergy_set(store.read(sets.back().id));
}

std::optional<analysis::LikenessReference> free_motion_of(const storage::Store& store) {
  std::vector<analysis::FreeMotion> motions;
  for (const auto& entry : store.list("hand_demonstration")) {
    const Demonstration motion = storage::decode_demonstration(store.read(entry.id));
    if (analysis::is_free_motion(motion)) motions.push_back(analysis::free_motion(motion));
  }
  return analysis::free_motion_reference(std::move(motions));
}

}  // namespace

Setting load_setting(const Sources& sources) {
  robot::RobotDescription description = robot::with_covers(robot::load_robot(sources.robot), sources.covers);
  robot::RobotModel hand(robot::hand_of(description));
  description.weights.tail(hand.dof()) *= sources.hand_weight;
  const storage::Store store(sources.store, false);
  Setting setting{robot::RobotModel(std::move(description)),
                  std::move(hand),
                  robot::with_covers(robot::load_scene(sources.scene), sources.covers),
                  {},
                  {},
                  newest_synergies(store),
                  {},
                  free_motion_of(store)};
  setting.object = setting.scene.object;
  setting.start = start_of(setting.robot, setting.scene);
  if (setting.synergies.joint_names != setting.hand.joint_names()) {
    throw InputError(sources.store.string() + ": its synergies are about another hand's joints");
  }
  if (!sources.grasps.empty()) {
    PredefinedGrasps predefined = load_grasps(sources.grasps, setting.hand.joint_names());
    if (predefined.object != setting.object) {
      throw InputError(sources.grasps.string() + ": about " + predefined.object + ", not " + setting.object);
    }
    setting.grasps = std::move(predefined.grasps);
  }
  return setting;
}

const SynergyGroup& group_named(const SynergySet& set, const std::string& name) {
  const auto found =
      std::find_if(set.grasp.begin(), set.grasp.end(), [&](const SynergyGroup& group) { return group.name == name; });
  if (found == set.grasp.end()) throw InputError("the synergies have no group " + name);
  return *found;
}

Problem::Problem(const Setting& setting, std::uint64_t seed, const Jitter& jitter)
    : setting_(setting), seed_(seed), scene_(setting.scene) {
  draw_base(jitter);
  const robot::Scene but_object = motion::grown_scene(scene_, kMargin, {setting.object});
  std::vector<robot::BodyPair> hand_object;
  std::vector<std::string> links;
  for (const robot::Link& link : setting.hand.links()) {
    hand_object.emplace_back(link.name, setting.object);
    links.push_back(link.name);
  }
  closing_free_ = std::make_unique<robot::CollisionChecker>(setting.robot, but_object);
  closing_ = std::make_unique<robot::CollisionChecker>(setting.robot, but_object, hand_object);
  depth_ = std::make_unique<motion::ContactDepth>(setting.robot, scene_, setting.object, links);
  exact_ = std::make_unique<robot::CollisionChecker>(setting.robot, scene_);
  clearance_ = std::make_shared<const motion::ContinuousCheck>(
      motion::ContinuousCheck(*exact_, setting.robot).starting_at(setting.start));
  world_ = motion::make_world(*free_, setting.robot, setting.resolution, clearance_);
  find_goals();
}

void Problem::draw_base(const Jitter& jitter) {
  constexpr int kMostRejected = 1000;
  Rng rng = stream(seed_, "table2/base");
  while (true) {
    const double x = rng.uniform(-jitter.shift, jitter.shift);
    const double y = rng.uniform(-jitter.shift, jitter.shift);
    const double turn = rng.uniform(-jitter.turn, jitter.turn);
    scene_.X_WR =
        setting_.scene.X_WR * Eigen::Translation3d(x, y, 0.0) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
    free_ = std::make_unique<robot::CollisionChecker>(setting_.robot, motion::grown_scene(scene_, kMargin));
    if (free_->free(setting_.start)) return;
    if (++bases_rejected_ == kMostRejected) throw InputError(scene_.name + ": the start is never free");
  }
}

motion::World Problem::closing_of(const Grasp& grasp) const {
  return motion::closing_world(*closing_free_, *closing_, setting_.robot, grasp.contacts, setting_.resolution,
                               {.depth = depth_.get(), .clearance = clearance_.get()});
}

void Problem::find_goals() {
  const robot::RobotModel& robot = setting_.robot;
  const robot::InverseKinematics kinematics = robot::make_inverse_kinematics(robot);
  const Eigen::Isometry3d X_RO = scene_.X_WR.inverse() * scene_.body(setting_.object).X_WB;
  for (std::size_t i = 0; i < setting_.grasps.size(); ++i) {
    Grasp grasp = setting_.grasps[i];
    std::string reason = motion::reach(grasp, robot, kinematics, X_RO, *closing_free_, *closing_, setting_.resolution,
                                       {.depth = depth_.get(), .clearance = clearance_.get()});
    const std::size_t before = goals_.size();
    for (const ArmSolution& arm : grasp.arm_solutions) {
      const Eigen::VectorXd q = motion::join(robot, arm.q_pregrasp, grasp.q_pregrasp);
      if (!free_->free(q) || !clearance_->keeps(q)) continue;  // nearer to something than the margin
      goals_.push_back({q, group_named(setting_.synergies, grasp.group).box, static_cast<int>(goals_.size())});
      grasp_of_goal_.push_back(i);
      q_grasp_.push_back(motion::join(robot, arm.q_grasp, grasp.q_grasp));
    }
    if (reason.empty() && goals_.size() == before) reason = "pre-grasp nearer to something than the margin";
    reasons_.push_back(std::move(reason));
  }
}

JointPath Problem::closed(const JointPath& path, int goal) const {
  auto whole = motion::append_closing_segment(path, q_grasp(goal), setting_.robot.hand(), closing_of(grasp_of(goal)));
  require(whole.has_value(), "table2: a goal without a valid closing segment was reached");
  return std::move(*whole);
}

}  // namespace opponens::table2
