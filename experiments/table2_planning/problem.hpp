// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/human_likeness.hpp"
#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "motion/contact_depth.hpp"
#include "motion/continuous_check.hpp"
#include "motion/syn_planner.hpp"
#include "motion/world.hpp"
#include "robot/collision.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::table2 {

/// What all runs share.
struct Setting {
  robot::RobotModel robot;
  robot::RobotModel hand;  ///< the tree below the palm
  robot::Scene scene;      ///< the robot's base where the scene puts it
  std::string object;
  Eigen::VectorXd start;  ///< [d] rad
  SynergySet synergies;   ///< of the hand's joints, in its order
  std::vector<Grasp> grasps;
  std::optional<analysis::LikenessReference> free_motion;  ///< what human-likeness is measured against
  double resolution = 0.02;                                ///< rad, spacing of checked configurations
};

/// The files of a setting.
struct Sources {
  std::filesystem::path robot, scene;
  std::filesystem::path store;   ///< with synergies and free motions of the hand
  std::filesystem::path grasps;  ///< of grasp_file.hpp; empty: none
  std::filesystem::path covers;  ///< folder where the collision checker keeps what it makes of meshes; empty: none
  double hand_weight = 1.0;      ///< factor of the hand joints' weights in the metric
};

/// Throws InputError.
Setting load_setting(const Sources& sources);

const SynergyGroup& group_named(const SynergySet& set, const std::string& name);

/// The law of the base: uniform within these, about the scene's, z and tilt unchanged.
struct Jitter {
  double shift = 0.02;              ///< m, in x and in y
  double turn = 0.052359877559830;  ///< rad, about z: 3 degrees
};

/// The query of one seed: the same for every planner.
class Problem {
 public:
  /// Bases that put the start into collision (or outside its margin) are drawn again. setting is referred to and must
  /// outlive this.
  Problem(const Setting& setting, std::uint64_t seed, const Jitter& jitter = {});
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;

  const Setting& setting() const { return setting_; }
  std::uint64_t seed() const { return seed_; }
  const robot::Scene& scene() const { return scene_; }  ///< with the base of this seed
  int bases_rejected() const { return bases_rejected_; }
  const motion::World& world() const { return world_; }
  const robot::CollisionChecker& checker() const { return *free_; }  ///< with the margin
  /// Every arm branch that is free at the pre-grasp and has a valid closing segment, of each reachable grasp.
  const std::vector<motion::GoalRoot>& goals() const { return goals_; }
  const Grasp& grasp_of(int goal) const { return setting_.grasps[grasp_of_goal_[static_cast<std::size_t>(goal)]]; }
  const Eigen::VectorXd& q_grasp(int goal) const { return q_grasp_[static_cast<std::size_t>(goal)]; }
  /// [grasps] why the arm does not reach it; empty: it does.
  const std::vector<std::string>& reasons() const { return reasons_; }
  /// path with the closing segment of the goal after it.
  JointPath closed(const JointPath& path, int goal) const;

 private:
  void draw_base(const Jitter& jitter);
  void find_goals();
  motion::World closing_of(const Grasp& grasp) const;

  const Setting& setting_;
  std::uint64_t seed_;
  robot::Scene scene_;
  int bases_rejected_ = 0;
  std::unique_ptr<robot::CollisionChecker> exact_;         ///< the scene as it is
  std::unique_ptr<robot::CollisionChecker> free_;          ///< all bodies grown
  std::unique_ptr<robot::CollisionChecker> closing_free_;  ///< the object as it is
  std::shared_ptr<const motion::ContinuousCheck> clearance_;
  std::unique_ptr<robot::CollisionChecker> closing_;  ///< the same, hand-object pairs left out
  std::unique_ptr<motion::ContactDepth> depth_;
  motion::World world_;
  std::vector<motion::GoalRoot> goals_;
  std::vector<std::size_t> grasp_of_goal_;
  std::vector<Eigen::VectorXd> q_grasp_;
  std::vector<std::string> reasons_;
};

}  // namespace opponens::table2
