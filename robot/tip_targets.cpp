// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/tip_targets.hpp"

#include <algorithm>
#include <set>

#include "robot/joint_mapping.hpp"

namespace opponens::robot {

namespace {

const SurfacePoint* find_tip(const RobotModel& hand, const std::string& name) {
  const auto& tips = hand.description().tips;
  const auto found = std::find_if(tips.begin(), tips.end(), [&](const SurfacePoint& tip) { return tip.name == name; });
  return found == tips.end() ? nullptr : &*found;
}

/// The fitted joints between palm and tip. A joint that only drives others (mimic) is not among them.
void find_fitted_joints(const RobotModel& hand, const std::vector<int>& fitted, TipTarget& target) {
  for (int link = target.finger.link; link != hand.palm() && hand.links()[static_cast<std::size_t>(link)].joint >= 0;) {
    const Joint& joint =
        hand.description().joints[static_cast<std::size_t>(hand.links()[static_cast<std::size_t>(link)].joint)];
    const std::optional<int> index = index_of(hand.joint_names(), joint.name);
    if (index && std::find(fitted.begin(), fitted.end(), *index) != fitted.end()) {
      target.joints.insert(target.joints.begin(), *index);
      target.turning[*index] = {joint.child, joint.axis, joint.type == JointType::revolute};
    }
    link = joint.parent;
  }
}

}  // namespace

Result<std::vector<FingerPair>> mapped_fingers(const RobotModel& human, const RobotModel& hand,
                                               const HandMapping& mapping) {
  std::vector<FingerPair> fingers;
  for (const auto& [robot_name, human_name] : mapping.fingertips) {
    const SurfacePoint* robot_tip = find_tip(hand, robot_name);
    const SurfacePoint* human_tip = find_tip(human, human_name);
    if (!robot_tip) return failure(FailureCode::not_found, "the robot hand has no tip '" + robot_name + "'");
    if (!human_tip) return failure(FailureCode::not_found, "the human hand has no tip '" + human_name + "'");
    fingers.push_back({robot_name, finger_of(hand, *robot_tip), finger_of(human, *human_tip)});
  }
  return fingers;
}

std::vector<int> moving_joints(const std::vector<FingerPair>& fingers) {
  std::set<int> joints;
  for (const FingerPair& pair : fingers) joints.insert(pair.robot.moved_by.begin(), pair.robot.moved_by.end());
  return {joints.begin(), joints.end()};
}

Result<std::vector<TipTarget>> finger_targets(const RobotModel& human, const Eigen::MatrixXd& q_human,
                                              const RobotModel& hand, const HandMapping& mapping,
                                              const std::vector<FingerPair>& fingers, const std::vector<int>& fitted) {
  std::vector<TipTarget> targets;
  for (const FingerPair& pair : fingers) {
    const auto other = mapping.measured_from.find(pair.tip);
    const std::string& base = other == mapping.measured_from.end() ? pair.tip : other->second;
    const auto from = std::find_if(fingers.begin(), fingers.end(), [&](const FingerPair& f) { return f.tip == base; });
    if (from == fingers.end()) {
      return failure(FailureCode::not_found, "tip '" + pair.tip + "' is measured from '" + base + "': not mapped");
    }
    const Eigen::Matrix3d turned = (from->robot.length / from->human.length) * mapping.R_robot_human;
    TipTarget target{pair.robot, {}, {}, {}};
    target.path =
        (turned * (tip_path(human, pair.human, q_human).colwise() - from->human.base)).colwise() + from->robot.base;
    find_fitted_joints(hand, fitted, target);
    targets.push_back(std::move(target));
  }
  for (const int joint : fitted) {
    const bool used = std::any_of(targets.begin(), targets.end(), [&](const TipTarget& target) {
      const auto& moving = target.finger.moved_by;
      return std::find(moving.begin(), moving.end(), joint) != moving.end();
    });
    if (!used) {
      return failure(FailureCode::degenerate, "joint '" + hand.joint_names()[static_cast<std::size_t>(joint)] +
                                                  "' is fitted, but moves no mapped fingertip");
    }
  }
  return targets;
}

std::vector<TipTarget> aligned_targets(const RobotModel& human, const Eigen::MatrixXd& q_human,
                                       const HandAlignment& alignment, const Eigen::Matrix3d& R_robot_human,
                                       const std::vector<FingerPair>& fingers) {
  std::vector<TipTarget> targets;
  for (const FingerPair& pair : fingers) {
    TipTarget target{pair.robot, {}, {}, {}};
    target.path = (alignment.scale * R_robot_human * tip_path(human, pair.human, q_human)).colwise() + alignment.offset;
    targets.push_back(std::move(target));
  }
  return targets;
}

}  // namespace opponens::robot
