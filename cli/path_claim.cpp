// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/path_claim.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "cli/records.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

/// " of arm left", where several are driven.
std::string of_arm(const NamedWorld& world, std::size_t arm) {
  return world.arms.size() > 1 ? " of arm " + world.arms[arm].name : "";
}

/// Of what a path does with one arm.
std::vector<WorldKey> keys_of_arm(const storage::Record& record, const std::string& arm) {
  std::vector<WorldKey> keys = world_keys(record);
  std::erase_if(keys, [&](const WorldKey& key) { return key.arm != arm; });
  return keys;
}

/// The grasp that a path names for an arm: one of that arm's with its object, in the same files, among those that the
/// path was made from.
std::optional<Grasp> named_grasp(const storage::Store& store, const storage::Record& record, const NamedWorld& world,
                                 std::size_t arm, opponens::verify::Verdict& verdict) {
  const std::string id = text_field(record, arm == 0 ? "goal_grasp" : goal_grasp_field(world.arms[arm].name));
  const auto& inputs = record.provenance.inputs;
  if (std::find(inputs.begin(), inputs.end(), id) == inputs.end()) {
    verdict.fail("names no grasp" + of_arm(world, arm) + " that it was made from");
    return std::nullopt;
  }
  const storage::Record stored = store.read(id);
  if (stored.kind != kGrasp || world_keys(stored) != keys_of_arm(record, world.arms[arm].name)) {
    verdict.fail(short_id(id) + " is no grasp of " + world.arms[arm].object + of_arm(world, arm) +
                 " in the path's files");
    return std::nullopt;
  }
  Grasp grasp = storage::decode_grasp(stored);
  if (!grasp.arm_solutions.empty()) return grasp;
  verdict.fail("its grasp" + of_arm(world, arm) + " has no arm solution");
  return std::nullopt;
}

/// The arm solution that a path uses: the one nearest to its pre-grasp (PathChecker asks for equality).
const ArmSolution& solution_used(const Grasp& grasp, const Eigen::VectorXd& q_arm) {
  return *std::min_element(grasp.arm_solutions.begin(), grasp.arm_solutions.end(),
                           [&](const ArmSolution& a, const ArmSolution& b) {
                             return (a.q_pregrasp - q_arm).norm() < (b.q_pregrasp - q_arm).norm();
                           });
}

/// Whether a grasp's joints are as many as the arm and the hand have.
bool fits(const Grasp& grasp, const robot::DrivenArm& arm) {
  return grasp.q_pregrasp.size() == arm.hand.count && grasp.q_grasp.size() == arm.hand.count &&
         std::all_of(grasp.arm_solutions.begin(), grasp.arm_solutions.end(), [&](const ArmSolution& solution) {
           return solution.q_pregrasp.size() == arm.arm.count && solution.q_grasp.size() == arm.arm.count;
         });
}

void add_arm(const Grasp& grasp, const robot::DrivenArm& arm, const Eigen::VectorXd& q_pregrasp,
             opponens::verify::PathClaim& claim) {
  const ArmSolution& solution = solution_used(grasp, q_pregrasp.segment(arm.arm.first, arm.arm.count));
  claim.goal.segment(arm.arm.first, arm.arm.count) = solution.q_pregrasp;
  claim.goal.segment(arm.hand.first, arm.hand.count) = grasp.q_pregrasp;
  claim.grasp->segment(arm.arm.first, arm.arm.count) = solution.q_grasp;
  claim.grasp->segment(arm.hand.first, arm.hand.count) = grasp.q_grasp;
}

opponens::verify::HandClaim hand_claim(const Grasp& grasp, const robot::Scene& scene, const std::string& object) {
  const Eigen::Isometry3d& X_WO = scene.body(object).X_WB;
  opponens::verify::HandClaim hand{X_WO * grasp.X_OH_pregrasp, X_WO * grasp.X_OH, object, {}};
  for (const auto& contact : grasp.contacts) hand.contact_links.insert(contact.link);
  return hand;
}

}  // namespace

std::optional<opponens::verify::PathClaim> path_claim(const storage::Store& store, const storage::Record& record,
                                                      const NamedWorld& world, const JointPath& motion,
                                                      opponens::verify::Verdict& verdict) {
  opponens::verify::PathClaim claim;
  claim.start = start_configuration(world.robot, world.scene);
  claim.closing_from = std::get<std::int64_t>(record.fields.at("pregrasp_row"));
  if (claim.closing_from < 0 || claim.closing_from >= motion.waypoints.rows() ||
      motion.waypoints.cols() != world.robot.dof()) {
    verdict.fail("its pre-grasp is no waypoint, or its joints are not as many as the robot's");
    return std::nullopt;
  }
  const Eigen::VectorXd q_pregrasp = motion.waypoints.row(claim.closing_from).transpose();
  claim.goal.resize(world.robot.dof());
  claim.grasp = Eigen::VectorXd(world.robot.dof());
  for (std::size_t i = 0; i < world.arms.size(); ++i) {
    const auto grasp = named_grasp(store, record, world, i, verdict);
    if (!grasp) return std::nullopt;
    if (!fits(*grasp, world.robot.arms()[i])) {
      verdict.fail("its grasp" + of_arm(world, i) + " has other joints than the robot");
      return std::nullopt;
    }
    add_arm(*grasp, world.robot.arms()[i], q_pregrasp, claim);
    claim.hands.push_back(hand_claim(*grasp, world.scene, world.arms[i].object));
  }
  return claim;
}

}  // namespace opponens::cli
