// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/paths.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "verify/palm_pose.hpp"

namespace opponens::verify {
namespace {

constexpr std::size_t kReportedPairs = 10;

void check_configuration(const JointPath& path, Eigen::Index row, const Eigen::VectorXd& expected,
                         const std::string& name, double tolerance, Verdict& verdict) {
  if (expected.size() != path.waypoints.cols()) {
    verdict.fail("the claimed " + name + " has " + std::to_string(expected.size()) + " joints, the path " +
                 std::to_string(path.waypoints.cols()));
    return;
  }
  const double error = (path.waypoints.row(row).transpose() - expected).cwiseAbs().maxCoeff();
  if (!(error <= tolerance)) {
    verdict.fail("waypoint " + std::to_string(row) + " differs from the " + name + " by " + number(error) + " rad");
  }
}

/// Shape, names and numbers; the rest needs them.
bool check_form(const JointPath& path, const PathClaim& claim, const robot::RobotModel& robot, Verdict& verdict) {
  if (path.waypoints.rows() < 1 || path.waypoints.cols() != robot.dof() || !path.waypoints.allFinite()) {
    verdict.fail("the path has no waypoint, or not one finite number per joint");
    return false;
  }
  if (path.joint_names != robot.joint_names()) {
    verdict.fail("the path's joints are not the robot's, or in another order");
    return false;
  }
  if (claim.grasp.has_value() != (claim.closing_from >= 0) || claim.closing_from >= path.waypoints.rows()) {
    verdict.fail("the closing segment begins at waypoint " + std::to_string(claim.closing_from) + " of " +
                 std::to_string(path.waypoints.rows()));
    return false;
  }
  return true;
}

void check_limits(const JointPath& path, const robot::RobotModel& robot, double tolerance, Verdict& verdict) {
  // Limits are a box: what holds at the waypoints holds between them.
  for (Eigen::Index i = 0; i < path.waypoints.rows(); ++i) {
    for (Eigen::Index j = 0; j < path.waypoints.cols(); ++j) {
      const double q = path.waypoints(i, j);
      if (q < robot.lower()[j] - tolerance || q > robot.upper()[j] + tolerance) {
        verdict.fail("waypoint " + std::to_string(i) + ": joint " + path.joint_names[static_cast<std::size_t>(j)] +
                     " = " + number(q) + " rad is outside [" + number(robot.lower()[j]) + ", " +
                     number(robot.upper()[j]) + "]");
      }
    }
  }
}

std::string text_of(const Place& place) {
  if (place.fraction == 1.0) return "at waypoint " + std::to_string(place.waypoint);
  return "between waypoints " + std::to_string(place.waypoint - 1) + " and " + std::to_string(place.waypoint) + " at " +
         number(place.fraction);
}

std::string millimetres(double metres) { return number(1e3 * metres) + " mm"; }

using NamePair = PathProof::NamePair;

std::string reason_of(const NamePair& pair, const PathProof::Found& found, double clearance) {
  const std::string names = pair.first + " and " + pair.second;
  const std::string where = std::string(" ") + text_of(found.place);
  if (found.distance == 0.0) return "collision of " + names + where;
  if (found.distance < clearance) {
    return names + " are " + millimetres(found.distance) + " apart" + where + ", less than " + millimetres(clearance);
  }
  return names + " are " + millimetres(found.distance) + " apart" + where + ", but " + millimetres(clearance) +
         " cannot be proven around there";
}

std::string reason_of(const NamePair& pair, const PathProof::Contact& contact, double limit) {
  const std::string text = "contact of " + pair.first + " and " + pair.second + " is " + millimetres(contact.attained) +
                           " deep " + text_of(contact.place);
  if (contact.attained > limit) return text + ", more than " + millimetres(limit);
  return text + ", but " + millimetres(limit) + " cannot be proven for all of the closing segment";
}

void judge(const PathProof& proof, const ProofSettings& settings, Verdict& verdict) {
  std::vector<std::string> reasons;
  for (const auto& [pair, found] : proof.found()) {
    if (found.distance < verdict.worst_clearance) {
      verdict.worst_clearance = found.distance;
      verdict.worst_pair = pair;
      verdict.worst_place = text_of(found.place);
    }
    if (found.distance < settings.clearance || !found.proven) {
      reasons.push_back(reason_of(pair, found, settings.clearance));
    }
  }
  verdict.proven_clearance = proof.proven_clearance();
  for (const auto& [pair, contact] : proof.contacts()) {
    verdict.worst_contact_penetration = std::max(verdict.worst_contact_penetration, contact.attained);
    verdict.proven_contact_penetration = std::max(verdict.proven_contact_penetration, contact.proven);
    if (std::max(contact.attained, contact.proven) > settings.max_penetration) {
      reasons.push_back(reason_of(pair, contact, settings.max_penetration));
    }
  }
  verdict.checked = proof.configurations();
  verdict.distances = proof.distances();
  verdict.ok = verdict.ok && reasons.empty();
  if (reasons.size() > kReportedPairs) reasons.resize(kReportedPairs);
  for (std::string& reason : reasons) verdict.reasons.push_back(std::move(reason));
}

void walk_path(const JointPath& path, const PathClaim& claim, PathProof& proof) {
  const auto closing = [&](Eigen::Index i) { return claim.closing_from >= 0 && i > claim.closing_from; };
  const Eigen::MatrixXd q = path.waypoints.transpose();
  for (Eigen::Index i = 0; i < q.cols(); ++i) proof.visit(q.col(i), static_cast<int>(i), closing(i), i == 0);
  for (Eigen::Index i = 1; i < q.cols(); ++i) proof.prove(q.col(i - 1), q.col(i), static_cast<int>(i), closing(i));
}

void check_ends(const JointPath& path, const PathClaim& claim, const robot::RobotModel& robot,
                const robot::Scene& scene, const PathCheckSettings& settings, Verdict& verdict) {
  const Eigen::Index last = path.waypoints.rows() - 1;
  const Eigen::Index pregrasp = claim.closing_from >= 0 ? claim.closing_from : last;
  check_configuration(path, 0, claim.start, "start", settings.tolerance, verdict);
  check_configuration(path, pregrasp, claim.goal, "pre-grasp", settings.tolerance, verdict);
  if (claim.grasp) check_configuration(path, last, *claim.grasp, "grasp", settings.tolerance, verdict);
  const Eigen::Isometry3d X_RW = scene.X_WR.inverse();
  for (std::size_t i = 0; i < claim.hands.size(); ++i) {
    const robot::DrivenArm& arm = robot.arms()[i];
    const std::string of = robot.arms().size() > 1 ? " of arm " + arm.name : "";
    const auto check = [&](Eigen::Index row, const std::optional<Eigen::Isometry3d>& X_WH, const std::string& name) {
      if (!X_WH) return;
      check_palm(robot, path.waypoints.row(row).transpose(), arm.palm, X_RW * *X_WH, name + of, settings.pose_tolerance,
                 verdict);
    };
    check(pregrasp, claim.hands[i].X_WH_pregrasp, "the path's pre-grasp");
    check(last, claim.hands[i].X_WH_grasp, "the path's end");
  }
}

/// Whether a link is the palm or below it.
bool belongs_to(const robot::RobotModel& robot, const std::string& link, int palm) {
  const auto& links = robot.links();
  const auto named = std::find_if(links.begin(), links.end(), [&](const robot::Link& one) { return one.name == link; });
  if (named == links.end()) return false;
  auto index = static_cast<int>(named - links.begin());
  while (index != palm && index >= 0) {
    const int joint = links[static_cast<std::size_t>(index)].joint;
    index = joint < 0 ? -1 : robot.description().joints[static_cast<std::size_t>(joint)].parent;
  }
  return index == palm;
}

/// The pairs that may touch while closing: each hand's own links with its own object. A claim for another hand's link
/// would leave that one unwatched, so it fails.
std::set<NamePair> allowed_contacts(const PathClaim& claim, const robot::RobotModel& robot, Verdict& verdict) {
  std::set<NamePair> contacts;
  for (std::size_t i = 0; i < claim.hands.size(); ++i) {
    for (const std::string& link : claim.hands[i].contact_links) {
      if (belongs_to(robot, link, robot.arms()[i].palm)) {
        contacts.emplace(link, claim.hands[i].object);
      } else {
        verdict.fail("a contact with " + claim.hands[i].object + " is by " + link + ", which is no link of that hand");
      }
    }
  }
  return contacts;
}

}  // namespace

PathChecker::PathChecker(const robot::RobotModel& robot, const robot::Scene& scene)
    : robot_(robot), scene_(scene), bound_(robot), bodies_(robot, scene) {}

Verdict PathChecker::check(const JointPath& path, const PathClaim& claim, const PathCheckSettings& settings) {
  require(settings.tolerance >= 0.0 && settings.pose_tolerance >= 0.0,
          "PathCheckSettings: tolerances must not be negative");
  require(claim.hands.empty() || claim.hands.size() == robot_.arms().size(),
          "PathClaim: hands must be one for each arm, or none");
  Verdict verdict;
  if (!check_form(path, claim, robot_, verdict)) return verdict;
  check_ends(path, claim, robot_, scene_, settings, verdict);
  check_limits(path, robot_, std::max(settings.tolerance, 1e-9), verdict);
  const std::set<NamePair> contacts = allowed_contacts(claim, robot_, verdict);
  PathProof proof(robot_, bound_, bodies_, contacts, settings.proof);
  walk_path(path, claim, proof);
  judge(proof, settings.proof, verdict);
  return verdict;
}

}  // namespace opponens::verify
